// The choice of a loss by how the result looks: which weighting is best differs from material to material
// (Bieron and Peers 2020).
#ifndef BRDFIT_FIT_CHOOSE_LOSS_H_
#define BRDFIT_FIT_CHOOSE_LOSS_H_

#include <functional>

#include "fit/fit.h"

namespace brdfit::fit {

// How a material looks beside the measurement: the smaller, the better. Never NaN. (Drawing is not this
// room's.)
using Judge = std::function<double(const Material&)>;

// Fits under every loss and keeps the result that the judge finds best; the first of equals. What does not
// depend on the loss is done once: groups that are to be chosen are chosen with the first, by held-out
// log-ratio. FitResult::losses holds the trials, a note says which won and by how much. Throws as fit().
FitResult fit_under_best_loss(const MeasuredTable& table, const FitOptions& options, const Judge& judge);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_CHOOSE_LOSS_H_
