// What Realis leaves of a base model's error in each colour channel, relit as at run time.
#ifndef BRDFIT_BAKE_CHANNEL_ERRORS_H_
#define BRDFIT_BAKE_CHANNEL_ERRORS_H_

#include <array>
#include <span>
#include <vector>

#include "bake/solve.h"
#include "bake/texel_problem.h"
#include "brdf/realis.h"

namespace brdfit::bake {

// Of red, green and blue, [light][texel].
using ChannelPlanes = std::array<std::vector<float>, 3>;

// channels: of the lights to predict (rgb_problems); directions: theirs. amplitudes: one set for all channels
// or one for each, [lobe][texel]; none: nothing is corrected. chroma: the factors [channel][texel] on sums of
// scaled chroma; empty: none. Throws std::invalid_argument where sizes disagree.
ChannelPlanes channel_errors(std::span<const TexelProblem, 3> channels, const LobeSet& lobes,
                             std::span<const Vec3> directions, std::span<const std::vector<float>> amplitudes,
                             std::span<const float> chroma = {});

// Rec.709 luminance of the errors, [light][texel].
std::vector<float> luminance_of(const ChannelPlanes& errors);

// Scaled chroma of a block that is solved for luminance: chroma_scales of the lights that it was solved from.
std::vector<float> chroma_of(const LobeSystem& system, std::span<const TexelProblem, 3> channels,
                             std::span<const float> amplitudes);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_CHANNEL_ERRORS_H_
