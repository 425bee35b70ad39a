// brdfit's side of the comparison with peers: samples for all, fits of its own, and the errors of every peer
// that has left values in the folder.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "bench/peers/exchange.h"
#include "brdf/half_diff.h"
#include "brdf/models.h"
#include "fit/fit.h"
#include "fit/metrics.h"
#include "io/merl.h"

namespace {

using namespace brdfit;

constexpr std::size_t kSamples = 20000;
constexpr std::uint64_t kSeed = 1;
constexpr const char* kUsage =
    "usage: peers_bench samples FILE.binary DIR\n"
    "       peers_bench fit FILE.binary DIR       brdfit's own fits\n"
    "       peers_bench errors FILE.binary DIR    of all that have left values in DIR\n";

peers::Triple triple_of(const Vec3& v) {
  return {v.x, v.y, v.z};
}
Vec3 vector_of(const peers::Triple& t) {
  return {t[0], t[1], t[2]};
}

// The cells that a fit with these numbers draws.
void write_samples(const MeasuredTable& table, const std::string& folder) {
  std::vector<std::size_t> cells;
  sample_table(table, kSamples, kSeed, {}, &cells);
  std::vector<peers::Sample> samples;
  for (const std::size_t cell : cells) {
    const DirectionPair pair = directions_from_half_diff(table.grid().angles_of(cell));
    samples.push_back({cell, triple_of(pair.wi), triple_of(pair.wo), table.value(cell)});
  }
  peers::write_samples(folder, samples);
}

void fit_all(const MeasuredTable& table, const std::string& folder) {
  for (const Model model : all_models()) {
    fit::FitOptions options;
    options.model = model;
    options.samples = kSamples;
    options.seed = kSeed;
    const peers::Clock clock;
    const fit::FitResult result = fit::fit(table, options);
    const double seconds = clock.seconds() - result.timings.measure_seconds;
    std::string name = "brdfit-";
    name += name_of(model);
    peers::write_values(folder, name, seconds, [&](const peers::Triple& wi, const peers::Triple& wo) {
      return eval(result.material, vector_of(wi), vector_of(wo));
    });
  }
}

// Planes of a table that holds the sampled cells and no others.
class SampledTable {
 public:
  explicit SampledTable(const Grid& grid) : grid_(grid), planes_(3 * grid.cell_count(), -1.0F) {}
  void set(std::size_t cell, const peers::Triple& f) {
    for (std::size_t c = 0; c < 3; ++c) planes_[c * grid_.cell_count() + cell] = static_cast<float>(f[c]);
  }
  MeasuredTable table() const { return {grid_, planes_}; }

 private:
  Grid grid_;
  std::vector<float> planes_;
};

void print_errors(const MeasuredTable& reference, const std::string& folder, const std::string& name) {
  const std::vector<peers::Sample> samples = peers::read_samples(folder);
  double seconds = 0.0;
  const std::vector<peers::Values> values = peers::read_values(folder, name, seconds);
  if (values.size() != samples.size()) {
    throw std::runtime_error(
        fmt::format("{}: {} values for {} samples", name, values.size(), samples.size()));
  }
  SampledTable fitted(reference.grid());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    peers::Triple mean{};
    for (std::size_t c = 0; c < 3; ++c) {
      const bool is_good = values[k].f[c] >= 0.0 && values[k].swapped[c] >= 0.0;
      mean[c] = is_good ? 0.5 * (values[k].f[c] + values[k].swapped[c]) : -1.0;
    }
    fitted.set(samples[k].cell, mean);
  }
  const fit::Measures m = fit::evaluate(fitted.table(), reference).table;
  fmt::print("{:<22} {:>10.4f} {:>9.3f} {:>9.4f} {:>9.5f} {:>9.5f} {:>9.5f} {:>8} {:>8}\n", name, seconds,
             m.log_ratio_pct, m.relative, m.cube_root, m.srgb, m.cosine_l2, m.cells,
             samples.size() - m.cells);
}

void print_all(const MeasuredTable& table, const std::string& folder) {
  constexpr std::string_view kEnding = ".values.txt";
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    if (file.ends_with(kEnding)) names.push_back(file.substr(0, file.size() - kEnding.size()));
  }
  std::sort(names.begin(), names.end());
  fmt::print("{:<22} {:>10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8}\n", "fit", "seconds", "log_%",
             "relative", "cube_root", "srgb", "cos_l2", "cells", "refused");
  for (const std::string& name : names) print_errors(table, folder, name);
}

int run(const std::string& what, const std::string& file, const std::string& folder) {
  const MeasuredTable table = io::read_merl(file);
  std::filesystem::create_directories(folder);
  if (what == "samples") {
    write_samples(table, folder);
  } else if (what == "fit") {
    fit_all(table, folder);
  } else if (what == "errors") {
    print_all(table, folder);
  } else {
    fmt::print(stderr, "{}", kUsage);
    return 2;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "{}", kUsage);
    return 2;
  }
  try {
    return run(argv[1], argv[2], argv[3]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "peers_bench: {}\n", error.what());
    return 1;
  }
}
