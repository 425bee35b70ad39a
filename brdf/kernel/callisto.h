// Callisto (Jimenez et al. 2023), with Proxima as an optional diffuse base.
//
//   f = (c1 f_diffuse + f_specular) c2
//
// c1: diffuse Fresnel and retroreflection; c2: smooth terminator; f_specular: dual GGX with a Fresnel falloff
// of its own. Parameters, ranges and defaults: brdf/material.h. Steps (shape, terms, colour): lambert_ggx.h.
// An effect that is off is not computed, and its parameters do not matter.
#ifndef BRDFIT_BRDF_KERNEL_CALLISTO_H_
#define BRDFIT_BRDF_KERNEL_CALLISTO_H_

#include "diffuse.h"
#include "fresnel.h"
#include "ggx.h"

// Bits of `effects`.
#define BRDF_EFFECT_SPECULAR_FRESNEL_FALLOFF 1
#define BRDF_EFFECT_DIFFUSE_FRESNEL 2
#define BRDF_EFFECT_RETROREFLECTION 4
#define BRDF_EFFECT_SMOOTH_TERMINATOR 8
#define BRDF_EFFECT_DUAL_SPECULAR 16

BRDF_NAMESPACE_BEGIN

BRDF_REAL_STRUCT(CallistoShape) {
  Real alpha_1;
  Real alpha_2;
  Real opacity;           // of the second lobe
  Real fresnel_exponent;  // 5 r(n_f), r(x) = 2 (1 - x)
  Real fresnel_tangent_exponent;
  Real retro_exponent;
  Real retro_tangent_exponent;
  Real specular_falloff;  // n_s
  Real terminator_length;
};

BRDF_REAL_STRUCT(CallistoColour) {
  Real rho;  // diffuse albedo
  Real f0;
  Real fresnel;     // rho_f: intensity times tint
  Real retro;       // rho_r
  Real terminator;  // o
};

BRDF_REAL_STRUCT(CallistoTerms) {
  Real diffuse;          // f cos_i of the diffuse base per unit albedo
  Real fresnel;          // a_f
  Real less_fresnel;     // 1 - a_f, to its last digits
  Real retro;            // a_r
  Real less_retro;       // 1 - a_r
  Real falloff;          // of the specular Fresnel
  Real specular;         // blended D V cos_i of the lobes
  Real terminator;       // a_s
  Real terminator_step;  // smoothstep(0, a_s p, cos_i)
};

// What cos_i and cos_o do not change; see lambert_ggx.h.
BRDF_REAL_STRUCT(CallistoLine) {
  Real fresnel;       // a_f
  Real less_fresnel;  // 1 - a_f
  Real retro;         // a_r
  Real less_retro;    // 1 - a_r
  Real falloff;       // of the specular Fresnel
  Real d_1;           // D of the lobes
  Real d_2;
  Real terminator;  // a_s
};

// The exponent 5 r(falloff) of a falloff parameter in [0, 1].
BRDF_REAL_FUNCTION
Real callisto_exponent(Real falloff) {
  return REAL(10.0) * (REAL(1.0) - falloff);
}

BRDF_REAL_FUNCTION
OF_REAL(CallistoShape)
callisto_shape(Real roughness, Real dual_roughness_scale, Real dual_opacity, Real diffuse_fresnel_falloff,
               Real diffuse_fresnel_tangent_falloff, Real retroreflection_falloff,
               Real retroreflection_tangent_falloff, Real specular_fresnel_falloff, Real terminator_length) {
  OF_REAL(CallistoShape) shape;
  Real roughness_2 = at_most(roughness * dual_roughness_scale, REAL(1.0));
  shape.alpha_1 = roughness * roughness;
  shape.alpha_2 = roughness_2 * roughness_2;
  shape.opacity = dual_opacity;
  shape.fresnel_exponent = callisto_exponent(diffuse_fresnel_falloff);
  shape.fresnel_tangent_exponent = callisto_exponent(diffuse_fresnel_tangent_falloff);
  shape.retro_exponent = callisto_exponent(retroreflection_falloff);
  shape.retro_tangent_exponent = callisto_exponent(retroreflection_tangent_falloff);
  shape.specular_falloff = specular_fresnel_falloff;
  shape.terminator_length = terminator_length;
  return shape;
}

// The last three: intensity times tint of diffuse Fresnel, retroreflection and smooth terminator.
BRDF_REAL_FUNCTION
OF_REAL(CallistoColour)
callisto_colour(Real base_color, Real metallic, Real specular, Real fresnel_color, Real retro_color,
                Real terminator_color) {
  OF_REAL(CallistoColour) colour;
  colour.rho = base_color * (REAL(1.0) - metallic);
  colour.f0 = metallic_f0(base_color, metallic, specular);
  colour.fresnel = fresnel_color;
  colour.retro = retro_color;
  colour.terminator = terminator_color;
  return colour;
}

// t(2 n_s) (1 - cos_d)^(5 r(n_s)): 0 at n_s = 0, Schlick at 0.5 (a kink), 1 at n_s = 1.
BRDF_FUNCTION
Real callisto_specular_falloff(Real specular_falloff, Geo one_minus_cos_d, Geo log_one_minus_cos_d) {
  return clamp01(REAL(2.0) * specular_falloff) *
         power_from_log(one_minus_cos_d, log_one_minus_cos_d, callisto_exponent(specular_falloff));
}

