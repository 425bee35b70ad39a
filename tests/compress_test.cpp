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
  EXPECT_EQ(dominant_lobes(dark, 2).amplitudes.norm(), 0.0);
}

TEST(Compress, CoincidentLobesStayFinite) {
  TexelEquations equations = overlapping_lobes(2, 3);
  equations.a.row(2) = equations.a.row(1);
  equations.a.col(2) = equations.a.col(1);
  equations.b[2] = equations.b[1];
  EXPECT_TRUE(solve(equations).allFinite());
  EXPECT_TRUE(dominant_lobes(equations, 1).amplitudes.allFinite());
}

TEST(Compress, DominantLobesAreRefitted) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const TexelEquations equations = overlapping_lobes(seed);
    const Dominant dominant = dominant_lobes(equations, 4);
    EXPECT_EQ(std::popcount(dominant.mask), 4);
    LobeVector dropped = solve(equations);
    LobeVector slope = equations.a * dominant.amplitudes - equations.b;
    for (int k = 0; k < 8; ++k) {
      const bool kept = (dominant.mask >> k & 1U) != 0;
      if (!kept) dropped[k] = 0.0;
      // At the best amplitudes of the kept lobes the error has no slope along them.
      if (kept) {
        EXPECT_NEAR(slope[k], 0.0, 1e-8);
      } else {
        EXPECT_EQ(dominant.amplitudes[k], 0.0);
      }
    }
    EXPECT_LE(error_of(equations, dominant.amplitudes), error_of(equations, dropped) + 1e-9);
  }
}

TEST(Compress, AllLobesAreTheSolution) {
  const TexelEquations equations = overlapping_lobes(3);
  EXPECT_LT((dominant_lobes(equations, 8).amplitudes - solve(equations)).norm(), 1e-9);
}

}  // namespace
}  // namespace brdfit::bake
