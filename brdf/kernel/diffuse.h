// The diffuse base that the material option `diffuse` names, per unit albedo.
#ifndef BRDFIT_BRDF_KERNEL_DIFFUSE_H_
#define BRDFIT_BRDF_KERNEL_DIFFUSE_H_

#include "proxima.h"

#define BRDF_DIFFUSE_LAMBERT 0
#define BRDF_DIFFUSE_PROXIMA 1

BRDF_NAMESPACE_BEGIN

// f cos_i of the diffuse base per unit albedo, in sr^-1, for cos_i > 0.
BRDF_FUNCTION
Real diffuse_base_cos(Real alpha, OF_GEO(Geometry) g, int diffuse) {
  if (diffuse == BRDF_DIFFUSE_PROXIMA) {
    return proxima_eval_cos(alpha, g.cos_i, g.cos_d, g.cos_k);
  }
  return TO_REAL(GEO(BRDF_INV_PI) * g.cos_i);
}

BRDF_NAMESPACE_END

#endif  // BRDFIT_BRDF_KERNEL_DIFFUSE_H_
