// The search's own descent: Levenberg-Marquardt steps inside a box, one Gram matrix each. A published
// solution comes from Ceres (fit/solve.h); here it only matters to see quickly what a start is worth.
#ifndef BRDFIT_FIT_DESCEND_H_
#define BRDFIT_FIT_DESCEND_H_

#include <limits>
#include <vector>

#include "fit/problem.h"
#include "fit/solve.h"

namespace brdfit::fit {

struct DescentOptions {
  int max_iterations = 20;
  // Stops when a step changes the cost by less than this share of it.
  double function_tolerance = 1e-5;
  // How much of the Gram matrix' diagonal is added to it at first.
  double damping = 1e-2;
  // Stops as well when the cost would not get down to this in the iterations left if each brought as much as
  // the last step. (Steps bring less and less.)
  double goal = std::numeric_limits<double>::infinity();
};

// Steps from x inside the box. What presses against a bound stays there while the others move. `converged`
// and `termination` are not those of Ceres and not for publication.
Solution descend(const Problem& problem, const std::vector<double>& x, const Box& box,
                 const DescentOptions& options);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_DESCEND_H_
