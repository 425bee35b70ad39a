// How many cells of a table a fit needs: as many as change its result.
//
// The question is whether the same cells of the table would be fitted differently with more of them, so the
// answer is the error on cells that were drawn like those that are fitted, but that no fit sees, whatever its
// size (measured/nested_sample.h). Blocks of angles that are held out (fit/folds.h) answer another: how a
// model does where it was not measured. Their error hardly falls with the size of the sample, as what is
// missing there is not more of the same.
#ifndef BRDFIT_FIT_SAMPLE_SIZE_H_
#define BRDFIT_FIT_SAMPLE_SIZE_H_

#include <cstddef>
#include <vector>

#include "brdf/material.h"
#include "measured/sampling.h"

namespace brdfit::fit {

// Twice as many cells are enough when they change the held-out error by less than this share of it. With an
// excess that falls as 1 / cells, all further doublings together change it by as much again.
inline constexpr double kSizeThreshold = 0.005;
// In percent points of log-ratio: less is nothing, however small the error.
inline constexpr double kLeastSizeChange = 0.01;

struct SizeTrial {
  std::size_t samples = 0;          // cells that were fitted
  double held_out_pct = 0.0;        // log-ratio on the check cells
  double change_pct = 0.0;          // from the size before; 0 for the first
  double standard_error_pct = 0.0;  // of the change, over check cells
};

struct SampleSize {
  std::vector<SizeTrial> trials;
  std::size_t check_cells = 0;  // that no fit saw
  double threshold = kSizeThreshold;
  // Whether the last doubling changed little; else every cell of the table was fitted, those of the check
  // too.
  bool converged = false;
};

// Goes through fits to growing samples.
class SizeChoice {
 public:
  explicit SizeChoice(SampleSet check, double threshold = kSizeThreshold);

  // Takes the outcome of the next size. True when it differs from that of the size before by less than the
  // threshold even where the change is larger than measured by its standard error.
  bool add(std::size_t samples, const Material& material);

  const SampleSize& outcome() const { return outcome_; }

 private:
  SampleSet check_;
  std::vector<double> before_;  // errors of the check cells
  SampleSize outcome_;
};

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_SAMPLE_SIZE_H_
