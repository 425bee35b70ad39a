// The GGX fit of libbsdf (Kimura) to a MERL file, through its public interface.
#include <libbsdf/Fitter/GgxFitter.h>
#include <libbsdf/Reader/MerlBinaryReader.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>

#include "bench/peers/exchange.h"

namespace {

// As many as the others fit; it draws its own.
constexpr int kSamples = 20000;

lb::Vec3 vector_of(const peers::Triple& t) {
  using Scalar = lb::Vec3::Scalar;
  return lb::Vec3(static_cast<Scalar>(t[0]), static_cast<Scalar>(t[1]), static_cast<Scalar>(t[2]));
}

void run(const std::string& file, const std::string& folder) {
  const std::unique_ptr<lb::HalfDifferenceCoordinatesBrdf> table(lb::MerlBinaryReader::read(file));
  if (!table) throw std::runtime_error(file + " cannot be read by libbsdf");
  const peers::Clock clock;
  const lb::Ggx model = lb::GgxFitter::estimateParameters(*table, kSamples);
  peers::write_values(
      folder, "libbsdf-ggx", clock.seconds(), [&](const peers::Triple& wi, const peers::Triple& wo) {
        const lb::Vec3 f = model.getBrdfValue(vector_of(wi), vector_of(wo));
        return peers::Triple{static_cast<double>(f[0]), static_cast<double>(f[1]), static_cast<double>(f[2])};
      });
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: libbsdf_fit FILE.binary DIR\n", stderr);
    return 2;
  }
  try {
    run(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "libbsdf_fit: %s\n", error.what());
    return 1;
  }
  return 0;
}
