// A small least-squares descent for searches by the thousand, where a run of Ceres costs more than its
// residuals. Solutions that are published come from Ceres (fit/solve.h).
#ifndef BRDFIT_FIT_DESCENT_H_
#define BRDFIT_FIT_DESCENT_H_

#include <vector>

#include "fit/problem.h"
#include "fit/solve.h"

namespace brdfit::fit {

struct DescentOptions {
  int max_evaluations = 20;
  // Two steps in a row that change the cost by less than this share of it end the descent.
  double tolerance = 1e-4;
};

// Levenberg-Marquardt from x inside the box. Numbers that rest at a bound with the cost falling outwards are
// held there for a step; one that a step takes to its bound is put there, and the others' step made anew.
Solution descend(const Problem& problem, const std::vector<double>& x, const Box& box,
                 const DescentOptions& options);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_DESCENT_H_
