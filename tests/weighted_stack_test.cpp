// A stack with weights: the same for a texel however it is read, and the other stack's without any.
#include "bake/weighted_stack.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "bake/weights.h"

namespace brdfit::bake {
namespace {

constexpr int kWidth = 5;
constexpr int kHeight = 4;

MemoryStack some_stack() {
  StackInfo info;
  info.width = kWidth;
  info.height = kHeight;
  info.lights.resize(3);
  for (StackLight& light : info.lights) light.direction = {0.0, 0.0, 1.0};
  TexelBlock block;
  block.lights = 3;
  block.texels.resize(info.texel_count());
  std::iota(block.texels.begin(), block.texels.end(), 0U);
  block.rgb.resize(3 * 3 * block.count());
  for (std::size_t k = 0; k < block.rgb.size(); ++k) block.rgb[k] = 0.01F * static_cast<float>(k % 83);
  block.weight.assign(3 * block.count(), 1.0F);
  block.weight[7] = 0.0F;
  return MemoryStack(info, block);
}

// Weights that depend on a value, as those of noise do, and on its place, as those of maps do.
void add_both(WeightedStack& stack) {
  stack.add({[](TexelBlock& block) { weigh_by_noise(block, {.read_deviation = 0.1, .shot = 0.1}); }, true});
  stack.add({[](TexelBlock& block) {
               for (std::size_t light = 0; light < block.lights; ++light) {
                 for (std::size_t k = 0; k < block.count(); ++k) {
                   const auto place = static_cast<float>(light + block.texels[k]);
                   block.weight[light * block.count() + k] *= 1.0F / (1.0F + place);
                 }
               }
             },
             false});
}

TEST(WeightedStack, WithoutWeightsIsTheOtherStack) {
  MemoryStack inner = some_stack();
  WeightedStack stack(inner);
  EXPECT_EQ(stack.read_rows(1, 2).weight, inner.read_rows(1, 2).weight);
  EXPECT_EQ(stack.read_rows(1, 2).rgb, inner.read_rows(1, 2).rgb);
  EXPECT_EQ(stack.read_luminance(0, 4).rgb, inner.read_luminance(0, 4).rgb);
}

TEST(WeightedStack, ATexelWeighsTheSameInStripsSamplesAndLuminance) {
  MemoryStack inner = some_stack();
  WeightedStack stack(inner);
  add_both(stack);
  const TexelBlock all = stack.read_rows(0, kHeight);
  const TexelBlock luminance = stack.read_luminance(0, kHeight);
  EXPECT_EQ(luminance.channels, 1U);
  EXPECT_EQ(luminance.weight, all.weight);
  const TexelBlock strip = stack.read_rows(2, 1);
  const TexelBlock sample = stack.read_texels(std::vector<std::uint32_t>{3, 11, 14});
  for (std::size_t light = 0; light < 3; ++light) {
    for (const TexelBlock* block : {&strip, &sample}) {
      for (std::size_t k = 0; k < block->count(); ++k) {
        EXPECT_EQ(block->weight_of(light, k), all.weight_of(light, block->texels[k]));
      }
    }
  }
  EXPECT_EQ(all.weight_of(0, 7), 0.0F) << "what cannot be used stays so";
  EXPECT_LT(all.weight_of(0, 9), 0.1F);
}

}  // namespace
}  // namespace brdfit::bake
