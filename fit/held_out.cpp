// Tables with holes, and fits to them.
#include "fit/held_out.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "fit/folds.h"

namespace brdfit::fit {
namespace {

constexpr std::uint64_t kOtherSeed = 0x9e3779b97f4a7c15;

bool has_slice_to_fit(const MeasuredTable& table, const FitOptions& options) {
  if (options.on == FitOn::kTable) return true;
  return sample_slices(table, options.phi_d_deg, {options.max_theta_deg}).size() > 0;
}

}  // namespace

MeanAndSpread over_folds(const HeldOutEvaluation& held_out, Measures Evaluation::*of,
                         double Measures::*measure) {
  std::vector<double> values;
  for (const HeldOutFold& fold : held_out.folds) {
    const Measures& measures = fold.evaluation.*of;
    if (measures.cells > 0) values.push_back(measures.*measure);
  }
  MeanAndSpread result;
  const auto n = static_cast<double>(values.size());
  for (const double value : values) result.mean += value / n;
  if (values.size() < 2) return result;
  for (const double value : values) result.deviation += std::pow(value - result.mean, 2) / (n - 1.0);
  result.deviation = std::sqrt(result.deviation);
  return result;
}

SplitTable split_table(const MeasuredTable& table, int folds, int fold, std::uint64_t seed) {
  const AngleBlocks blocks(table.grid(), folds, seed);
  const std::size_t cells = table.grid().cell_count();
  std::vector<float> seen;
  seen.reserve(3 * cells);
  for (int c = 0; c < 3; ++c) seen.insert(seen.end(), table.plane(c).begin(), table.plane(c).end());
  std::vector<float> held_out = seen;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    std::vector<float>& without = blocks.fold_of(cell) == fold ? seen : held_out;
    for (std::size_t c = 0; c < 3; ++c) without[c * cells + cell] = -1.0F;
  }
  return {MeasuredTable(table.grid(), std::move(seen)), MeasuredTable(table.grid(), std::move(held_out))};
}

std::uint64_t held_out_seed(std::uint64_t seed) {
  return seed ^ kOtherSeed;
}

HeldOutEvaluation evaluate_held_out(const MeasuredTable& table, const FitOptions& options,
                                    const FitTable& fit_table) {
  FitOptions without_init = options;
  without_init.init.reset();
  HeldOutEvaluation result;
  for (int fold = 0; fold < options.held_out_folds; ++fold) {
    const SplitTable split = split_table(table, options.held_out_folds, fold, held_out_seed(options.seed));
    if (split.seen.valid_count() == 0 || split.held_out.valid_count() == 0) continue;
    if (!has_slice_to_fit(split.seen, options)) continue;
    const FitResult fitted = fit_table(split.seen, without_init);
    result.folds.push_back({evaluate(fitted.material, split.held_out, options.max_theta_deg),
                            fitted.observations, fitted.free_parameters, fitted.groups, fitted.options.loss});
  }
  if (result.folds.empty()) {
    throw std::invalid_argument("no block of angles can be held out with something left to fit");
  }
  return result;
}

}  // namespace brdfit::fit
