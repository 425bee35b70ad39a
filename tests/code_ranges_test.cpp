// Ranges of codes: they reach what they are asked to, and fitting them never loses to a quantile.
#include "bake/code_ranges.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "tests/lobe_equations.h"

namespace brdfit::bake {
namespace {

// Texels whose amplitudes have heavy tails, and are not centred on 0.
std::vector<CodeSearch> texels_of(unsigned seed, std::size_t count, std::uint32_t mask = 0x0F) {
  std::mt19937 engine(seed);
  std::student_t_distribution<double> heavy(3.0);
  std::vector<CodeSearch> texels;
  for (std::size_t k = 0; k < count; ++k) {
    TexelEquations equations = test_data::overlapping_lobes(seed * 1000U + static_cast<unsigned>(k), 4);
    LobeVector amplitudes(4);
    for (Eigen::Index lobe = 0; lobe < 4; ++lobe) amplitudes[lobe] = heavy(engine) + 0.5;
    equations.b = equations.a * amplitudes;
    texels.emplace_back(equations, mask);
  }
  return texels;
}

TEST(CodeRanges, ReachBothEndsWithTheSmallestStep) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const int bits : {2, 4, 8}) {
    for (int trial = 0; trial < 200; ++trial) {
      const double low = trial % 5 == 0 ? 0.0 : -uniform(engine);
      const double high = trial % 7 == 0 ? 0.0 : uniform(engine);
      const RealisRange range = range_between(low, high, bits);
      ASSERT_GE(range.zero, 0);
      ASSERT_LE(range.zero, realis_top_code(bits));
      EXPECT_LE(-range.zero * range.step, low + 1e-12);
      EXPECT_GE((realis_top_code(bits) - range.zero) * range.step, high - 1e-12);
      for (int zero = 0; zero <= realis_top_code(bits); ++zero) {
        const double below = zero > 0 ? -low / zero : low < 0.0 ? 1e9 : 0.0;
        const int above_count = realis_top_code(bits) - zero;
        const double above = above_count > 0 ? high / above_count : high > 0.0 ? 1e9 : 0.0;
        EXPECT_LE(range.step, std::max(below, above) + 1e-12);
      }
    }
  }
  EXPECT_EQ(range_between(0.0, 0.0, 4), (RealisRange{0.0, 0}));
  EXPECT_THROW(range_between(0.1, 1.0, 4), std::invalid_argument);
  EXPECT_THROW(range_between(-1.0, -0.1, 4), std::invalid_argument);
  EXPECT_THROW(range_between(0.0, std::numeric_limits<double>::infinity(), 4), std::invalid_argument);
}

TEST(CodeRanges, AQuantileLeavesOutItsTails) {
  std::vector<CodeSearch> texels;
  for (int k = -10; k <= 100; ++k) {
    texels.emplace_back(
        TexelEquations{LobeMatrix::Identity(1, 1), LobeVector::Constant(1, static_cast<double>(k))}, 1U);
  }
  const RealisRange all = quantile_ranges(texels, 1, 8, 0.0)[0];
  EXPECT_GE((255 - all.zero) * all.step, 100.0 - 1e-6);
  const RealisRange some = quantile_ranges(texels, 1, 8, 0.05)[0];
  EXPECT_NEAR(some.step, 100.0 / 255.0, 0.01);  // from -5 to 95
  EXPECT_THROW(quantile_ranges(texels, 1, 8, 0.5), std::invalid_argument);
}

TEST(CodeRanges, FittedAreNeverWorseThanAQuantile) {
  for (const int bits : {4, 8}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const std::vector<CodeSearch> texels = texels_of(seed, 150);
      const std::vector<RealisRange> fitted = fitted_ranges(texels, 4, bits);
      const double error = rounding_error(texels, {bits, fitted});
      for (const double tail : kTails) {
        EXPECT_LE(error, rounding_error(texels, {bits, quantile_ranges(texels, 4, bits, tail)})) << tail;
      }
      for (const RealisRange& range : fitted) {
        EXPECT_GT(range.step, 0.0);
        EXPECT_GE(range.zero, 0);
        EXPECT_LE(range.zero, realis_top_code(bits));
      }
    }
  }
}

TEST(CodeRanges, FittedAtFewBitsBeatRangesThatCutNothing) {
  const std::vector<CodeSearch> texels = texels_of(5, 300);
  EXPECT_LT(rounding_error(texels, {4, fitted_ranges(texels, 4, 4)}),
            0.9 * rounding_error(texels, {4, quantile_ranges(texels, 4, 4, 0.0)}));
}

TEST(CodeRanges, LobesThatNoTexelKeepsHaveNone) {
  const std::vector<RealisRange> ranges = fitted_ranges(texels_of(2, 20, 0b0101), 4, 4);
  EXPECT_GT(ranges[0].step, 0.0);
  EXPECT_EQ(ranges[1].step, 0.0);
  EXPECT_EQ(ranges[3].step, 0.0);
  EXPECT_EQ(fitted_ranges({}, 3, 8), std::vector<RealisRange>(3));
}

TEST(CodeRanges, DoNotDependOnThreads) {
  const std::vector<CodeSearch> texels = texels_of(4, 200);
  const std::vector<RealisRange> many = fitted_ranges(texels, 4, 4);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(fitted_ranges(texels, 4, 4), many);
}

}  // namespace
}  // namespace brdfit::bake
