// Realis at run time: stored codes back to amplitudes, and the fade where a surface is no longer what was
// baked (Jimenez et al. 2023).
#ifndef BRDFIT_BRDF_KERNEL_REALIS_H_
#define BRDFIT_BRDF_KERNEL_REALIS_H_

#include "math.h"

BRDF_NAMESPACE_BEGIN

// The amplitude that a stored whole number stands for; `zero` is the one of amplitude 0. As this is linear,
// textures of 8 bits may be filtered before it.
BRDF_REAL_FUNCTION
Real realis_amplitude(Real stored, Real zero, Real step) {
  return (stored - zero) * step;
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
