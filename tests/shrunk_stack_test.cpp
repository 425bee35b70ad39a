// A shrunk stack is the mean of squares of texels, whichever way it is read.
#include "bake/shrunk_stack.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace brdfit::bake {
namespace {

// Every value says where it is from; some have no weight.
MemoryStack numbered(int width, int height, bool with_weights) {
  StackInfo info;
  info.width = width;
  info.height = height;
  info.lights = {{"a", {0.0, 0.0, 1.0}, {}, {1.0, 1.0, 1.0}}, {"b", {0.6, 0.0, 0.8}, {}, {1.0, 1.0, 1.0}}};
  TexelBlock block;
  block.lights = 2;
  block.texels.resize(info.texel_count());
  std::iota(block.texels.begin(), block.texels.end(), 0U);
  for (std::size_t k = 0; k < 6 * block.count(); ++k) block.rgb.push_back(static_cast<float>((k * 7) % 31));
  for (std::size_t k = 0; with_weights && k < 2 * block.count(); ++k) {
    block.weight.push_back(k % 5 == 0 ? 0.0F : 0.5F);
  }
  return {info, block};
}

TEST(ShrunkStack, ByOneIsTheStackItself) {
  for (const bool with_weights : {false, true}) {
    MemoryStack whole = numbered(5, 4, with_weights);
    ShrunkStack same(whole, 1);
    const TexelBlock expected = whole.read_rows(1, 2);
    const TexelBlock found = same.read_rows(1, 2);
    EXPECT_EQ(found.texels, expected.texels);
    EXPECT_EQ(found.weight, expected.weight);
    for (std::size_t k = 0; k < found.rgb.size(); ++k) {
      const std::size_t light = k / (3 * found.count());
      const std::size_t texel = k % found.count();
      EXPECT_EQ(found.rgb[k], expected.weight_of(light, texel) > 0.0F ? expected.rgb[k] : 0.0F);
    }
  }
}

TEST(ShrunkStack, SquaresAreMeansByWeightAndThoseAtTheEdgeAreCut) {
  MemoryStack whole = numbered(5, 3, true);
  ShrunkStack half(whole, 2);
  EXPECT_EQ(half.info().width, 3);
  EXPECT_EQ(half.info().height, 2);
  const TexelBlock all = whole.read_rows(0, 3);
  const TexelBlock found = half.read_rows(0, 2);
  ASSERT_EQ(found.count(), 6U);
  for (std::size_t light = 0; light < 2; ++light) {
    for (std::size_t s = 0; s < 6; ++s) {
      double sum = 0.0;
      double total = 0.0;
      double texels = 0.0;
      for (std::size_t y = 2 * (s / 3); y < std::min<std::size_t>(2 * (s / 3) + 2, 3); ++y) {
        for (std::size_t x = 2 * (s % 3); x < std::min<std::size_t>(2 * (s % 3) + 2, 5); ++x) {
          const auto w = static_cast<double>(all.weight_of(light, 5 * y + x));
          sum += w * static_cast<double>(all.plane(light, 1)[5 * y + x]);
          total += w;
          texels += 1.0;
        }
      }
      EXPECT_NEAR(found.weight_of(light, s), total / texels, 1e-6);
      EXPECT_NEAR(found.plane(light, 1)[s], total > 0.0 ? sum / total : 0.0, 1e-5);
    }
  }
}

TEST(ShrunkStack, TexelsAreThoseOfTheRowsHoweverLittleMemoryThereIs) {
  MemoryStack whole = numbered(7, 9, true);
  ShrunkStack half(whole, 2);
  const TexelBlock all = half.read_rows(0, half.info().height);
  const std::vector<std::uint32_t> wanted = {0, 3, 4, 9, 17, 19};
  for (const std::size_t memory : {std::size_t{1}, std::size_t{64} << 20}) {
    ShrunkStack stack(whole, 2, memory);
    EXPECT_EQ(stack.read_rows(1, 3).rgb, half.read_rows(1, 3).rgb);
    const TexelBlock some = stack.read_texels(wanted);
    EXPECT_EQ(some.texels, wanted);
    for (std::size_t light = 0; light < 2; ++light) {
      for (std::size_t k = 0; k < wanted.size(); ++k) {
        EXPECT_EQ(some.plane(light, 2)[k], all.plane(light, 2)[wanted[k]]);
        EXPECT_EQ(some.weight_of(light, k), all.weight_of(light, wanted[k]));
      }
    }
  }
}

// A near light must see the squares where they are.
// As files are read: a block has weights only where some value of it cannot be used.
class SparselyWeighted : public ImageStack {
 public:
  explicit SparselyWeighted(MemoryStack whole) : whole_(std::move(whole)) {}
  const StackInfo& info() const override { return whole_.info(); }
  TexelBlock read_rows(int first_row, int rows) override { return sparse(whole_.read_rows(first_row, rows)); }
  TexelBlock read_texels(std::span<const std::uint32_t> texels) override {
    return sparse(whole_.read_texels(texels));
  }

