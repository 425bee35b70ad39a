// Callisto f cos_i of one colour channel of one pair of directions per invocation, all effects on.
#version 450
#extension GL_GOOGLE_include_directive : require

#include "brdf/kernel/callisto.h"

layout(local_size_x_id = 0) in;

// The layout of CallistoPair in gpu/callisto_pairs.h.
struct Pair {
  float wi_x;
  float wi_y;
  float wi_z;
  float wo_x;
  float wo_y;
  float wo_z;
  float roughness;
  float dual_specular_roughness_scale;
  float dual_specular_opacity;
  float diffuse_fresnel_falloff;
  float diffuse_fresnel_tangent_falloff;
  float retroreflection_falloff;
  float retroreflection_tangent_falloff;
  float specular_fresnel_falloff;
  float smooth_terminator_length;
  float base_color;
  float metallic;
  float specular;
  float diffuse_fresnel;
  float retroreflection;
  float smooth_terminator;
};

layout(std430, set = 0, binding = 0) readonly buffer Pairs { Pair pairs[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Results { float results[]; };

const int kAllEffects = BRDF_EFFECT_SPECULAR_FRESNEL_FALLOFF | BRDF_EFFECT_DIFFUSE_FRESNEL |
                        BRDF_EFFECT_RETROREFLECTION | BRDF_EFFECT_SMOOTH_TERMINATOR | BRDF_EFFECT_DUAL_SPECULAR;

CallistoShape shape_of(Pair p) {
  return callisto_shape(p.roughness, p.dual_specular_roughness_scale, p.dual_specular_opacity,
                        p.diffuse_fresnel_falloff, p.diffuse_fresnel_tangent_falloff, p.retroreflection_falloff,
                        p.retroreflection_tangent_falloff, p.specular_fresnel_falloff, p.smooth_terminator_length);
}

CallistoColour colour_of(Pair p) {
  return callisto_colour(p.base_color, p.metallic, p.specular, p.diffuse_fresnel, p.retroreflection,
                         p.smooth_terminator);
}

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= results.length()) {
    return;
  }
  Pair p = pairs[k];
  Geometry g = geometry_from_directions(p.wi_x, p.wi_y, p.wi_z, p.wo_x, p.wo_y, p.wo_z);
  CallistoTerms terms = callisto_terms(shape_of(p), g, geometry_logs(g), BRDF_MASKING_SEPARABLE,
                                       BRDF_DIFFUSE_LAMBERT, kAllEffects);
  results[k] = above_horizon(callisto_combine(colour_of(p), terms), g.cos_i, g.cos_o);
}
