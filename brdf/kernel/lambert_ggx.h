// Lambert + GGX (Walter et al. 2007; Schlick 1994), with Proxima as an optional diffuse base.
//
//   f = rho/pi + F D V
//
// A model is written in three steps: a *shape* (parameters that all colour channels share), *terms* (what the
// shape and the directions make), and a *colour* (one channel's coefficients) that combines the terms
// linearly. All results are f cos_i in sr^-1; the caller divides by cos_i for f.
//
// What h and the angle between h and wi decide is a step of its own (*line*): along a line of a table, phi_d
// alone changes, and code that walks tables takes that step once for the whole line.
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

// What cos_i and cos_o do not change.
BRDF_REAL_STRUCT(LambertGgxLine) {
  Real falloff;
  Real d;  // D of the lobe
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
OF_REAL(LambertGgxLine) lambert_ggx_line(OF_REAL(LambertGgxShape) shape, OF_GEO(Geometry) g) {
  OF_REAL(LambertGgxLine) line;
  line.falloff = TO_REAL(schlick_falloff(g));
  line.d = ggx_d(shape.alpha, g.h_x * g.h_x + g.h_y * g.h_y, g.cos_h);
  return line;
}

// D V: the same for (wi, wo) and (wo, wi).
BRDF_FUNCTION
Real lambert_ggx_lobe(OF_REAL(LambertGgxShape) shape, OF_REAL(LambertGgxLine) line, OF_GEO(Geometry) g,
                      int masking) {
  return line.d * ggx_v(shape.alpha, g.cos_i, g.cos_o, masking);
}

BRDF_FUNCTION
OF_REAL(LambertGgxTerms)
lambert_ggx_terms_of_line(OF_REAL(LambertGgxShape) shape, OF_REAL(LambertGgxLine) line, Real lobe,
                          OF_GEO(Geometry) g, int diffuse) {
  OF_REAL(LambertGgxTerms) terms;
  terms.diffuse = diffuse_base_cos(shape.alpha, g, diffuse);
  terms.falloff = line.falloff;
  terms.specular = lobe * g.cos_i;
  return terms;
}

BRDF_FUNCTION
OF_REAL(LambertGgxTerms)
lambert_ggx_terms(OF_REAL(LambertGgxShape) shape, OF_GEO(Geometry) g, int masking, int diffuse) {
  OF_REAL(LambertGgxLine) line = lambert_ggx_line(shape, g);
  return lambert_ggx_terms_of_line(shape, line, lambert_ggx_lobe(shape, line, g, masking), g, diffuse);
}

BRDF_REAL_FUNCTION
Real lambert_ggx_combine(OF_REAL(LambertGgxColour) colour, OF_REAL(LambertGgxTerms) terms) {
  return colour.rho * terms.diffuse + fresnel(colour.f0, terms.falloff) * terms.specular;
}

BRDF_NAMESPACE_END

#endif  // BRDFIT_BRDF_KERNEL_LAMBERT_GGX_H_
