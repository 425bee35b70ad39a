// Where a descent stays although it need not: a flat part of a residual.
#ifndef BRDFIT_FIT_PLATEAU_H_
#define BRDFIT_FIT_PLATEAU_H_

#include <vector>

#include "fit/parameters.h"

namespace brdfit::fit {

// A second lobe as rough as can be, which is where roughness times scale is 1 or more, does not change with
// its scale: a descent that gets there stays. Takes the scale back to where it counts. Returns whether it was
// beyond; false where roughness or scale is not free.
bool leave_plateau(const Parametrisation& parametrisation, std::vector<double>& x);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_PLATEAU_H_
