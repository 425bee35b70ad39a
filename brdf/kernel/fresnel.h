// Fresnel falloffs, as the share of white that they add: F = f0 + (1 - f0) falloff.
#ifndef BRDFIT_BRDF_KERNEL_FRESNEL_H_
#define BRDFIT_BRDF_KERNEL_FRESNEL_H_

#include "geometry.h"

BRDF_NAMESPACE_BEGIN

// Schlick 1994: (1 - cos_d)^5.
BRDF_GEO_FUNCTION
Geo schlick_falloff(OF_GEO(Geometry) g) {
  return pow5(g.one_minus_cos_d);
}

BRDF_REAL_FUNCTION
Real fresnel(Real f0, Real falloff) {
  return f0 + (REAL(1.0) - f0) * falloff;
}

// Specular reflectance at normal incidence of the metallic workflow: lerp(0.08 specular, base_color,
// metallic).
BRDF_REAL_FUNCTION
Real metallic_f0(Real base_color, Real metallic, Real specular) {
  return lerp_real(REAL(0.08) * specular, base_color, metallic);
}

BRDF_NAMESPACE_END

#endif  // BRDFIT_BRDF_KERNEL_FRESNEL_H_
