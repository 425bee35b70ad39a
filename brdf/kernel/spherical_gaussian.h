// Windowed spherical Gaussians: the lobes over light directions in which Realis stores its error term
// (Jimenez et al. 2023).
#ifndef BRDFIT_BRDF_KERNEL_SPHERICAL_GAUSSIAN_H_
#define BRDFIT_BRDF_KERNEL_SPHERICAL_GAUSSIAN_H_

#include "math.h"

BRDF_NAMESPACE_BEGIN

// 1 - a . b of unit vectors, to its last digits where they are close: a sharp lobe multiplies its error.
BRDF_REAL_FUNCTION
Real one_minus_cos_between(Real a_x, Real a_y, Real a_z, Real b_x, Real b_y, Real b_z) {
  return REAL(0.5) * (square(a_x - b_x) + square(a_y - b_y) + square(a_z - b_z));
}

// 1 on the axis; 0, with slope 0, where the cosine to the axis is cos_cut_off (in [-1, 1)) or less.
BRDF_REAL_FUNCTION
Real window_of_lobe(Real one_minus_cos_axis, Real cos_cut_off) {
  Real u = one_minus_cos_axis / (REAL(1.0) - cos_cut_off);
  Real inside = at_least(REAL(1.0) - u * u, REAL(0.0));
  return inside * inside;
}

// exp(sharpness (cos_axis - 1)) under the window, in [0, 1]. sharpness >= 0; cos_axis is the cosine between
// the lobe's axis and the direction towards the light.
BRDF_REAL_FUNCTION
Real windowed_lobe(Real one_minus_cos_axis, Real sharpness, Real cos_cut_off) {
  return exp(REAL(0.0) - sharpness * one_minus_cos_axis) * window_of_lobe(one_minus_cos_axis, cos_cut_off);
}

BRDF_NAMESPACE_END

#endif  // BRDFIT_BRDF_KERNEL_SPHERICAL_GAUSSIAN_H_
