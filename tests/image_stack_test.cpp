// Stacks: where light comes from at a texel, and that choosing texels or rows gives the same values.
#include "measured/image_stack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace brdfit {
namespace {

StackInfo small_stack() {
  StackInfo info;
  info.width = 3;
  info.height = 2;
  info.lights = {{"a", {0.0, 0.0, 1.0}, {}, {1.0, 1.0, 1.0}}, {"b", {0.6, 0.0, 0.8}, {}, {2.0, 2.0, 2.0}}};
  return info;
}

TexelBlock numbered_block(const StackInfo& info) {
  TexelBlock block;
  block.lights = info.lights.size();
  for (std::uint32_t k = 0; k < info.texel_count(); ++k) block.texels.push_back(k);
  block.rgb.resize(block.lights * 3 * block.count());
  for (std::size_t k = 0; k < block.rgb.size(); ++k) block.rgb[k] = static_cast<float>(k);
  return block;
}

TEST(ImageStack, DirectionalLightsAreTheSameEverywhere) {
  const StackInfo info = small_stack();
  EXPECT_FALSE(has_near_lights(info));
  for (std::uint32_t texel = 0; texel < 6; ++texel) {
    EXPECT_EQ(incidence(info, 1, texel).direction.x, 0.6);
    EXPECT_EQ(incidence(info, 1, texel).falloff, 1.0);
  }
}

TEST(ImageStack, NearLightsFallOffWithTheSquareOfTheDistance) {
  StackInfo info = small_stack();
  info.plane = {{-1.0, 0.5, 0.0}, 1.0};
  info.lights[0].position = Vec3{-1.0, 0.5, 2.0};  // above the upper left pixel
  EXPECT_TRUE(has_near_lights(info));
  const Incidence above = incidence(info, 0, 0);
  EXPECT_DOUBLE_EQ(above.direction.z, 1.0);
  const Incidence aside = incidence(info, 0, 5);  // two pixels right and one down
  EXPECT_NEAR(aside.direction.x, -2.0 / 3.0, 1e-15);
  EXPECT_NEAR(aside.direction.y, 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(aside.falloff / above.falloff, 4.0 / 9.0, 1e-15);
}

TEST(ImageStack, ANearLightHasItsIntensityAtTheCentre) {
  StackInfo info = small_stack();
  info.height = 1;
  info.plane = {{-1.0, 0.0, 0.0}, 1.0};
  info.lights[0].position = Vec3{0.3, 0.2, 0.7};
  EXPECT_DOUBLE_EQ(incidence(info, 0, 1).falloff, 1.0);
}

TEST(ImageStack, RowsAndChosenTexelsHoldTheSameValues) {
  const StackInfo info = small_stack();
  MemoryStack stack(info, numbered_block(info));
  const TexelBlock row = stack.read_rows(1, 1);
  const std::vector<std::uint32_t> chosen{3, 5};
  const TexelBlock some = stack.read_texels(chosen);
  for (std::size_t light = 0; light < 2; ++light) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      EXPECT_EQ(row.plane(light, channel)[0], static_cast<float>((light * 3 + channel) * 6 + 3));
      EXPECT_EQ(some.plane(light, channel)[0], row.plane(light, channel)[0]);
      EXPECT_EQ(some.plane(light, channel)[1], row.plane(light, channel)[2]);
    }
  }
}

TEST(ImageStack, RefusesWhatDoesNotFit) {
  const StackInfo info = small_stack();
  TexelBlock block = numbered_block(info);
  block.rgb.pop_back();
  EXPECT_THROW(MemoryStack(info, block), std::invalid_argument);
  MemoryStack stack(info, numbered_block(info));
  EXPECT_THROW(stack.read_rows(1, 2), std::invalid_argument);
  EXPECT_THROW(stack.read_texels(std::vector<std::uint32_t>{6}), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit
