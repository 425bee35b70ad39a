// Weights of values: noise and saturation.
#include "bake/weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace brdfit::bake {
namespace {

TexelBlock ramp() {
  TexelBlock block;
  block.texels = {4, 5, 6, 7};
  block.lights = 2;
  for (std::size_t k = 0; k < 2 * 3 * 4; ++k) block.rgb.push_back(0.1F * static_cast<float>(k));
  return block;
}

TEST(NoiseWeights, AreInverseVariances) {
  const SensorNoise noise{.read_deviation = 0.02, .shot = 0.001};
  EXPECT_EQ(noise_weight(noise, 0.0), 1.0);
  for (const double v : {0.1, 0.5, 2.0}) {
    EXPECT_DOUBLE_EQ(noise_weight(noise, v), 0.0004 / (0.0004 + 0.001 * v));
  }
  EXPECT_EQ(noise_weight(noise, -1.0), 1.0);
}

TEST(NoiseWeights, FallWithBrightnessAndStayPositive) {
  for (const SensorNoise& noise :
       {SensorNoise{}, SensorNoise{.shot = 0.01}, SensorNoise{.read_deviation = 0.1, .shot = 0.1}}) {
    double last = 1.0;
    for (double v = 0.0; v < 100.0; v += 0.37) {
      const double weight = noise_weight(noise, v);
      EXPECT_LE(weight, last);
      EXPECT_GT(weight, 0.0);
      last = weight;
    }
  }
}

TEST(NoiseWeights, SaturatedValuesHaveNone) {
  const SensorNoise noise{.saturation = 1.0, .knee = 0.9};
  EXPECT_EQ(noise_weight(noise, 0.9), 1.0);
  EXPECT_NEAR(noise_weight(noise, 0.95), 0.5, 1e-12);
  EXPECT_EQ(noise_weight(noise, 1.0), 0.0);
  EXPECT_EQ(noise_weight(noise, std::numeric_limits<double>::infinity()), 0.0);
}

TEST(NoiseWeights, MultiplyIntoABlockByTheBrightestChannel) {
  TexelBlock block = ramp();
  block.weight.assign(8, 0.5F);
  block.weight[2] = 0.0F;
  const SensorNoise noise{.read_deviation = 0.1, .shot = 0.1};
  weigh_by_noise(block, noise, std::vector<double>{1.0, 2.0});
  EXPECT_FLOAT_EQ(block.weight[0], static_cast<float>(0.5 * 0.25 * noise_weight(noise, 0.8F)));
  EXPECT_EQ(block.weight[2], 0.0F);
  EXPECT_FLOAT_EQ(block.weight[4], static_cast<float>(0.5 * noise_weight(noise, 2.0 * 2.0F)));
}

TEST(NoiseWeights, AreThoseOfTheRadianceHoweverLongItWasExposed) {
  // One radiance seen by several exposures: weights are as the inverse of the radiance's variance.
  const std::vector<double> exposure = {0.01, 0.1, 1.0};
  const SensorNoise noise{.read_deviation = 0.02, .shot = 0.001};
  TexelBlock block;
  block.texels = {0};
  block.lights = 3;
  block.rgb.assign(9, 0.4F);
  weigh_by_noise(block, noise, exposure);
  const auto variance = [&](double e) { return (0.0004 + 0.001 * e * 0.4) / (e * e); };
  for (std::size_t light = 0; light < 2; ++light) {
    EXPECT_NEAR(block.weight[light] / block.weight[2], variance(1.0) / variance(exposure[light]), 1e-6);
  }
  EXPECT_LE(block.weight[2], 1.0F);
}

TEST(NoiseWeights, RefuseWhatMakesNoSense) {
  TexelBlock block = ramp();
  EXPECT_THROW(weigh_by_noise(block, {.read_deviation = -1.0}), std::invalid_argument);
  EXPECT_THROW(weigh_by_noise(block, {.knee = 0.0}), std::invalid_argument);
  EXPECT_THROW(weigh_by_noise(block, {}, std::vector<double>{1.0}), std::invalid_argument);
  EXPECT_THROW(weigh_by_noise(block, {}, std::vector<double>{1.0, 0.0}), std::invalid_argument);
  block.channels = 1;
  EXPECT_THROW(weigh_by_noise(block, {}), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::bake
