// f cos_i of a material, one pair of directions per invocation: the body of material.comp.
//
// Model, effects and options are specialisation constants: what is off is not in the pipeline. Parameters
// are push constants in the order of brdf/material.cpp's tables.

#include "brdf/kernel/burley.h"
#include "brdf/kernel/callisto.h"
#include "brdf/kernel/lambert_ggx.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const int kModel = 0;  // as brdfit::Model
layout(constant_id = 2) const int kEffects = 0;
layout(constant_id = 3) const int kMasking = 0;
layout(constant_id = 4) const int kBurleyG = 0;
layout(constant_id = 5) const int kDiffuse = 0;

const int kLambertGgx = 0;
const int kBurley = 1;

// wi, wo
struct Pair {
  float wi_x;
  float wi_y;
  float wi_z;
  float wo_x;
  float wo_y;
  float wo_z;
};

layout(push_constant, std430) uniform Parameters {
  uint pair_count;
  float values[26];
} material;
layout(std430, set = 0, binding = 0) readonly buffer Pairs { Pair pairs[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Results { float results[]; };

// Shared by all models.
float base_color(int channel) {
  return material.values[channel];
}
const int kMetallic = 3;
const int kSpecular = 4;
const int kRoughness = 5;
// Burley
const int kSubsurface = 6;
const int kSpecularTint = 7;
const int kAnisotropic = 8;
const int kSheen = 9;
const int kSheenTint = 10;
const int kClearcoat = 11;
const int kClearcoatGloss = 12;
// Callisto
const int kDiffuseFresnel = 6;
const int kDiffuseFresnelFalloff = 7;
const int kDiffuseFresnelTint = 8;
const int kDiffuseFresnelTangentFalloff = 11;
const int kRetroreflection = 12;
const int kRetroreflectionFalloff = 13;
const int kRetroreflectionTint = 14;
const int kRetroreflectionTangentFalloff = 17;
const int kSmoothTerminator = 18;
const int kSmoothTerminatorTint = 19;
const int kSmoothTerminatorLength = 22;
const int kSpecularFresnelFalloff = 23;
const int kDualSpecularRoughnessScale = 24;
const int kDualSpecularOpacity = 25;

// A parameter where its effect is on, what it counts as where it is off.
float value_if(int effect, int parameter, float otherwise) {
  return (kEffects & effect) != 0 ? material.values[parameter] : otherwise;
}

vec3 eval_lambert_ggx(Geometry g) {
  LambertGgxShape shape = lambert_ggx_shape(material.values[kRoughness]);
  LambertGgxTerms terms = lambert_ggx_terms(shape, g, kMasking, kDiffuse);
  vec3 f;
  for (int c = 0; c < 3; ++c) {
    f[c] = lambert_ggx_combine(
        lambert_ggx_colour(base_color(c), material.values[kMetallic], material.values[kSpecular]), terms);
  }
  return f;
}

vec3 eval_burley(Geometry g) {
  BurleyShape shape = burley_shape(material.values[kRoughness], material.values[kSubsurface],
                                   material.values[kAnisotropic], material.values[kClearcoatGloss], kEffects);
  BurleyTerms terms = burley_terms(shape, g, kBurleyG, kEffects);
  float luminance = base_color(0) * 0.3 + base_color(1) * 0.6 + base_color(2) * 0.1;
  float specular_tint = value_if(BRDF_EFFECT_SPECULAR_TINT, kSpecularTint, 0.0);
  float sheen = value_if(BRDF_EFFECT_SHEEN, kSheen, 0.0);
  vec3 f;
  for (int c = 0; c < 3; ++c) {
    f[c] = burley_combine(
        burley_colour(base_color(c), luminance, material.values[kMetallic], material.values[kSpecular],
                      specular_tint, sheen, material.values[kSheenTint], material.values[kClearcoat]),
        terms);
  }
  return f;
}

CallistoShape callisto_shape_of_material() {
  return callisto_shape(material.values[kRoughness], material.values[kDualSpecularRoughnessScale],
                        material.values[kDualSpecularOpacity], material.values[kDiffuseFresnelFalloff],
                        material.values[kDiffuseFresnelTangentFalloff], material.values[kRetroreflectionFalloff],
                        material.values[kRetroreflectionTangentFalloff], material.values[kSpecularFresnelFalloff],
                        material.values[kSmoothTerminatorLength]);
}

// An intensity times its tint.
float tinted(int intensity, int tint, int channel) {
  return material.values[intensity] * material.values[tint + channel];
}

vec3 eval_callisto(Geometry g) {
  CallistoTerms terms =
      callisto_terms(callisto_shape_of_material(), g, geometry_logs(g), kMasking, kDiffuse, kEffects);
  vec3 f;
  for (int c = 0; c < 3; ++c) {
    f[c] = callisto_combine(
        callisto_colour(base_color(c), material.values[kMetallic], material.values[kSpecular],
                        tinted(kDiffuseFresnel, kDiffuseFresnelTint, c),
                        tinted(kRetroreflection, kRetroreflectionTint, c),
                        tinted(kSmoothTerminator, kSmoothTerminatorTint, c)),
        terms);
  }
  return f;
}

vec3 eval_material(Geometry g) {
  if (kModel == kLambertGgx) return eval_lambert_ggx(g);
  if (kModel == kBurley) return eval_burley(g);
  return eval_callisto(g);
}

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= material.pair_count) return;
  Pair p = pairs[k];
  Geometry g = geometry_from_directions(p.wi_x, p.wi_y, p.wi_z, p.wo_x, p.wo_y, p.wo_z);
  vec3 f = eval_material(g);
  for (int c = 0; c < 3; ++c) results[3 * k + c] = above_horizon(f[c], g.cos_i, g.cos_o);
}
