// Which lobes an asset gets, and whether it gets any: chosen by error under lights that took no part.
//
// Leave-one-out error in closed form redoes the amplitudes alone, and lobes that were optimised on all lights
// flatter it. Here lights are held out in folds and everything is redone without them: the model (by the
// caller), the search, the ridge and the choice of texels. The search of a fold starts from the lobes that
// all of the lights given lead to, which saves most of its time: errors that are to be reported need lights
// held out of those given.
#ifndef BRDFIT_BAKE_CHOOSE_LOBES_H_
#define BRDFIT_BAKE_CHOOSE_LOBES_H_

#include <functional>
#include <span>
#include <vector>

#include "bake/lobe_search.h"
#include "bake/lobes.h"
#include "bake/residual_classes.h"
#include "bake/texel_problem.h"

namespace brdfit::bake {

// The problem of a sample of texels under all lights, its render fitted under the training lights alone
// (ascending indices). Called from several threads at once.
using ProblemOf = std::function<TexelProblem(std::span<const std::size_t> training)>;

struct ChoiceOptions {
  std::vector<int> counts = {8};  // numbers of lobes to choose from, ascending, each in [1, kMaxLobes]
  // The smallest number whose held-out RMSE is within this share of the best is taken.
  double tolerance = 0.01;
  int folds = 6;         // stacks of at most twice as many lights: each light is a fold
  bool optimise = true;  // else uniform lobes alone
  LobeSearchOptions search;
  ClassOptions classes;
  std::function<void()> check;  // called between folds, from several threads; may throw to stop. May be empty
};

// How a kind of lobes did on held-out lights: sums over texels of weight x error^2, per fold.
struct Candidate {
  int count = 0;
  bool optimised = false;
  std::vector<double> errors;
  double error() const;
};

struct LobeChoice {
  LobeSet lobes;  // empty: lobes do not help under lights that took no part
  double ridge = 0.0;
  bool optimised = false;
  std::vector<double> squared_modulation;  // of the sample, as LobeSystem takes it
  LobeSearchResult search;                 // over all lights
  std::vector<double> errors_without;      // per fold, with no lobes
  std::vector<Candidate> candidates;
  double error_without() const;
};

// The folds' lights: spread over the hemisphere, whatever their order in the stack.
std::vector<std::vector<std::size_t>> light_folds(std::span<const Vec3> directions, int folds);

// Uniform lobes are kept where optimised ones are not better held out, or there are fewer than six lights per
// lobe; none where they do not help in three of four folds; none where the gain over no lobes is
// below 0.2% of the squared error, or not larger than its standard error over folds. Parallel over folds; the
// same for any number of threads. Throws std::invalid_argument where counts are outside or there are fewer
// than two lights.
LobeChoice choose_lobes(const ProblemOf& problem_of, std::span<const Vec3> directions,
                        const ChoiceOptions& options = {});

// The same for several lists of counts (options.counts does not matter), which share folds and searches.
std::vector<LobeChoice> choose_lobes_each(const ProblemOf& problem_of, std::span<const Vec3> directions,
                                          const std::vector<std::vector<int>>& groups,
                                          const ChoiceOptions& options = {});

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_CHOOSE_LOBES_H_
