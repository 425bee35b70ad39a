// The fit of dj_brdf (Dupuy) to a MERL file, through its public interface: a tabulated microfacet model, and
// the GGX whose roughness it gives.
#define DJ_BRDF_IMPLEMENTATION 1
#define NVERBOSE 1
#include <dj_brdf.h>

#include <cstdio>
#include <exception>

#include "bench/peers/exchange.h"

namespace {

// As in its own examples.
constexpr int kResolution = 90;

djb::vec3 vector_of(const peers::Triple& t) {
  return djb::vec3(static_cast<djb::float_t>(t[0]), static_cast<djb::float_t>(t[1]),
                   static_cast<djb::float_t>(t[2]));
}

void run(const char* file, const char* folder) {
  const djb::merl table(file);
  const auto write = [&](const char* name, double seconds, const djb::brdf& model, const void* parameters) {
    peers::write_values(folder, name, seconds, [&](const peers::Triple& wi, const peers::Triple& wo) {
      const djb::vec3 f = model.eval(vector_of(wi), vector_of(wo), parameters);
      return peers::Triple{f.x, f.y, f.z};
    });
  };
  const peers::Clock clock;
  const djb::tabular tabular(table, kResolution);
  const double tabular_seconds = clock.seconds();
  write("dj_brdf-tabular", tabular_seconds, tabular, nullptr);
  const peers::Clock ggx_clock;
  const djb::microfacet::params parameters = djb::tabular::fit_ggx_parameters(tabular);
  const djb::ggx ggx(tabular.get_fresnel());
  write("dj_brdf-ggx", tabular_seconds + ggx_clock.seconds(), ggx, &parameters);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: dj_brdf_fit FILE.binary DIR\n", stderr);
    return 2;
  }
  try {
    run(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dj_brdf_fit: %s\n", error.what());
    return 1;
  }
  return 0;
}
