// Starting points and stages.
#include "fit/starts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string_view>

namespace brdfit::fit {
namespace {

// The albedo of a Lambert surface as bright as the samples away from highlight and grazing angles: the median
// over 40 deg < theta_h < 70 deg, theta_d < 50 deg, or over all samples where there are none.
Rgb diffuse_albedo(const SampleSet& samples) {
  Rgb albedo;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto f = samples.f(static_cast<int>(c));
    std::vector<double> region;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const double h = samples.cos_h()[k];
      if (h < 0.77 && h > 0.34 && samples.cos_d()[k] > 0.64) region.push_back(f[k]);
    }
    if (region.empty()) region.assign(f.begin(), f.begin() + static_cast<std::ptrdiff_t>(samples.size()));
    const auto middle = region.begin() + static_cast<std::ptrdiff_t>(region.size() / 2);
    std::ranges::nth_element(region, middle);
    albedo[c] = std::clamp(std::numbers::pi * *middle, 0.01, 0.95);
  }
  return albedo;
}

// Additive low-discrepancy sequence of Roberts (2018) in any dimension: the fractional parts of k g^-(d+1)
// with g the generalised golden ratio of the dimension.
class LowDiscrepancy {
 public:
  LowDiscrepancy(std::size_t dimensions, std::uint64_t seed) {
    double g = 1.5;
    for (int i = 0; i < 64; ++i) g = std::pow(1.0 + g, 1.0 / (static_cast<double>(dimensions) + 1.0));
    std::mt19937_64 random(seed);
    for (std::size_t d = 0; d < dimensions; ++d) {
      step_.push_back(std::fmod(std::pow(1.0 / g, static_cast<double>(d) + 1.0), 1.0));
      offset_.push_back(static_cast<double>(random() >> 11) * 0x1.0p-53);
    }
  }

  // In [0, 1).
  double at(std::size_t point, std::size_t dimension) const {
    return std::fmod(offset_[dimension] + static_cast<double>(point) * step_[dimension], 1.0);
  }

 private:
  std::vector<double> step_;
  std::vector<double> offset_;
};

double between(double lower, double upper, double share) {
  return lower + (upper - lower) * share;
}

double start_value(const FreeParameter& parameter, const Rgb& albedo, std::size_t channel, std::size_t start,
                   int count, double share) {
  const std::string_view name = parameter.parameter;
  const bool metal = start % 3 == 2;
  if (name == "base_color") {
    // Of a metal the base colour is its reflectance, not its dark body.
    const double brightest = *std::ranges::max_element(albedo);
    return metal ? std::max(albedo[channel], 0.5 * albedo[channel] / brightest) : albedo[channel];
  }
  if (name == "roughness") {
    // Narrow to wide, the middle of the range first.
    const double position = std::fmod(0.62 + static_cast<double>(start) * std::numbers::phi, 1.0);
    return std::exp(between(std::log(0.03), std::log(0.9), count > 1 ? position : 0.62));
  }
  if (name == "metallic") return metal ? between(0.6, 0.95, share) : between(0.02, 0.2, share);
  if (name == "smooth_terminator") return (start % 2 == 0 ? 1.0 : -1.0) * between(0.1, 0.5, share);
  if (name == "specular_fresnel_falloff")
    return start % 2 == 0 ? between(0.1, 0.4, share) : between(0.55, 0.8, share);
  if (name == "dual_specular_roughness_scale") return between(1.5, 6.0, share);
  if (name == "clearcoat") return between(0.1, 1.0, share);
  // Intensities that are neutral at 1: on both sides of it.
  if (parameter.relative)
    return start % 3 == 1 ? between(0.1, 0.7, share) : std::exp(between(0.4, 2.5, share));
  return between(parameter.lower, parameter.upper, between(0.15, 0.85, share));
}

std::size_t stage_of(std::string_view parameter) {
  if (parameter.starts_with("dual_specular")) return 1;
  if (parameter.starts_with("retroreflection")) return 2;
  if (parameter.starts_with("smooth_terminator")) return 3;
  constexpr std::array<std::string_view, 4> kFirst = {"base_color", "metallic", "specular", "roughness"};
  return std::ranges::find(kFirst, parameter) != kFirst.end() ? 0 : 4;
}

}  // namespace

std::vector<std::vector<double>> make_starts(const Parametrisation& parametrisation, const SampleSet& samples,
                                             int count, std::uint64_t seed) {
  const Rgb albedo = diffuse_albedo(samples);
  const LowDiscrepancy sequence(std::max<std::size_t>(parametrisation.size(), 1), seed);
  std::vector<std::vector<double>> starts;
  for (std::size_t start = 0; start < static_cast<std::size_t>(count); ++start) {
    std::vector<double> x;
    std::size_t channel = 0;
    for (std::size_t k = 0; k < parametrisation.size(); ++k) {
      const FreeParameter& parameter = parametrisation.free[k];
      channel = k > 0 && parametrisation.free[k - 1].parameter == parameter.parameter ? channel + 1 : 0;
      // Channels of a product begin alike: their shares come from the first one's.
      const double share = sequence.at(start, k - channel);
      const double value = start_value(parameter, albedo, channel, start, count, share);
      x.push_back(std::clamp(value, parameter.lower, parameter.upper));
    }
    starts.push_back(std::move(x));
  }
  return starts;
}

std::vector<std::vector<std::size_t>> staging(const Parametrisation& parametrisation) {
  std::vector<std::vector<std::size_t>> stages(5);
  for (std::size_t k = 0; k < parametrisation.size(); ++k) {
    stages[stage_of(parametrisation.free[k].parameter)].push_back(k);
  }
  std::erase_if(stages, [](const auto& stage) { return stage.empty(); });
  return stages;
}

}  // namespace brdfit::fit
