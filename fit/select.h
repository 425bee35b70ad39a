// Which groups a measurement calls for, by held-out error.
#ifndef BRDFIT_FIT_SELECT_H_
#define BRDFIT_FIT_SELECT_H_

#include <string>
#include <vector>

#include "fit/cross_validate.h"

namespace brdfit::fit {

// A group is worth its parameters when the held-out error falls by more than this share of itself. 1% is well
// above what an idle group does to it (about 0.2% of overfit for the largest, with 512 samples in each fold)
// and far below what an effect that is in a material buys.
inline constexpr double kGroupThreshold = 0.01;

// One step of a selection. Errors are those of the best fits that the whole selection found for the sets
// before and after.
struct LadderStep {
  std::vector<std::string> groups;  // that were added or removed
  bool removed = false;
  double held_out_before_pct = 0.0;
  double held_out_after_pct = 0.0;
  double standard_error_pct = 0.0;  // of the difference, over folds
  int parameters = 0;               // free numbers that it added; below 0 where it removed some
  Groups set;                       // after the step
  Material material;                // fitted with that set; see fit_ladder()
};

struct Selection {
  Groups required;  // that it began with
  Groups chosen;
  std::vector<LadderStep> ladder;
  Material material_without;  // fitted with the set that it began with; see fit_ladder()
  double threshold = kGroupThreshold;
  HeldOut held_out;            // of the chosen set
  HeldOut held_out_without;    // of the set that it began with
  HeldOut held_out_all;        // of everything that could be chosen
  int parameters = 0;          // free numbers of the chosen set
  int parameters_without = 0;  // of the set that it began with
  int parameters_all = 0;
  int sets = 0;  // that were fitted in every fold
  long evaluations = 0;
};

struct SelectionOptions {
  Groups usable;
  Groups required;  // stay on
  double threshold = kGroupThreshold;
};

// Fits everything that is usable, then grows from the required groups: each time by the effect, with its
// refinements, whose held-out error is the least, while that is lower by more than the threshold (a share of
// the error). Where everything together beats the outcome by more than the threshold, it begins again from
// everything. Then groups are removed one by one, the least missed first, as long as the error stays within a
// quarter of the threshold of the least that was met. So the outcome is never worse than everything by more
// than the threshold on the held-out cells, with a margin for what they do not tell of others.
Selection select_groups(CrossValidation& validation, Model model, const SelectionOptions& options);

// Fills in the materials of a selection: what each step looks like, fitted to about 2400 of the samples
// of all folds. Held-out errors are not of these materials but of those that the folds came to.
void fit_ladder(const CrossValidation& validation, const SampleSet& samples, Selection& selection);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_SELECT_H_
