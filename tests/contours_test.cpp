// Shadow contours on pictures with a shadow's edge in a known place.
#include "bake/contours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace brdfit::bake {
namespace {

constexpr int kWidth = 40;
constexpr int kHeight = 16;
constexpr std::size_t kSize = static_cast<std::size_t>(kWidth) * kHeight;

struct Picture {
  std::vector<float> luminance;
  std::vector<float> unshadowed = std::vector<float>(kSize, 0.8F);
  std::vector<float> facing = std::vector<float>(kSize, 0.9F);

  ShadowPicture view() const { return {luminance, unshadowed, facing}; }
};

// Lit left of a column, in shadow from it on, with texture.
Picture shadow_from(int column) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> texture(0.95F, 1.05F);
  Picture picture;
  for (std::size_t k = 0; k < kSize; ++k) {
    const bool lit = static_cast<int>(k % kWidth) < column;
    picture.luminance.push_back(texture(random) * (lit ? 0.8F : 0.05F));
  }
  return picture;
}

ShadowContours contours_of(const Picture& picture) {
  return find_contours(picture.view(), kWidth, kHeight);
}

TEST(Contours, VariationIsTheMeanDifferenceToNeighbours) {
  const std::vector<float> v = variation(std::vector<float>{0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 3.0F}, 3, 2);
  EXPECT_FLOAT_EQ(v[0], 1.0F / 3.0F);
  EXPECT_FLOAT_EQ(v[1], (1.0F + 1.0F + 1.0F + 1.0F + 2.0F) / 5.0F);
  EXPECT_FLOAT_EQ(v[5], (3.0F + 3.0F + 2.0F) / 3.0F);
  EXPECT_EQ(variation(std::vector<float>{2.0F}, 1, 1)[0], 0.0F);
}

TEST(Contours, LieOnBothSidesOfAShadowsEdge) {
  const ShadowContours found = contours_of(shadow_from(20));
  for (std::size_t k = 0; k < kSize; ++k) {
    const int x = static_cast<int>(k % kWidth);
    EXPECT_EQ(found.is_lit[k] != 0, x < 20) << x;
    EXPECT_EQ(found.is_contour[k] != 0, x == 19 || x == 20) << x;
  }
}

TEST(Contours, TextureAloneIsNone) {
  for (const int column : {0, kWidth}) {
    const ShadowContours found = contours_of(shadow_from(column));
    for (const std::uint8_t contour : found.is_contour) EXPECT_EQ(contour, 0);
  }
}

TEST(Contours, AreUnlikelyWhereTheLightGrazes) {
  Picture picture = shadow_from(20);
  std::ranges::fill(picture.facing, -0.1F);
  for (const std::uint8_t contour : contours_of(picture).is_contour) EXPECT_EQ(contour, 0);
}

TEST(Contours, TexelsBetweenTwoLoseWeightByTheirDistance) {
  const ShadowContours reference = contours_of(shadow_from(20));
  double last = 1.0;
  for (const int column : {21, 24, 30, 36}) {
    const std::vector<float> weights =
        contour_weights(reference, contours_of(shadow_from(column)), kWidth, kHeight);
    for (std::size_t k = 0; k < kSize; ++k) {
      const int x = static_cast<int>(k % kWidth);
      if (x < 20 || x >= column) {
        EXPECT_EQ(weights[k], 1.0F) << x;
      } else {
        EXPECT_LE(weights[k], 1.0F) << x;
        EXPECT_GT(weights[k], 0.0F) << x;
      }
    }
    const double middle = weights[8 * kWidth + static_cast<std::size_t>((20 + column) / 2)];
    EXPECT_LT(middle, column == 21 ? 1.01 : last);
    last = middle;
  }
  EXPECT_LT(last, 0.1);
}

TEST(Contours, HalfTheWeightIsLostAtTheGivenGap) {
  ContourOptions options;
  options.half_weight_gap = 5.0;
  // Contours at 20 and 26: texel 22 is 2 from one and 3 from the other (whose near side is 25).
  const std::vector<float> weights =
      contour_weights(contours_of(shadow_from(20)), contours_of(shadow_from(26)), kWidth, kHeight, options);
  EXPECT_NEAR(weights[8 * kWidth + 22], 0.5F, 1e-6F);
}

