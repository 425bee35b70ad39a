// Proxima (Jimenez et al. 2023): the diffuse reflection of a GGX microsurface with Lambertian facets.
//
// Its product with cos_i is the bounded function: f alone grows without limit as cos_i goes to 0.
#ifndef BRDFIT_BRDF_KERNEL_PROXIMA_H_
#define BRDFIT_BRDF_KERNEL_PROXIMA_H_

#include "geometry.h"

BRDF_NAMESPACE_BEGIN

// The part of f cos_i per unit albedo/pi and unit alpha that Proxima adds to Lambert's cos_i. At right angles
// (cos_k = -(wi . wo) = 0) it has a kink of infinite slope: cos_k must be known to its last digits there.
BRDF_GEO_FUNCTION
Geo proxima_excess(Geo cos_i, Geo cos_d, Geo cos_k) {
  // 1 - sqrt(cos_k), by the root's conjugate: 1 - cos_k = 2 cos_d^2.
  Geo root = sqrt(at_least(cos_k, GEO(0.0)));
  Geo one_minus_root = select(cos_k > GEO(0.0), GEO(2.0) * cos_d * cos_d / (GEO(1.0) + root), GEO(1.0));
  return (GEO(0.19) - GEO(0.55) * cos_i) * one_minus_root;
}

// f cos_i of the diffuse part per unit albedo, in sr^-1.
BRDF_FUNCTION
Real proxima_eval_cos(Real alpha, Geo cos_i, Geo cos_d, Geo cos_k) {
  return REAL(BRDF_INV_PI) * (alpha * proxima_excess(cos_i, cos_d, cos_k) + cos_i);
}

BRDF_NAMESPACE_END

#endif  // BRDFIT_BRDF_KERNEL_PROXIMA_H_