// The mask a_s that keeps the terminator away from retroreflection and Fresnel.
BRDF_GEO_FUNCTION
Geo callisto_terminator_mask(OF_GEO(Geometry) g) {
  Geo d = g.one_minus_cos_d;
  Geo h = g.one_minus_cos_h;
  return (GEO(1.0) - d * d * d) * (GEO(1.0) - h * h * h);
}

BRDF_FUNCTION
OF_REAL(CallistoLine)
callisto_line(OF_REAL(CallistoShape) shape, OF_GEO(Geometry) g, OF_GEO(GeometryLogs) logs, int effects) {
  OF_REAL(CallistoLine) line;
  Geo sin_h_squared = g.h_x * g.h_x + g.h_y * g.h_y;
  line.fresnel = REAL(0.0);
  line.less_fresnel = REAL(1.0);
  line.retro = REAL(0.0);
  line.less_retro = REAL(1.0);
  line.terminator = REAL(0.0);
  line.d_1 = ggx_d(shape.alpha_1, sin_h_squared, g.cos_h);
  line.d_2 = REAL(0.0);
  if ((effects & BRDF_EFFECT_DUAL_SPECULAR) != 0) {
    line.d_2 = ggx_d(shape.alpha_2, sin_h_squared, g.cos_h);
  }
  if ((effects & BRDF_EFFECT_SPECULAR_FRESNEL_FALLOFF) != 0) {
    line.falloff = callisto_specular_falloff(shape.specular_falloff, g.one_minus_cos_d, logs.one_minus_cos_d);
  } else {
    line.falloff = TO_REAL(schlick_falloff(g));
  }
  if ((effects & BRDF_EFFECT_DIFFUSE_FRESNEL) != 0) {
    line.fresnel = power_product(g.one_minus_cos_d, logs.one_minus_cos_d, shape.fresnel_exponent, g.cos_h,
                                 logs.cos_h, shape.fresnel_tangent_exponent);
    line.less_fresnel = one_minus_power_product(line.fresnel, logs.one_minus_cos_d, shape.fresnel_exponent,
                                                logs.cos_h, shape.fresnel_tangent_exponent);
  }
  if ((effects & BRDF_EFFECT_RETROREFLECTION) != 0) {
    line.retro = power_product(g.one_minus_cos_h, logs.one_minus_cos_h, shape.retro_exponent, g.cos_d,
                               logs.cos_d, shape.retro_tangent_exponent);
    line.less_retro = one_minus_power_product(line.retro, logs.one_minus_cos_h, shape.retro_exponent,
                                              logs.cos_d, shape.retro_tangent_exponent);
  }
  if ((effects & BRDF_EFFECT_SMOOTH_TERMINATOR) != 0) line.terminator = TO_REAL(callisto_terminator_mask(g));
  return line;
}

// The blended D V of the lobes: the same for (wi, wo) and (wo, wi).
BRDF_FUNCTION
Real callisto_lobes(OF_REAL(CallistoShape) shape, OF_REAL(CallistoLine) line, OF_GEO(Geometry) g, int masking,
                    int effects) {
  Real lobe = line.d_1 * ggx_v(shape.alpha_1, g.cos_i, g.cos_o, masking);
  if ((effects & BRDF_EFFECT_DUAL_SPECULAR) != 0) {
    lobe = lerp_real(lobe, line.d_2 * ggx_v(shape.alpha_2, g.cos_i, g.cos_o, masking), shape.opacity);
  }
  return lobe;
}

BRDF_FUNCTION
OF_REAL(CallistoTerms)
callisto_terms_of_line(OF_REAL(CallistoShape) shape, OF_REAL(CallistoLine) line, Real lobes,
                       OF_GEO(Geometry) g, int diffuse, int effects) {
  OF_REAL(CallistoTerms) terms;
  terms.diffuse = diffuse_base_cos(shape.alpha_1, g, diffuse);
  terms.fresnel = line.fresnel;
  terms.less_fresnel = line.less_fresnel;
  terms.retro = line.retro;
  terms.less_retro = line.less_retro;
  terms.falloff = line.falloff;
  terms.specular = lobes * g.cos_i;
  terms.terminator = line.terminator;
  terms.terminator_step = REAL(1.0);
  if ((effects & BRDF_EFFECT_SMOOTH_TERMINATOR) != 0) {
    terms.terminator_step = smoothstep_from_zero(line.terminator * shape.terminator_length, g.cos_i);
  }
  return terms;
}

BRDF_FUNCTION
OF_REAL(CallistoTerms)
callisto_terms(OF_REAL(CallistoShape) shape, OF_GEO(Geometry) g, OF_GEO(GeometryLogs) logs, int masking,
               int diffuse, int effects) {
  OF_REAL(CallistoLine) line = callisto_line(shape, g, logs, effects);
  Real lobes = callisto_lobes(shape, line, g, masking, effects);
  return callisto_terms_of_line(shape, line, lobes, g, diffuse, effects);
}

BRDF_REAL_FUNCTION
Real callisto_combine(OF_REAL(CallistoColour) colour, OF_REAL(CallistoTerms) terms) {
  Real c1 =
      (terms.less_fresnel + colour.fresnel * terms.fresnel) * (terms.less_retro + colour.retro * terms.retro);
  Real c2 = REAL(1.0) + (terms.terminator_step - REAL(1.0)) * (terms.terminator * colour.terminator);
  return (c1 * colour.rho * terms.diffuse + fresnel(colour.f0, terms.falloff) * terms.specular) * c2;
}

BRDF_NAMESPACE_END

#endif  // BRDFIT_BRDF_KERNEL_CALLISTO_H_
