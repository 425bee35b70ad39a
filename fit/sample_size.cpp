// Paired differences of errors on check cells.
#include "fit/sample_size.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "fit/log_ratio.h"

namespace brdfit::fit {

SizeChoice::SizeChoice(SampleSet check, double threshold) : check_(std::move(check)) {
  outcome_.check_cells = check_.size();
  outcome_.threshold = threshold;
}

bool SizeChoice::add(std::size_t samples, const Material& material) {
  const std::vector<double> errors = log_ratios_pct(material, check_);
  const std::span<const double> weight = check_.weight();
  SizeTrial trial;
  trial.samples = samples;
  trial.held_out_pct = std::inner_product(errors.begin(), errors.end(), weight.begin(), 0.0);
  if (!before_.empty()) {
    trial.change_pct = trial.held_out_pct - outcome_.trials.back().held_out_pct;
    double variance = 0.0;
    for (std::size_t k = 0; k < errors.size(); ++k) {
      variance += std::pow(weight[k] * (errors[k] - before_[k] - trial.change_pct), 2);
    }
    trial.standard_error_pct = std::sqrt(variance);
    const double bound = std::max(outcome_.threshold * trial.held_out_pct, kLeastSizeChange);
    outcome_.converged = std::abs(trial.change_pct) + trial.standard_error_pct <= bound;
  }
  outcome_.trials.push_back(trial);
  before_ = errors;
  return outcome_.converged;
}

}  // namespace brdfit::fit
