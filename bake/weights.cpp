// Weights from noise and saturation.
#include "bake/weights.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brdfit::bake {
namespace {

double saturation_weight(const SensorNoise& noise, double value) {
  if (!std::isfinite(noise.saturation)) return 1.0;
  const double start = noise.knee * noise.saturation;
  if (value <= start) return 1.0;
  if (value >= noise.saturation) return 0.0;
  const double t = (noise.saturation - value) / (noise.saturation - start);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

bool SensorNoise::is_valid(std::string* why) const {
  const auto fails = [why](const char* reason) {
    if (why != nullptr) *why = reason;
    return false;
  };
  if (!(read_deviation >= 0.0 && std::isfinite(read_deviation))) {
    return fails("read_deviation must not be negative");
  }
  if (!(shot >= 0.0 && std::isfinite(shot))) return fails("shot must not be negative");
  if (!(saturation > 0.0)) return fails("saturation must be positive");
  if (!(knee > 0.0 && knee <= 1.0)) return fails("knee must lie in (0, 1]");
  return true;
}

double noise_weight(const SensorNoise& noise, double value) {
  const double full = std::isfinite(noise.saturation) ? noise.saturation : 1.0;
  const double seen = std::max(value, 0.0);
  const double read = noise.read_deviation * noise.read_deviation;
  const double floor = read > 0.0 ? read : noise.shot * 0.01 * full;
  const double variance = read + noise.shot * seen;
  const double weight = variance > floor ? floor / variance : 1.0;
  return weight * saturation_weight(noise, value);
}

void weigh_by_noise(TexelBlock& block, const SensorNoise& noise, std::span<const double> exposure) {
  std::string why;
  if (!noise.is_valid(&why)) throw std::invalid_argument("weigh_by_noise: " + why);
  if (!exposure.empty() && exposure.size() != block.lights) {
    throw std::invalid_argument("weigh_by_noise: one exposure per light is needed");
  }
  if (block.channels != 3) throw std::invalid_argument("weigh_by_noise: the block holds no colours");
  const double longest = exposure.empty() ? 1.0 : *std::max_element(exposure.begin(), exposure.end());
  if (std::any_of(exposure.begin(), exposure.end(), [](double e) { return !(e > 0.0); })) {
    throw std::invalid_argument("weigh_by_noise: an exposure is not positive");
  }
  if (block.weight.empty()) block.weight.assign(block.lights * block.count(), 1.0F);
  for (std::size_t light = 0; light < block.lights; ++light) {
    const double scale = exposure.empty() ? 1.0 : exposure[light];
    const double share = scale * scale / (longest * longest);
    for (std::size_t t = 0; t < block.count(); ++t) {
      float& weight = block.weight[light * block.count() + t];
      if (weight <= 0.0F) continue;
      const float brightest =
          std::max({block.plane(light, 0)[t], block.plane(light, 1)[t], block.plane(light, 2)[t]});
      weight *= static_cast<float>(share * noise_weight(noise, scale * brightest));
    }
  }
}

}  // namespace brdfit::bake
