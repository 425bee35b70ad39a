// Realis at run time: stored codes back to amplitudes, and the fade where a surface is no longer what was
// baked (Jimenez et al. 2023).
#ifndef BRDFIT_BRDF_KERNEL_REALIS_H_
#define BRDFIT_BRDF_KERNEL_REALIS_H_

#include "math.h"

BRDF_NAMESPACE_BEGIN

// The amplitude that a code stands for. Codes are whole numbers in [-largest_code, largest_code]; precision
// is the amplitude of the largest one.
BRDF_REAL_FUNCTION
Real realis_amplitude(Real code, Real largest_code, Real largest_amplitude) {
  return code / largest_code * largest_amplitude;
}

// How much of the correction is left, in [0, 1]: 1 where the surface is as it was baked, falling steadily to
// 0 where the albedo (linear RGB, as a point) has moved by albedo_range or the normal has turned by the angle
// whose cosine is cos_normal_range (in [-1, 1)).
BRDF_REAL_FUNCTION
Real realis_fade(Real albedo_distance, Real cos_normals, Real albedo_range, Real cos_normal_range) {
  Real albedo_left = REAL(1.0) - albedo_distance / albedo_range;
  Real normal_left = (cos_normals - cos_normal_range) / (REAL(1.0) - cos_normal_range);
  return clamp01(albedo_left) * clamp01(normal_left);
}

BRDF_NAMESPACE_END

#endif  // BRDFIT_BRDF_KERNEL_REALIS_H_
