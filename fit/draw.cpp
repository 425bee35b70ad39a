// Which sample a fit asks for.
#include "fit/draw.h"

#include <stdexcept>

#include "fit/folds.h"

namespace brdfit::fit {
namespace {

// Their error is known to about 1% of itself, and differences between two fits' far better.
constexpr std::size_t kChecked = 4096;

SamplingOptions sampling_of(const FitOptions& options) {
  SamplingOptions sampling;
  sampling.max_theta_deg = options.max_theta_deg;
  return sampling;
}

}  // namespace

Drawn draw_samples(const MeasuredTable& table, const FitOptions& options) {
  Drawn drawn;
  const bool chooses = options.choose_samples && table.valid_count() >= kLeastToChoose;
  if (options.on == FitOn::kSlices) {
    drawn.samples = sample_slices(table, options.phi_d_deg, sampling_of(options), &drawn.cells);
  } else if (chooses) {
    drawn.nested.emplace(
        table, NestedSample::Options{kExploredOfTable, kChecked, options.seed, sampling_of(options)});
    drawn.samples = drawn.nested->samples(&drawn.cells);
  } else {
    const std::size_t count = options.choose_samples ? kAllSamples : options.samples;
    drawn.samples = sample_table(table, count, options.seed, sampling_of(options), &drawn.cells);
  }
  if (drawn.samples.size() == 0) throw std::invalid_argument("no valid cell lies within the given angles");
  return drawn;
}

Drawn draw_for_folds(const Drawn& drawn) {
  if (!drawn.nested) return drawn;
  const FoldOptions folding;
  const std::size_t wanted = static_cast<std::size_t>(folding.folds) * folding.validation_cells;
  NestedSample larger = *drawn.nested;
  while (larger.size() < wanted && larger.grow()) {
  }
  Drawn result;
  result.samples = larger.samples(&result.cells);
  return result;
}

SampleSet draw_all(const MeasuredTable& table, const FitOptions& options) {
  return sample_table(table, kAllSamples, options.seed, sampling_of(options));
}

}  // namespace brdfit::fit
