// GGX microfacets: distribution and masking (Walter et al. 2007, eqs. 33-34; Heitz 2014 for the
// height-correlated form), and the clearcoat distribution GTR1 (Burley 2012).
#ifndef BRDFIT_BRDF_KERNEL_GGX_H_
#define BRDFIT_BRDF_KERNEL_GGX_H_

#include "geometry.h"

// The masking option of a material.
#define BRDF_MASKING_SEPARABLE 0
#define BRDF_MASKING_CORRELATED 1

BRDF_NAMESPACE_BEGIN

// The distribution D of facets, in sr^-1, from the components of h: sin_h_squared = h_x^2 + h_y^2. (1 -
// cos_h^2 in its place loses three digits in single precision.)
BRDF_FUNCTION
Real ggx_d(Real alpha, Geo sin_h_squared, Geo cos_h) {
  Real a2 = alpha * alpha;
  Real q = a2 * (cos_h * cos_h) + sin_h_squared;
  return a2 / (REAL(BRDF_PI) * q * q);
}

// As ggx_d, anisotropic, with alpha_x, alpha_y > 0.
BRDF_FUNCTION
Real ggx_d_anisotropic(Real alpha_x, Real alpha_y, Geo h_x, Geo h_y, Geo cos_h) {
  Real q = square(h_x / alpha_x) + square(h_y / alpha_y) + cos_h * cos_h;
  return REAL(1.0) / (REAL(BRDF_PI) * alpha_x * alpha_y * q * q);
}

// sqrt(alpha^2 + (1 - alpha^2) c^2), the root in Smith's function for a direction with cosine c.
BRDF_FUNCTION
Real smith_root(Real alpha, Geo cosine) {
  Real a2 = alpha * alpha;
  Geo c2 = cosine * cosine;
  return sqrt(a2 * (GEO(1.0) - c2) + c2);
}

// Smith's G1 / (2 cosine): one direction's share of V = G / (4 cos_i cos_o).
BRDF_FUNCTION
Real smith_share(Real alpha, Geo cosine) {
  return REAL(1.0) / (cosine + smith_root(alpha, cosine));
}

BRDF_FUNCTION
Real smith_share_anisotropic(Real alpha_x, Real alpha_y, Geo w_x, Geo w_y, Geo cosine) {
  return REAL(1.0) / (cosine + sqrt(square(w_x * alpha_x) + square(w_y * alpha_y) + cosine * cosine));
}

// V = G / (4 cos_i cos_o) for cos_i, cos_o > 0, with the named masking.
BRDF_FUNCTION
Real ggx_v(Real alpha, Geo cos_i, Geo cos_o, int masking) {
  if (masking == BRDF_MASKING_CORRELATED) {
    Real sum = cos_i * smith_root(alpha, cos_o) + cos_o * smith_root(alpha, cos_i);
    return REAL(0.5) / at_least(sum, REAL(BRDF_TINY));
  }
  return smith_share(alpha, cos_i) * smith_share(alpha, cos_o);
}

// GTR1 (Burley 2012, eq. 4), for alpha in (0, 1); 1/pi where alpha >= 1.
BRDF_FUNCTION
Real gtr1_d(Real alpha, Geo sin_h_squared, Geo cos_h) {
  Real a2 = alpha * alpha;
  Real a2_below_1 = select(a2 < REAL(1.0), a2, REAL(0.5));
  Real d = (a2_below_1 - REAL(1.0)) /
           (REAL(BRDF_PI) * log(a2_below_1) * (a2_below_1 * (cos_h * cos_h) + sin_h_squared));
  return select(a2 < REAL(1.0), d, REAL(BRDF_INV_PI));
}

BRDF_NAMESPACE_END

#endif  // BRDFIT_BRDF_KERNEL_GGX_H_
