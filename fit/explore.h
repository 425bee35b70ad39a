// The cheap search before the published solve, on a part of the samples: many starts, then rounds of kicks,
// in which one group of parameters of the best candidates is drawn anew and everything is solved again. A
// local minimum mostly has one term in the wrong role (a highlight as retroreflection, say), which a kick
// mends more cheaply than a start.
#ifndef BRDFIT_FIT_EXPLORE_H_
#define BRDFIT_FIT_EXPLORE_H_

#include <cstdint>
#include <vector>

#include "fit/problem.h"
#include "fit/solve.h"

namespace brdfit::fit {

// Where a start ended, and the box in which it stayed.
struct Candidate {
  Solution solution;
  Box box;
};

struct ExploreOptions {
  int starts = 12;
  std::uint64_t seed = 1;
  int kick_rounds = 6;  // fewer where there are few stages
};

// All candidates, best first; the best few stand at minima of `problem`. wide: the same problem with
// residuals squared over a wider range, whose valleys are fewer and in which the search is made. seeds:
// points to begin with besides (an earlier material). Parallel with TBB; the result does not depend on the
// number of threads.
std::vector<Candidate> explore(const Problem& problem, const Problem& wide, const SampleSet& samples,
                               const std::vector<std::vector<double>>& seeds, const ExploreOptions& options);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_EXPLORE_H_
