// Checks of lights and of a sample's values, each with its sentence.
#include "bake/capture_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "bake/gains.h"
#include "bake/luminance.h"

namespace brdfit::bake {
namespace {

constexpr double kHorizonSine = 0.0523;  // of 3 degrees
constexpr double kManyValues = 0.01;
constexpr float kFarAboveOne = 100.0F;
constexpr double kUnevenGain = 0.1;
// Texels that gains are estimated from: more tell no more about whether to warn.
constexpr std::size_t kGainTexels = 512;

struct Values {
  std::size_t unusable = 0;
  std::size_t far_above_one = 0;
  float largest = 0.0F;
  std::size_t black_texels = 0;
};

Values count_values(const TexelBlock& sample) {
  const std::size_t texels = sample.count();
  Values found;
  std::vector<char> is_black(texels, 1);
  std::vector<char> is_seen(texels, 0);
  for (std::size_t light = 0; light < sample.lights; ++light) {
    for (std::size_t k = 0; k < texels; ++k) {
      if (!(sample.weight_of(light, k) > 0.0F)) {
        ++found.unusable;
        continue;
      }
      is_seen[k] = 1;
      float value = 0.0F;
      for (std::size_t c = 0; c < sample.channels; ++c) value = std::max(value, sample.plane(light, c)[k]);
      found.largest = std::max(found.largest, value);
      if (value > kFarAboveOne) ++found.far_above_one;
      if (value > 0.0F) is_black[k] = 0;
    }
  }
  // A texel whose values all have no weight (masked) is not black but unknown.
  for (std::size_t k = 0; k < texels; ++k) found.black_texels += is_black[k] != 0 && is_seen[k] != 0 ? 1 : 0;
  return found;
}

std::size_t uneven_lights(const StackInfo& info, const TexelBlock& sample) {
  const GainEstimate estimate = estimate_gains(info, thinned(sample, kGainTexels), all_lights(info));
  return static_cast<std::size_t>(std::count_if(estimate.gain.begin(), estimate.gain.end(), [](double gain) {
    return std::abs(gain - 1.0) >= kUnevenGain;
  }));
}

}  // namespace

std::vector<SolveWarning> capture_warnings(const StackInfo& info, const TexelBlock& sample,
                                           bool gains_known) {
  std::vector<SolveWarning> warnings;
  const auto warn = [&](const char* name, std::string message) {
    warnings.push_back({name, std::move(message)});
  };
  const auto low = std::count_if(info.lights.begin(), info.lights.end(),
                                 [](const StackLight& light) { return light.direction.z < kHorizonSine; });
  if (low > 0) {
    warn("lights-on-the-horizon",
         fmt::format("{} of {} lights lie within 3 degrees of the picture's plane, where little light is "
                     "left and noise is not",
                     low, info.lights.size()));
  }
  const Values values = count_values(sample);
  const std::size_t all = sample.lights * sample.count();
  if (all > 0 && static_cast<double>(values.unusable) >= kManyValues * static_cast<double>(all)) {
    warn("unusable-values",
         fmt::format("{:.1f}% of the values are not finite, saturated or masked",
                     100.0 * static_cast<double>(values.unusable) / static_cast<double>(all)));
  }
  if (values.far_above_one > 0) {
    warn("values-far-above-one",
         fmt::format("{} of {} values exceed 100 times what a white surface shows (the largest is {:.3g}): "
                     "are exposure and intensities right?",
                     values.far_above_one, all, values.largest));
  }
  if (values.black_texels > 0) {
    warn("black-texels", fmt::format("{} of {} texels are black under every light: they get no lobes",
                                     values.black_texels, sample.count()));
  }
  if (!gains_known) {
    if (const std::size_t uneven = uneven_lights(info, sample); uneven > 0) {
      warn("uneven-gains", fmt::format("{} of {} lights look at least 10% brighter or dimmer than the stack "
                                       "says: see --gains",
                                       uneven, info.lights.size()));
    }
  }
  return warnings;
}

}  // namespace brdfit::bake
