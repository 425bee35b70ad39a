// The base model of a bake: what is rendered before Realis corrects it.
#ifndef BRDFIT_BAKE_BASE_MODEL_H_
#define BRDFIT_BAKE_BASE_MODEL_H_

#include <optional>
#include <span>
#include <vector>

#include "bake/chunk.h"
#include "bake/photometric_stereo.h"
#include "brdf/material.h"
#include "measured/image_stack.h"

namespace brdfit::bake {

// Lambert, or one material that all texels share but for their base colour.
struct BaseModel {
  std::optional<Material> material;  // Lambert where absent
  // Residuals beyond this (in the values' unit) count by their absolute value when a texel's base colour is
  // solved; 0: squares throughout.
  double robust_width = 0.0;
};

// The radiance of each texel under each of the lights as the base model has it, specular included:
// [light][channel][texel], lights in the order given. The material's own base colour does not count: a
// texel's albedo stands in for it. Every value is finite; 0 where the light is below the texel's horizon.
// Parallel over texels.
std::vector<float> render_block(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                                const LightChoice& lights, const BaseModel& model);
// Into memory of the caller's, lights x 3 x texels of it.
void render_block(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                  const LightChoice& lights, const BaseModel& model, std::span<float> render);

// Albedo for Lambert, base colour for a material, of texels whose normals are known: per texel and channel in
// closed form, as render = offset + slope x base colour; >= 0, and above 1 where values ask for it. Texels
// that all lights graze get less than they ask for (kLeastSquaredCosine). With Lambert, and where the block
// has an albedo, the surface is returned as it is. Parallel over texels. Materials must be affine in their
// base colour (is_affine).
Surface with_base_colour(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                         const LightChoice& lights, const BaseModel& model);

// The same with what the render leaves of the values' luminance, which costs little beside: into `residual`,
// [light][texel], lights in the order given; it is made as large as that takes. For a material.
Surface base_colour_and_residual(const StackInfo& info, const TexelBlock& block, Surface surface,
                                 const LightChoice& lights, const BaseModel& model,
                                 std::vector<float>& residual);

// Whether the model's value is affine in its base colour: all are, but Burley's with a tint in use.
bool is_affine(const Material& material);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_BASE_MODEL_H_
