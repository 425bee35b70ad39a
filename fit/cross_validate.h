// The held-out error of sets of groups: each is fitted anew in every fold.
#ifndef BRDFIT_FIT_CROSS_VALIDATE_H_
#define BRDFIT_FIT_CROSS_VALIDATE_H_

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "fit/folds.h"
#include "fit/groups.h"
#include "fit/loss.h"
#include "fit/parameters.h"
#include "fit/problem.h"

namespace brdfit::fit {

// 100 mean |ln((f cos_i + 1e-3) / (r cos_i + 1e-3))| over samples that no stage of a fit saw. The measure of
// the same name on the table is what a fit is judged by, and a mean of absolute values: one bright cell that
// a fold never saw does not decide, as it would in a mean of squares.
struct HeldOut {
  double log_ratio_pct = 0.0;     // mean over folds
  std::vector<double> folds_pct;  // of each
};

// The standard error of the mean over folds of b - a, in percent points. Folds are compared in pairs, as
// what is hard to predict in a block is so for both.
double standard_error_of_difference(const HeldOut& a, const HeldOut& b);

// What all fits of a cross-validation share.
struct CrossValidationOptions {
  Material start;  // model, options, and the values of what is not free
  Tier tier = Tier::kFull;
  FixedValues fixed;
  Loss loss = Loss::kLogRatio;
  std::uint64_t seed = 1;
};

// Remembers every set's fits. A set is fitted in a fold from fresh starts, and from what the same fold found
// for sets that have one group fewer or more: a search over sets that only ever adds to what it has stops
// early, one that only ever begins anew misses minima. What other folds found is never used.
class CrossValidation {
 public:
  CrossValidation(std::vector<Fold> folds, CrossValidationOptions options);

  // Where a fit begins in each fold: at what the fold found for the set `base`. Groups that base lacks begin
  // as the fold found them for the set `donor`, those that donor lacks too at fresh values, as do those in
  // `anew`; there, what has a sign gets the other one.
  struct Origin {
    Groups base;
    Groups donor = {};
    Groups anew = {};
  };
  // A set, and where its fits begin: at origins whose sets have been fitted, and at so many fresh starts.
  struct Request {
    Groups groups;
    std::vector<Origin> origins;
    int fresh_starts = 1;
    std::uint64_t variant = 0;  // of the fresh values, for a set that is fitted again and again
    int kick_rounds = 0;  // a search as of a whole fit (fit/explore.h) with so many; none for a short one
  };

  // Fits sets, in parallel over sets and folds. For a set that was fitted before, the better fit of each fold
  // is kept, as the samples that were fitted have it.
  void fit(const std::vector<Request>& requests);

  bool knows(Groups groups) const { return fits_.contains(groups.bits()); }
  HeldOut held_out(Groups groups) const;
  double error(Groups groups) const { return held_out(groups).log_ratio_pct; }
  // What the folds came to: points to begin with where all samples may be seen.
  std::vector<Material> materials(Groups groups) const;
  // The set fitted to other samples, by one descent from the fold's material that suits them best.
  Material fitted_to(const SampleSet& samples, Groups groups) const;
  // The sum of the costs over folds, on the samples that were fitted.
  double cost(Groups groups) const;

  int free_numbers(Groups groups) const;
  std::size_t sets() const { return fits_.size(); }
  long evaluations() const { return evaluations_; }
  const std::vector<Fold>& folds() const { return folds_; }

 private:
  struct FoldFit {
    Material material;
    double cost = std::numeric_limits<double>::infinity();
    double held_out_pct = 0.0;
    int evaluations = 0;
  };
  struct FoldTargets {
    Targets narrow;
    Targets wide;
  };

  FoldFit fit_fold(const Request& request, std::size_t fold) const;
  FoldFit explore_fold(const Request& request, std::size_t fold) const;
  Material merged(const Origin& origin, std::size_t fold) const;
  Parametrisation parametrisation(Groups groups) const;

  std::vector<Fold> folds_;
  CrossValidationOptions options_;
  std::vector<FoldTargets> targets_;
  std::map<std::uint32_t, std::vector<FoldFit>> fits_;
  long evaluations_ = 0;
};

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_CROSS_VALIDATE_H_
