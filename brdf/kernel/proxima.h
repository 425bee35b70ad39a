// Proxima (Jimenez et al. 2023): the diffuse reflection of a GGX microsurface with Lambertian facets.
//
// Its product with cos_i is the bounded function: f alone grows without limit as cos_i goes to 0.
#ifndef BRDFIT_BRDF_KERNEL_PROXIMA_H_
#define BRDFIT_BRDF_KERNEL_PROXIMA_H_

#include "geometry.h"

BRDF_NAMESPACE_BEGIN

// The part of f cos_i per unit albedo/pi and unit alpha that Proxima adds to Lambert's cos_i.
BRDF_GEO_FUNCTION
Geo proxima_excess(Geo cos_i, Geo cos_d) {
  // cos_k = -(wo . wi) = 1 - 2 cos_d^2
  Geo cos_k = at_least(GEO(1.0) - GEO(2.0) * cos_d * cos_d, GEO(0.0));
  return (GEO(0.19) - GEO(0.55) * cos_i) * (GEO(1.0) - sqrt(cos_k));
}

// f cos_i of the diffuse part per unit albedo, in sr^-1.
BRDF_FUNCTION
Real proxima_eval_cos(Real alpha, Geo cos_i, Geo cos_d) {
  return REAL(BRDF_INV_PI) * (alpha * proxima_excess(cos_i, cos_d) + cos_i);
}

BRDF_NAMESPACE_END

#endif  // BRDFIT_BRDF_KERNEL_PROXIMA_H_
