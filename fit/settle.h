// Bringing parameters that the samples do not determine to their defaults.
#ifndef BRDFIT_FIT_SETTLE_H_
#define BRDFIT_FIT_SETTLE_H_

#include <string>
#include <vector>

#include "fit/identifiability.h"
#include "fit/problem.h"
#include "fit/solve.h"

namespace brdfit::fit {

// What defaults of unidentifiable parameters may cost together, as a share of the cost.
inline constexpr double kSettlingShare = 1e-4;

struct Settled {
  Solution solution;  // by Ceres, with what was settled held at its default
  Box box;            // of that solve
  // At that solution. What was unidentifiable before stays so, and unseen directions stay those of before:
  // what the tied are solved to holds for the chosen default alone.
  Identifiability identifiability;
  // Per free number: why it is unidentifiable; empty where it is not.
  std::vector<std::string> reasons;
  std::vector<bool> at_default;  // per free number: whether it was brought there
  int evaluations = 0;
};

// solution: of the problem, inside the box. Public parameters with unidentifiable numbers go to their
// defaults one after the other, the others solved anew where need be, as long as the cost does not rise by
// more than kSettlingShare of what it was; where it does, they keep their value. Metallic goes first, then
// the later of the model's table before the earlier, as they are the more special; a base colour stays where
// it is. rough: the same problem, cheaper (in single precision), in which others are solved anew to see what
// a default costs; what is kept is judged and solved in `problem`.
Settled settle_unidentifiable(const Problem& problem, const Problem& rough, const Solution& solution,
                              const Box& box);
Settled settle_unidentifiable(const Problem& problem, const Solution& solution, const Box& box);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_SETTLE_H_
