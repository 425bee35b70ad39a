// The error of a whole fit where it saw nothing: nested evaluation over blocks of angles.
//
// The held-out errors by which a fit chooses its groups (fit/select.h) are the least of many, so they flatter
// what was chosen. Here a table loses a block's cells before anything is done with it: the size of the
// sample, the groups, the loss, the starts and the parameters are all found anew on what is left, and the
// measures are those of the lost cells alone.
#ifndef BRDFIT_FIT_HELD_OUT_H_
#define BRDFIT_FIT_HELD_OUT_H_

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "fit/fit.h"
#include "fit/metrics.h"
#include "measured/table.h"

namespace brdfit::fit {

// One fold: what was fitted without it, and its errors.
struct HeldOutFold {
  Evaluation evaluation;  // on the cells that were held out; `slice` counts those of the slice at 90 deg
  std::size_t observations = 0;  // that were fitted
  int free_parameters = 0;
  Groups groups;
  Loss loss = Loss::kLogRatio;
};

// A mean over folds, each counted alike, and how far they are apart.
struct MeanAndSpread {
  double mean = 0.0;
  double deviation = 0.0;  // standard deviation over folds
};

struct HeldOutEvaluation {
  std::vector<HeldOutFold> folds;
};

// Of a measure over the folds that have cells for it: a member of `of`, which is a member of Evaluation.
MeanAndSpread over_folds(const HeldOutEvaluation& held_out, Measures Evaluation::*of,
                         double Measures::*measure);

// A table split in two by blocks of angles (fit/folds.h).
struct SplitTable {
  MeasuredTable seen;
  MeasuredTable held_out;
};
SplitTable split_table(const MeasuredTable& table, int folds, int fold, std::uint64_t seed);

// The seed of the blocks that evaluate_held_out() loses, for fits with that seed: another than that of a
// choice of groups, whose inner folds would be empty otherwise.
std::uint64_t held_out_seed(std::uint64_t seed);

// Fits a table with options: fit(), or what chooses a loss too. It must look at nothing else that comes from
// the whole table.
using FitTable = std::function<FitResult(const MeasuredTable&, const FitOptions&)>;

// options.held_out_folds times `fit_table`, each without an initial material, which may come from all of the
// data. Folds with nothing to fit or to compare are left out. The blocks are those of held_out_seed(). Throws
// std::invalid_argument where no fold is left.
HeldOutEvaluation evaluate_held_out(const MeasuredTable& table, const FitOptions& options,
                                    const FitTable& fit_table);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_HELD_OUT_H_
