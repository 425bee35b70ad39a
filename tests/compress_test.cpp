// A texel's equations: dropping lobes is made good by those that are left.
#include "bake/compress.h"

#include <gtest/gtest.h>

#include <bit>

#include "tests/lobe_equations.h"

namespace brdfit::bake {
namespace {

using test_data::error_of;
using test_data::overlapping_lobes;

TEST(Compress, SolvesTheEquations) {
  const TexelEquations equations = overlapping_lobes(1);
  EXPECT_LT((equations.a * solve(equations) - equations.b).norm(), 1e-9 * equations.b.norm());
}

TEST(Compress, ATexelWithoutLightHasNoAmplitudes) {
  const TexelEquations dark{LobeMatrix::Zero(4, 4), LobeVector::Zero(4)};
  EXPECT_EQ(solve(dark).norm(), 0.0);
  EXPECT_EQ(refit(dark, dominant_mask(std::span(&dark, 1), 2)).norm(), 0.0);
}

TEST(Compress, CoincidentLobesStayFinite) {
  TexelEquations equations = overlapping_lobes(2, 3);
  equations.a.row(2) = equations.a.row(1);
  equations.a.col(2) = equations.a.col(1);
  equations.b[2] = equations.b[1];
  EXPECT_TRUE(solve(equations).allFinite());
  EXPECT_TRUE(refit(equations, dominant_mask(std::span(&equations, 1), 1)).allFinite());
}

TEST(Compress, DominantLobesAreRefitted) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const TexelEquations equations = overlapping_lobes(seed);
    const std::uint32_t mask = dominant_mask(std::span(&equations, 1), 4);
    const LobeVector amplitudes = refit(equations, mask);
    EXPECT_EQ(std::popcount(mask), 4);
    LobeVector dropped = solve(equations);
    LobeVector slope = equations.a * amplitudes - equations.b;
    for (int k = 0; k < 8; ++k) {
      const bool kept = (mask >> k & 1U) != 0;
      if (!kept) dropped[k] = 0.0;
      // At the best amplitudes of the kept lobes the error has no slope along them.
      if (kept) {
        EXPECT_NEAR(slope[k], 0.0, 1e-8);
      } else {
        EXPECT_EQ(amplitudes[k], 0.0);
      }
    }
    EXPECT_LE(error_of(equations, amplitudes), error_of(equations, dropped) + 1e-9);
  }
}

TEST(Compress, AllLobesAreTheSolution) {
  const TexelEquations equations = overlapping_lobes(3);
  EXPECT_EQ(dominant_mask(std::span(&equations, 1), 8), 0xFFU);
  EXPECT_LT((refit(equations, 0xFFU) - solve(equations)).norm(), 1e-9);
}

// One channel alone would keep its own lobes; together the larger error decides.
TEST(Compress, ChannelsShareTheLobesThatTheyMissMost) {
  TexelEquations faint = overlapping_lobes(4);
  const TexelEquations strong = overlapping_lobes(5);
  faint.b *= 1e-4;
  const TexelEquations both[] = {faint, strong};
  const TexelEquations twice[] = {strong, strong, strong};
  const std::uint32_t alone = dominant_mask(std::span(&strong, 1), 3);
  EXPECT_NE(dominant_mask(std::span(&faint, 1), 3), alone);
  EXPECT_EQ(dominant_mask(both, 3), alone);
  EXPECT_EQ(dominant_mask(twice, 3), alone);
}

}  // namespace
}  // namespace brdfit::bake
