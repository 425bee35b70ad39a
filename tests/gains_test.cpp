// Gains of lights: wrong ones are found, geometry is not taken for them.
#include "bake/gains.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "bake_data.h"

namespace brdfit::bake {
namespace {

using test_data::cap_of_lights;
using test_data::lambert_sphere;
using test_data::TrueStack;

void multiply(TexelBlock& block, std::size_t light, double gain) {
  for (std::size_t c = 0; c < 3; ++c) {
    for (float& x : block.plane(light, c)) x = static_cast<float>(x * gain);
  }
}

// Gains off by up to 30% for a third of the lights; the median is 1.
std::vector<double> spoil(TrueStack& s) {
  std::vector<double> gains(s.info.lights.size(), 1.0);
  for (std::size_t k = 0; k < gains.size(); k += 3) {
    gains[k] = k % 2 == 0 ? 1.3 : 0.7;
    multiply(s.block, k, gains[k]);
  }
  return gains;
}

double largest_error(const GainEstimate& estimate, const std::vector<double>& gains) {
  double largest = 0.0;
  for (std::size_t k = 0; k < gains.size(); ++k) {
    largest = std::max(largest, std::abs(estimate.gain[k] / gains[k] - 1.0));
  }
  return largest;
}

TEST(Gains, ThirtyPercentIsRecovered) {
  TrueStack s = lambert_sphere(24, cap_of_lights(30, 60.0));
  const std::vector<double> gains = spoil(s);
  const GainEstimate estimate = estimate_gains(s.info, s.block, all_lights(s.info));
  EXPECT_LT(largest_error(estimate, gains), 1e-3);
  for (std::size_t k = 0; k < gains.size(); k += 3) {
    EXPECT_EQ(estimate.state[k], GainState::kOk);
    EXPECT_LT(estimate.standard_error[k], 0.01);
  }
}

TEST(Gains, NoiseIsTold) {
  std::mt19937 random(2);
  std::normal_distribution<float> noise(0.0F, 0.03F);
  TrueStack s = lambert_sphere(24, cap_of_lights(30, 60.0));
  const std::vector<double> gains = spoil(s);
  for (float& x : s.block.rgb) x += noise(random);
  const GainEstimate estimate = estimate_gains(s.info, s.block, all_lights(s.info));
  EXPECT_LT(largest_error(estimate, gains), 0.05);
}

TEST(Gains, CommonFactorsAreTheAlbedos) {
  TrueStack s = lambert_sphere(24, cap_of_lights(30, 60.0));
  for (std::size_t k = 0; k < s.block.lights; ++k) multiply(s.block, k, 2.0);
  const GainEstimate estimate = estimate_gains(s.info, s.block, all_lights(s.info));
  EXPECT_LT(largest_error(estimate, std::vector<double>(s.block.lights, 1.0)), 1e-3);
}

TEST(Gains, OneLightShadowedOnOneSideKeepsItsGain) {
  TrueStack s = lambert_sphere(24, cap_of_lights(30, 60.0));
  for (std::size_t t = 0; t < s.block.count(); ++t) {
    if (t % 24 < 8) {
      for (std::size_t c = 0; c < 3; ++c) s.block.plane(5, c)[t] *= 0.1F;
    }
  }
  const GainEstimate estimate = estimate_gains(s.info, s.block, all_lights(s.info));
  EXPECT_LT(largest_error(estimate, std::vector<double>(s.block.lights, 1.0)), 0.01);
}

TEST(Gains, AHighlightIsNotTakenForAGain) {
  Material glossy(Model::kLambertGgx);
  glossy.set("roughness", 0.4);
  const TrueStack s = test_data::material_sphere(24, cap_of_lights(30, 60.0), glossy);
  const GainEstimate estimate = estimate_gains(s.info, s.block, all_lights(s.info));
  EXPECT_LT(largest_error(estimate, std::vector<double>(s.block.lights, 1.0)), 0.03);
}

TEST(Gains, AFlatSampleHasNone) {
  TrueStack s = lambert_sphere(24, cap_of_lights(30, 60.0));
  const Vec3 normal = test_data::normalised({0.2, 0.1, 1.0});
  for (std::size_t k = 0; k < s.block.lights; ++k) {
    const double shown = std::max(test_data::dot(normal, s.info.lights[k].direction), 0.0) *
                         (k == 4 ? 1.5 : 1.0);  // a highlight that all texels see
    for (std::size_t c = 0; c < 3; ++c) {
      for (float& x : s.block.plane(k, c)) x = static_cast<float>(shown);
    }
  }
  const GainEstimate estimate = estimate_gains(s.info, s.block, all_lights(s.info));
  EXPECT_TRUE(estimate.is_flat);
  for (const double gain : estimate.gain) EXPECT_EQ(gain, 1.0);
}

TEST(Gains, LightsThatAreNotGivenKeepTheirIntensity) {
  TrueStack s = lambert_sphere(24, cap_of_lights(30, 60.0));
  multiply(s.block, 7, 1.3);
  const GainEstimate estimate =
      estimate_gains(s.info, s.block, without(s.info, std::vector<std::uint32_t>{7}));
  EXPECT_EQ(estimate.gain[7], 1.0);
  EXPECT_EQ(estimate.state[7], GainState::kNotSeen);
}

TEST(Gains, HardStacksStayFinite) {
  TrueStack s = lambert_sphere(16, cap_of_lights(4, 10.0));
  multiply(s.block, 0, 0.0);
  multiply(s.block, 1, 1e6);
  for (const LightChoice& lights : {LightChoice{}, LightChoice{0}, all_lights(s.info)}) {
    const GainEstimate estimate = estimate_gains(s.info, s.block, lights);
    for (const double gain : estimate.gain) EXPECT_TRUE(std::isfinite(gain) && gain > 0.0) << gain;
  }
}

TEST(Gains, MultiplyIntensities) {
  TrueStack s = lambert_sphere(4, cap_of_lights(2, 60.0));
  EXPECT_EQ(with_gains(s.info, {2.0, 1.0}).lights[0].intensity, (Rgb{2.0, 2.0, 2.0}));
  EXPECT_THROW(with_gains(s.info, {2.0}), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::bake