TEST(Contours, AShadowThatOneLacksCostsNothing) {
  const ShadowContours none = contours_of(shadow_from(kWidth));
  for (const float w : contour_weights(contours_of(shadow_from(20)), none, kWidth, kHeight)) {
    EXPECT_EQ(w, 1.0F);
  }
  ContourOptions near;
  near.reach = 3.0;
  for (const float w :
       contour_weights(contours_of(shadow_from(10)), contours_of(shadow_from(30)), kWidth, kHeight, near)) {
    EXPECT_EQ(w, 1.0F);
  }
}

TEST(Contours, BlackPicturesAndTheSameTwiceCostNothing) {
  Picture black;
  black.luminance.assign(kSize, 0.0F);
  black.unshadowed.assign(kSize, 0.0F);
  const ShadowContours dark = contours_of(black);
  const ShadowContours found = contours_of(shadow_from(20));
  for (const float w : contour_weights(dark, dark, kWidth, kHeight)) EXPECT_EQ(w, 1.0F);
  for (const float w : contour_weights(found, found, kWidth, kHeight)) EXPECT_EQ(w, 1.0F);
}

TEST(Contours, RefuseWhatDoesNotFit) {
  const Picture picture = shadow_from(20);
  EXPECT_THROW(find_contours(picture.view(), kWidth + 1, kHeight), std::invalid_argument);
  EXPECT_THROW(find_contours(picture.view(), kWidth, kHeight, {.threshold = 0.0}), std::invalid_argument);
  EXPECT_THROW(variation(picture.luminance, 0, 0), std::invalid_argument);
  EXPECT_THROW(contour_weights({}, {}, kWidth, kHeight), std::invalid_argument);
}

// What a pass over parts of rows finds, each with its halo.
std::vector<float> weights_by_parts(const Picture& reference, const Picture& render, int rows,
                                    const ContourOptions& options) {
  const auto part_of = [](const Picture& whole, int first, int last) {
    const auto cut = [&](const std::vector<float>& v) {
      return std::vector<float>(v.begin() + first * kWidth, v.begin() + last * kWidth);
    };
    return Picture{cut(whole.luminance), cut(whole.unshadowed), cut(whole.facing)};
  };
  const auto for_parts = [&](int halo, const auto& use) {
    for (int row = 0; row < kHeight; row += rows) {
      const int end = std::min(row + rows, kHeight);
      const int first = std::max(row - halo, 0);
      const int last = std::min(end + halo, kHeight);
      use(part_of(reference, first, last), part_of(render, first, last), last - first,
          Rows{row - first, end - first});
    }
  };
  VariationSums seen, shown;
  for_parts(1, [&](const Picture& a, const Picture& b, int height, const Rows& inner) {
    add_variation(seen, a.view(), kWidth, height, inner);
    add_variation(shown, b.view(), kWidth, height, inner);
  });
  std::vector<float> weights;
  for_parts(contour_halo(options), [&](const Picture& a, const Picture& b, int height, const Rows& inner) {
    const std::vector<float> part =
        contour_weights(find_contours(a.view(), kWidth, height, seen, options),
                        find_contours(b.view(), kWidth, height, shown, options), kWidth, height, options);
    weights.insert(weights.end(), part.begin() + inner.first * kWidth, part.begin() + inner.last * kWidth);
  });
  return weights;
}

TEST(ContourWeights, ArePictureWideHoweverRowsAreCut) {
  // A shadow whose edge falls off across the rows, and a render's a few pixels away from it.
  Picture reference = shadow_from(0);
  Picture render = shadow_from(0);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto at = static_cast<std::size_t>(y * kWidth + x);
      if (x + y < 24) reference.luminance[at] *= 16.0F;
      if (x < 16 && y < 9) render.luminance[at] *= 16.0F;
    }
  }
  ContourOptions options;
  options.reach = 5.0;
  const std::vector<float> expected =
      contour_weights(contours_of(reference), contours_of(render), kWidth, kHeight, options);
  EXPECT_GT(std::count_if(expected.begin(), expected.end(), [](float w) { return w < 1.0F; }), 20);
  EXPECT_LT(*std::min_element(expected.begin(), expected.end()), 0.5F);
  for (const int rows : {1, 3, 7, 16}) {
    EXPECT_EQ(weights_by_parts(reference, render, rows, options), expected) << rows;
  }
}

}  // namespace
}  // namespace brdfit::bake
