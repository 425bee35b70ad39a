// Lambert + GGX (Walter et al. 2007; Schlick 1994), with Proxima as an optional diffuse base.
//
//   f = rho/pi + F D V
//
// A model is written in three steps: a *shape* (parameters that all colour channels share), *terms* (what the
// shape and the directions make), and a *colour* (one channel's coefficients) that combines the terms
// linearly. All results are f cos_i in sr^-1; the caller divides by cos_i for f.
#ifndef BRDFIT_BRDF_KERNEL_LAMBERT_GGX_H_
#define BRDFIT_BRDF_KERNEL_LAMBERT_GGX_H_

#include "diffuse.h"
#include "fresnel.h"
#include "ggx.h"

BRDF_NAMESPACE_BEGIN

BRDF_REAL_STRUCT(LambertGgxShape) {
  Real alpha;
};

BRDF_REAL_STRUCT(LambertGgxColour) {
  Real rho;  // diffuse albedo
  Real f0;
};

BRDF_REAL_STRUCT(LambertGgxTerms) {
  Real diffuse;   // f cos_i of the diffuse base per unit albedo
  Real falloff;   // Schlick's (1 - cos_d)^5
  Real specular;  // D V cos_i
};

BRDF_REAL_FUNCTION
OF_REAL(LambertGgxShape) lambert_ggx_shape(Real roughness) {
  OF_REAL(LambertGgxShape) shape;
  shape.alpha = roughness * roughness;
  return shape;
}

BRDF_REAL_FUNCTION
OF_REAL(LambertGgxColour) lambert_ggx_colour(Real base_color, Real metallic, Real specular) {
  OF_REAL(LambertGgxColour) colour;
  colour.rho = base_color * (REAL(1.0) - metallic);
  colour.f0 = metallic_f0(base_color, metallic, specular);
  return colour;
}

BRDF_FUNCTION
OF_REAL(LambertGgxTerms)
lambert_ggx_terms(OF_REAL(LambertGgxShape) shape, OF_GEO(Geometry) g, int masking, int diffuse) {
  OF_REAL(LambertGgxTerms) terms;
  terms.diffuse = diffuse_base_cos(shape.alpha, g, diffuse);
  terms.falloff = TO_REAL(schlick_falloff(g));
  terms.specular = ggx_lobe(shape.alpha, g, masking) * g.cos_i;
  return terms;
}

BRDF_REAL_FUNCTION
Real lambert_ggx_combine(OF_REAL(LambertGgxColour) colour, OF_REAL(LambertGgxTerms) terms) {
  return colour.rho * terms.diffuse + fresnel(colour.f0, terms.falloff) * terms.specular;
}

BRDF_NAMESPACE_END

#endif  // BRDFIT_BRDF_KERNEL_LAMBERT_GGX_H_
