// Timing of evaluations.
#include "cli/ladder_cost.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "brdf/simd/dispatch.h"
#include "cli/common.h"
#include "measured/sampling.h"

namespace brdfit::cli {
namespace {

constexpr int kRepeats = 7;  // the fastest counts: whatever else runs can only add

// Pairs all over the hemisphere.
SampleSet pairs() {
  SampleSet samples;
  constexpr int kAngles = 8;
  for (int h = 0; h < kAngles; ++h) {
    for (int d = 0; d < kAngles; ++d) {
      for (int p = 0; p < kAngles; ++p) {
        const auto angle = [](int k, double largest) { return (k + 0.5) / kAngles * largest; };
        samples.add(cell_geometry({angle(h, 0.7), angle(d, 0.7), angle(p, std::numbers::pi)}), {}, 1.0);
      }
    }
  }
  samples.finish();
  return samples;
}

double seconds_per_evaluation(const Material& material, const SampleSet& samples) {
  const simd::Coefficients coefficients = simd::coefficients_of(material);
  const simd::EvalColumns evaluate = simd::eval_columns(simd::best_isa());
  const std::size_t n = samples.padded_size();
  std::vector<double> columns(3 * n);
  double* const out[3] = {columns.data(), columns.data() + n, columns.data() + 2 * n};
  double least = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const Stopwatch watch;
    evaluate(coefficients, samples.geometry(), n, out);
    least = std::min(least, watch.seconds() / static_cast<double>(n));
  }
  return least;
}

}  // namespace

std::vector<double> ladder_costs(const fit::FitResult& result) {
  if (!result.selection) return {};
  const SampleSet samples = pairs();
  const auto cost_with = [&](fit::Groups groups) {
    Material material = result.material;
    material.set_effects(fit::effects_of_groups(material.model(), groups));
    return seconds_per_evaluation(material, samples);
  };
  std::vector<double> costs = {cost_with(result.selection->required)};
  for (const fit::LadderStep& step : result.selection->ladder) costs.push_back(cost_with(step.set));
  return costs;
}

}  // namespace brdfit::cli
