// The least-squares problem of a block of texels: what the lobes are to bring back, and how much of it they
// can under each light.
#ifndef BRDFIT_BAKE_TEXEL_PROBLEM_H_
#define BRDFIT_BAKE_TEXEL_PROBLEM_H_

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "measured/image_stack.h"

namespace brdfit::bake {

// One number per texel and light: residual = modulation x sum over lobes of amplitude x lobe. All planes are
// [light][texel], finite.
struct TexelProblem {
  std::size_t lights = 0;
  std::size_t texels = 0;
  std::vector<float> residual;    // reference - render
  std::vector<float> modulation;  // >= 0
  std::vector<float> weight;      // in [0, 1]; empty: all 1
  // [light][3][texel], unit, towards the light: where lights are near. Empty: the same for all texels.
  std::vector<float> directions;

  std::size_t at(std::size_t light, std::size_t texel) const { return light * texels + texel; }
  float weight_of(std::size_t light, std::size_t texel) const {
    return weight.empty() ? 1.0F : weight[at(light, texel)];
  }
  // Direction of a light at a texel; `common` is that of directional lights.
  Vec3 direction(std::size_t light, std::size_t texel, const Vec3& common) const;
};

// A model's pictures of a block, which Realis corrects.
struct BlockRender {
  std::vector<float> rgb;     // [light][channel][texel], as TexelBlock::rgb
  std::vector<float> shade;   // [light][texel]: falloff x max(n . l, 0)
  std::vector<float> albedo;  // [channel][texel], to be part of the modulation; empty: it is not
};

// The problem of Rec.709 luminance. Values that are not finite get weight 0. Directions are filled in if the
// stack has near lights. Throws std::invalid_argument where sizes disagree, as do those below.
TexelProblem luminance_problem(const StackInfo& info, const TexelBlock& block, const BlockRender& render);
// One problem per channel.
std::array<TexelProblem, 3> rgb_problems(const StackInfo& info, const TexelBlock& block,
                                         const BlockRender& render);

// Scaled chroma: the factors [channel][texel] that turn what lobes bring back of luminance (`sums`:
// [light][texel], the sum over lobes without modulation) into each channel's share, by weighted least
// squares. 1 where the lobes bring nothing back.
std::vector<float> chroma_scales(std::span<const TexelProblem, 3> channels, std::span<const float> sums);

// The problem under some of its lights, in that order.
TexelProblem with_lights(const TexelProblem& problem, std::span<const std::size_t> lights);
// The problem of some of its texels.
TexelProblem with_texels(const TexelProblem& problem, std::span<const std::size_t> texels);

// Per light, the mean over texels of weight x modulation^2.
std::vector<double> mean_squared_modulation(const TexelProblem& problem);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_TEXEL_PROBLEM_H_