 private:
  static TexelBlock sparse(TexelBlock block) {
    if (std::ranges::all_of(block.weight, [](float w) { return w == 1.0F; })) block.weight.clear();
    return block;
  }
  MemoryStack whole_;
};

TEST(ShrunkStack, StripsWithoutWeightsCountInFullBesideOthers) {
  MemoryStack numbers = numbered(6, 12, false);
  TexelBlock block = numbers.read_rows(0, 12);
  block.weight.assign(2 * block.count(), 1.0F);
  for (std::size_t k = 6 * 4; k < 6 * 6; ++k) block.weight[k] = 0.0F;  // two rows of the first light
  SparselyWeighted whole({numbers.info(), block});
  ShrunkStack at_once(whole, 2);
  ShrunkStack in_strips(whole, 2, 1);
  std::vector<std::uint32_t> texels(at_once.info().texel_count());
  std::iota(texels.begin(), texels.end(), 0U);
  const TexelBlock expected = at_once.read_texels(texels);
  const TexelBlock found = in_strips.read_texels(texels);
  ASSERT_EQ(expected.weight_of(0, 0), 1.0F);
  ASSERT_EQ(expected.weight_of(0, 6), 0.0F);
  EXPECT_EQ(found.weight, expected.weight);
  EXPECT_EQ(found.rgb, expected.rgb);
}

TEST(ShrunkStack, TakesMemoryThatIsGivenBack) {
  MemoryStack whole = numbered(6, 12, true);
  ShrunkStack half(whole, 2);
  const std::vector<std::uint32_t> texels = {0, 4, 17};
  const TexelBlock first = half.read_texels(texels);
  TexelBlock other = half.read_rows(0, 6);
  half.give_back(std::move(other));
  const TexelBlock again = half.read_texels(texels);
  EXPECT_EQ(again.texels, first.texels);
  EXPECT_EQ(again.rgb, first.rgb);
  EXPECT_EQ(again.weight, first.weight);
}

TEST(ShrunkStack, CentresOfSquaresLieInTheMiddleOfTheirTexels) {
  StackInfo info;
  info.width = info.height = 8;
  info.plane = {{-3.0, 2.0, 1.0}, 0.5};
  MemoryStack whole(info, [] {
    TexelBlock block;
    block.texels.resize(64);
    std::iota(block.texels.begin(), block.texels.end(), 0U);
    return block;
  }());
  const ShrunkStack quarter(whole, 4);
  EXPECT_NEAR(quarter.info().plane.origin.x, -3.0 + 0.5 * 1.5, 1e-12);
  EXPECT_NEAR(quarter.info().plane.origin.y, 2.0 - 0.5 * 1.5, 1e-12);
  EXPECT_NEAR(quarter.info().plane.pixel_size, 2.0, 1e-12);
  EXPECT_THROW(ShrunkStack(whole, 0), std::invalid_argument);
}

TEST(Magnified, KeepsWhatIsEvenAndRampsInBetween) {
  StackInfo whole;
  whole.width = 12;
  whole.height = 8;
  for (const int shrink : {1, 2, 4}) {
    const int width = 12 / shrink;
    std::vector<std::uint32_t> all(static_cast<std::size_t>(width * 8 / shrink));
    std::iota(all.begin(), all.end(), 0U);
    std::vector<float> planes;
    for (std::size_t k = 0; k < all.size(); ++k) planes.push_back(3.0F);
    // The column's centre in the whole picture.
    for (const std::uint32_t k : all)
      planes.push_back(static_cast<float>((k % static_cast<unsigned>(width) + 0.5) * shrink));
    std::vector<std::uint32_t> texels(96);
    std::iota(texels.begin(), texels.end(), 0U);
    const std::vector<float> found = magnified(whole, shrink, planes, all, texels);
    for (std::size_t k = 0; k < 96; ++k) {
      EXPECT_FLOAT_EQ(found[k], 3.0F);
      const double centre = static_cast<double>(k % 12) + 0.5;
      EXPECT_NEAR(found[96 + k], std::clamp(centre, 0.5 * shrink, 12.0 - 0.5 * shrink), 1e-5);
    }
  }
  EXPECT_THROW(magnified(whole, 2, std::vector<float>{1.0F}, std::vector<std::uint32_t>{0},
                         std::vector<std::uint32_t>{50}),
               std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::bake
