// The Realis correction of a texel from its packed codes, as a renderer's shader has them.
#version 450
#extension GL_GOOGLE_include_directive : require

#include "brdf/kernel/realis.h"
#include "brdf/kernel/spherical_gaussian.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const int kLobes = 8;
layout(constant_id = 2) const int kDominant = 8;
layout(constant_id = 3) const int kBits = 8;
layout(constant_id = 4) const int kChannels = 1;        // of an amplitude: 3 for RGB
layout(constant_id = 5) const int kScaledChroma = 0;    // whether texels have factors of colour
layout(constant_id = 6) const int kAlbedoModulates = 0;

// Of gpu/realis_pass.cpp.
layout(push_constant) uniform Light {
  uint texel_count;
  float direction_x;
  float direction_y;
  float direction_z;
  float intensity_r;
  float intensity_g;
  float intensity_b;
  float albedo_range;
  float cos_normal_range;
} light;

// Per lobe: axis, sharpness, cos_cut_off; then per plane: step, zero.
layout(std430, set = 0, binding = 0) readonly buffer Lobes { float lobes[]; };
// [texture][texel], the four bytes of a texel from the lowest; then, where not all lobes are kept, the masks.
layout(std430, set = 0, binding = 1) readonly buffer Codes { uint codes[]; };
// [plane][texel]: normal and albedo now, normal and albedo as baked, factors of colour.
layout(std430, set = 0, binding = 2) readonly buffer Texels { float texels[]; };
layout(std430, set = 0, binding = 3) writeonly buffer Results { float results[]; };

const int kLobeSize = 5;
const int kSlotsPerTexture = kBits == 4 ? 8 : 4;
const int kTextures = (kDominant * kChannels + kSlotsPerTexture - 1) / kSlotsPerTexture;

float plane(int index, uint texel) {
  return texels[uint(index) * light.texel_count + texel];
}

float stored(int slot, uint texel) {
  int within = slot % kSlotsPerTexture;
  uint word = codes[uint(slot / kSlotsPerTexture) * light.texel_count + texel];
  if (kBits == 4) return float((word >> (4 * within)) & 15u);
  return float((word >> (8 * within)) & 255u);
}

float lobe_value(int lobe) {
  int at = lobe * kLobeSize;
  float one_minus_cos = one_minus_cos_between(lobes[at], lobes[at + 1], lobes[at + 2], light.direction_x,
                                              light.direction_y, light.direction_z);
  return windowed_lobe(one_minus_cos, lobes[at + 3], lobes[at + 4]);
}

vec3 lobe_sum(uint texel) {
  uint kept = kDominant < kLobes ? codes[uint(kTextures) * light.texel_count + texel] : 0xFFFFFFFFu;
  vec3 sum = vec3(0.0);
  int slot = 0;
  for (int lobe = 0; lobe < kLobes; ++lobe) {
    if ((kept >> lobe & 1u) == 0u || slot >= kDominant * kChannels) continue;
    float value = lobe_value(lobe);
    for (int channel = 0; channel < kChannels; ++channel) {
      int range = kLobes * kLobeSize + 2 * (lobe * kChannels + channel);
      sum[channel] += realis_amplitude(stored(slot, texel), lobes[range + 1], lobes[range]) * value;
      ++slot;
    }
  }
  return kChannels == 1 ? vec3(sum.x) : sum;
}

float fade(uint texel) {
  float distance_squared = 0.0;
  float cos_normals = 0.0;
  for (int c = 0; c < 3; ++c) {
    cos_normals += plane(c, texel) * plane(6 + c, texel);
    distance_squared += square(plane(3 + c, texel) - plane(9 + c, texel));
  }
  return realis_fade(sqrt(distance_squared), cos_normals, light.albedo_range, light.cos_normal_range);
}

void main() {
  uint texel = gl_GlobalInvocationID.x;
  if (texel >= light.texel_count) {
    return;
  }
  float cos_i = light.direction_x * plane(0, texel) + light.direction_y * plane(1, texel) +
                light.direction_z * plane(2, texel);
  vec3 correction = vec3(0.0);
  if (cos_i > 0.0) {
    correction = lobe_sum(texel) * (cos_i * fade(texel)) *
                 vec3(light.intensity_r, light.intensity_g, light.intensity_b);
    for (int c = 0; c < 3; ++c) {
      if (kScaledChroma != 0) correction[c] *= plane(12 + c, texel);
      if (kAlbedoModulates != 0) correction[c] *= plane(3 + c, texel);
    }
  }
  for (int c = 0; c < 3; ++c) {
    results[uint(c) * light.texel_count + texel] = correction[c];
  }
}
