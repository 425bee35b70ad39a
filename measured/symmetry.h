// How far a table is from its own mirror image.
#ifndef BRDFIT_MEASURED_SYMMETRY_H_
#define BRDFIT_MEASURED_SYMMETRY_H_

#include "measured/table.h"

namespace brdfit {

// An isotropic material looks the same in a mirror, and a reciprocal one gives the same f for phi_d and phi_d
// + pi: so the cells at phi_d and pi - phi_d hold one value twice, and their difference is error of
// measurement. Where it is large, spheres drawn from the table have a seam along the plane of incidence.
//
// 100 mean |ln((f + 1e-3) / (f' + 1e-3))| over channels and the pairs of valid cells; 0 where there is no
// pair.
double mirror_asymmetry_pct(const MeasuredTable& table);

}  // namespace brdfit

#endif  // BRDFIT_MEASURED_SYMMETRY_H_
