// How sure a fit is of each parameter: standard errors from the scatter of the samples' gradients.
#ifndef BRDFIT_FIT_UNCERTAINTY_H_
#define BRDFIT_FIT_UNCERTAINTY_H_

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "fit/identifiability.h"
#include "fit/problem.h"
#include "fit/solve.h"

namespace brdfit::fit {

// The pseudo-inverse of a Gram matrix J^T J, by Ceres' covariance (DENSE_SVD), in units of `scale`: of
// diag(scale) J^T J diag(scale). Directions whose singular value is below kSingularThreshold of the largest
// are left out.
Eigen::MatrixXd inverse_of_gram(const Eigen::MatrixXd& gram, const Eigen::VectorXd& scale);

// What is known of the free numbers at a solution.
struct Uncertainty {
  // Of all free numbers, in their own units; 0 in rows and columns of those that were held.
  Eigen::MatrixXd covariance;
  // Numbers with a standard error: away from bounds, moved by the solve, and identifiable.
  std::vector<bool> known;
};

// The covariance of a solution by a jackknife: each of up to 256 groups of neighbouring samples is left out
// in turn, and the others are solved anew by one Newton step. So noise may differ from cell to cell, may be
// correlated within a group, and need not be what the loss was made for; what must hold is that groups are
// independent of each other, and that a step is small enough for residuals to be linear. Numbers at bounds of
// the box or of their ranges, and those that do not move, are held: the errors of others are for that case. A
// part in unseen directions too small to call a number unidentifiable is added to its variance.
Uncertainty estimate_uncertainty(const Problem& problem, std::span<const double> x, const Box& box,
                                 const Identifiability& identifiability);

// Fills in ParameterState::standard_error. An intensity and its tint, whose products are the free numbers,
// get theirs by linear propagation. A tint's largest channel is 1 by definition and has none.
void add_standard_errors(const Parametrisation& parametrisation, std::span<const double> x,
                         const Uncertainty& uncertainty, std::vector<ParameterState>& states);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_UNCERTAINTY_H_
