// Callisto on a Vulkan device, one colour channel of one pair of directions per invocation.
#ifndef BRDFIT_GPU_CALLISTO_PAIRS_H_
#define BRDFIT_GPU_CALLISTO_PAIRS_H_

#include <span>
#include <vector>

#include "gpu/compute.h"

namespace brdfit {

// Directions (unit, local frame, z = normal, pointing away from the surface) and the parameters of one
// channel, by their public names, ranges and defaults (brdf/material.h). An intensity is already multiplied
// by its tint. The layout is that of `Pair` in gpu/shaders/callisto_pairs.comp.
struct CallistoPair {
  float wi_x = 0.0F;
  float wi_y = 0.0F;
  float wi_z = 1.0F;
  float wo_x = 0.0F;
  float wo_y = 0.0F;
  float wo_z = 1.0F;
  float roughness = 0.5F;
  float dual_specular_roughness_scale = 2.0F;
  float dual_specular_opacity = 0.0F;
  float diffuse_fresnel_falloff = 0.75F;
  float diffuse_fresnel_tangent_falloff = 0.75F;
  float retroreflection_falloff = 0.75F;
  float retroreflection_tangent_falloff = 0.75F;
  float specular_fresnel_falloff = 0.5F;
  float smooth_terminator_length = 0.5F;
  float base_color = 0.18F;
  float metallic = 0.0F;
  float specular = 0.5F;
  float diffuse_fresnel = 1.0F;
  float retroreflection = 1.0F;
  float smooth_terminator = 0.0F;
};

// f cos_i in sr^-1 of each pair, all effects on, separable masking, Lambert diffuse; 0 where a direction is
// not above the horizon. Throws as ComputeDevice::run.
std::vector<float> callisto_pairs(ComputeDevice& device, std::span<const CallistoPair> pairs);

}  // namespace brdfit

#endif  // BRDFIT_GPU_CALLISTO_PAIRS_H_
