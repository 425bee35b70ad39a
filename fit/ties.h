// Ties that a bound hides.
#ifndef BRDFIT_FIT_TIES_H_
#define BRDFIT_FIT_TIES_H_

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fit/identifiability.h"
#include "fit/solve.h"

namespace brdfit::fit {

// A solve that drifts along an unseen direction ends where a bound stops it. The others are then known only
// for that bound, while the way back costs nothing. So unseen directions are looked for once more with
// numbers at bounds among the rest: all numbers that take a part in one that leads back into the box are
// unidentifiable. Adds to `identifiability` (statuses and unseen directions); gram and held are those that it
// came from.
void add_hidden_ties(const Parametrisation& parametrisation, std::span<const double> x, const Box& box,
                     const Eigen::MatrixXd& gram, const std::vector<bool>& held,
                     Identifiability& identifiability);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_TIES_H_
