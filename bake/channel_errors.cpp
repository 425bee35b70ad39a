// Sums over lobes, modulated channel by channel.
#include "bake/channel_errors.h"

#include <stdexcept>

#include "bake/luminance.h"

namespace brdfit::bake {

ChannelPlanes channel_errors(std::span<const TexelProblem, 3> channels, const LobeSet& lobes,
                             std::span<const Vec3> directions, std::span<const std::vector<float>> amplitudes,
                             std::span<const float> chroma) {
  const std::size_t texels = channels[0].texels;
  if ((amplitudes.size() > 1 && amplitudes.size() != 3) || directions.size() != channels[0].lights ||
      (!chroma.empty() && chroma.size() != 3 * texels)) {
    throw std::invalid_argument("channel_errors: sizes disagree");
  }
  std::vector<std::vector<float>> sums;
  for (const std::vector<float>& planes : amplitudes) {
    sums.push_back(lobe_sums(lobes, directions, channels[0].directions, planes, texels));
  }
  ChannelPlanes errors;
  for (std::size_t c = 0; c < 3; ++c) {
    const TexelProblem& channel = channels[c];
    errors[c] = channel.residual;
    if (sums.empty()) continue;
    const std::vector<float>& sum = sums[sums.size() == 3 ? c : 0];
    for (std::size_t at = 0; at < errors[c].size(); ++at) {
      const float scale = chroma.empty() ? 1.0F : chroma[c * texels + at % texels];
      errors[c][at] -= channel.modulation[at] * scale * sum[at];
    }
  }
  return errors;
}

std::vector<float> luminance_of(const ChannelPlanes& errors) {
  std::vector<float> luminance(errors[0].size());
  for (std::size_t at = 0; at < luminance.size(); ++at) {
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) sum += kLuminance[c] * static_cast<double>(errors[c][at]);
    luminance[at] = static_cast<float>(sum);
  }
  return luminance;
}

std::vector<float> chroma_of(const LobeSystem& system, std::span<const TexelProblem, 3> channels,
                             std::span<const float> amplitudes) {
  return chroma_scales(channels, lobe_sums(system.lobes(), system.directions(), channels[0].directions,
                                           amplitudes, channels[0].texels));
}

}  // namespace brdfit::bake
