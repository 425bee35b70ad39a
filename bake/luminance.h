// Small tools over blocks: choices of texels, and errors of renders in luminance.
#ifndef BRDFIT_BAKE_LUMINANCE_H_
#define BRDFIT_BAKE_LUMINANCE_H_

#include <array>
#include <span>
#include <vector>

#include "bake/chunk.h"
#include "bake/photometric_stereo.h"

namespace brdfit::bake {

inline constexpr std::array<double, 3> kLuminance = {0.2126, 0.7152, 0.0722};  // Rec.709

// Texels of a block or a surface by their place in it.
TexelBlock chosen_texels(const TexelBlock& block, std::span<const std::uint32_t> places);
Surface chosen_texels(const Surface& surface, std::span<const std::uint32_t> places);
// That many texels of a block or fewer, spread evenly.
TexelBlock thinned(const TexelBlock& block, std::size_t at_most);

// Root of the mean squared difference of luminances between a block and a render of these lights
// ([light][channel][texel]), values weighted as in the block; 0 where nothing has weight.
double luminance_rmse(const TexelBlock& block, std::span<const float> render, const LightChoice& lights);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_LUMINANCE_H_
