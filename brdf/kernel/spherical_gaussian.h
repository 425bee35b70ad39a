// Windowed spherical Gaussians: the lobes over light directions in which Realis stores its error term
// (Jimenez et al. 2023).
#ifndef BRDFIT_BRDF_KERNEL_SPHERICAL_GAUSSIAN_H_
#define BRDFIT_BRDF_KERNEL_SPHERICAL_GAUSSIAN_H_

#include "math.h"

BRDF_NAMESPACE_BEGIN

// 1 on the axis; 0, with slope 0, where the cosine to the axis is cos_cut_off (in [-1, 1)) or less.
BRDF_REAL_FUNCTION
Real lobe_window(Real cos_axis, Real cos_cut_off) {
  Real u = (REAL(1.0) - cos_axis) / (REAL(1.0) - cos_cut_off);
  Real inside = at_least(REAL(1.0) - u * u, REAL(0.0));
  return inside * inside;
}

// exp(sharpness (cos_axis - 1)) under the window. sharpness >= 0; cos_axis is the cosine between the lobe's
// axis and the direction towards the light.
BRDF_REAL_FUNCTION
Real windowed_spherical_gaussian(Real cos_axis, Real sharpness, Real cos_cut_off) {
  return exp(sharpness * (cos_axis - REAL(1.0))) * lobe_window(cos_axis, cos_cut_off);
}

BRDF_NAMESPACE_END

#endif  // BRDFIT_BRDF_KERNEL_SPHERICAL_GAUSSIAN_H_
