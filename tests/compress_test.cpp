// Compression of a texel's amplitudes: rounding and dropping lobes is made good by what is left.
#include "bake/compress.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <bit>
#include <cmath>
#include <random>
#include <vector>

namespace brdfit::bake {
namespace {

// Equations of lobes that overlap, as those of real light sets do.
TexelEquations overlapping_lobes(unsigned seed, int lobes = 8) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd basis(20, lobes);
  for (Eigen::Index i = 0; i < basis.rows(); ++i) {
    const double common = normal(engine);
    for (Eigen::Index k = 0; k < lobes; ++k) basis(i, k) = common + 0.7 * normal(engine);
  }
  Eigen::VectorXd target(20);
  for (Eigen::Index i = 0; i < 20; ++i) target[i] = normal(engine);
  TexelEquations equations{LobeMatrix(basis.transpose() * basis), LobeVector(basis.transpose() * target)};
  equations.a.diagonal().array() += 0.05;
  return equations;
}

double error_of(const TexelEquations& equations, const LobeVector& amplitudes) {
  const LobeVector off = amplitudes - solve(equations);
  return off.dot(equations.a * off);
}

Quantiser quantiser_for(const LobeVector& amplitudes, int bits) {
  return {bits,
          std::vector<double>(static_cast<std::size_t>(amplitudes.size()), amplitudes.cwiseAbs().maxCoeff())};
}

LobeVector decoded(const Quantiser& quantiser, const std::vector<int>& codes) {
  LobeVector out(static_cast<Eigen::Index>(codes.size()));
  for (std::size_t k = 0; k < codes.size(); ++k) {
    out[static_cast<Eigen::Index>(k)] = quantiser.amplitude(static_cast<int>(k), codes[k]);
  }
  return out;
}

TEST(Compress, SolvesTheEquations) {
  const TexelEquations equations = overlapping_lobes(1);
  EXPECT_LT((equations.a * solve(equations) - equations.b).norm(), 1e-9 * equations.b.norm());
}

TEST(Compress, ATexelWithoutLightHasNoAmplitudes) {
  const TexelEquations dark{LobeMatrix::Zero(4, 4), LobeVector::Zero(4)};
  EXPECT_EQ(solve(dark).norm(), 0.0);
  EXPECT_EQ(dominant_lobes(dark, 2).amplitudes.norm(), 0.0);
  for (const int code : quantise(dark, {8, {1.0, 1.0, 1.0, 1.0}}, 0xF, {})) EXPECT_EQ(code, 0);
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

TEST(Compress, RoundingWithFeedbackBeatsRoundingAlone) {
  double with_feedback = 0.0;
  double alone = 0.0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const TexelEquations equations = overlapping_lobes(seed);
    const LobeVector best = solve(equations);
    const Quantiser quantiser = quantiser_for(best, 4);
    with_feedback += error_of(equations, decoded(quantiser, quantise(equations, quantiser, 0xFF, {})));
    std::vector<int> rounded;
    for (int k = 0; k < 8; ++k) {
      rounded.push_back(static_cast<int>(std::lround(
          best[k] / quantiser.precision[static_cast<std::size_t>(k)] * quantiser.largest_code())));
    }
    alone += error_of(equations, decoded(quantiser, rounded));
  }
  EXPECT_LT(with_feedback, 0.6 * alone);
}

TEST(Compress, CodesStayInRangeAndOutsideTheMaskThereIsNone) {
  for (const int bits : {4, 8}) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      const TexelEquations equations = overlapping_lobes(seed);
      Quantiser quantiser = quantiser_for(solve(equations), bits);
      for (double& precision : quantiser.precision) precision *= 0.2;  // most amplitudes are cut
      const std::vector<int> codes = quantise(equations, quantiser, 0x0F, {});
      for (int k = 0; k < 8; ++k) {
        EXPECT_LE(std::abs(codes[static_cast<std::size_t>(k)]), quantiser.largest_code());
        if (k >= 4) {
          EXPECT_EQ(codes[static_cast<std::size_t>(k)], 0);
        }
      }
    }
  }
}

TEST(Compress, DitherKeepsTheMeanOfAFlatArea) {
  TexelEquations equations{LobeMatrix::Identity(1, 1), LobeVector(1)};
  equations.b[0] = 0.37;
  const Quantiser quantiser{4, {7.0}};
  double mean = 0.0;
  for (std::uint32_t y = 0; y < 64; ++y) {
    for (std::uint32_t x = 0; x < 64; ++x) {
      const std::vector<double> dither{dither_threshold(x, y, 0)};
      mean += quantiser.amplitude(0, quantise(equations, quantiser, 1, dither)[0]) / 4096.0;
    }
  }
  EXPECT_NEAR(mean, 0.37, 0.01);
}

TEST(Compress, PrecisionIsAQuantileOverUsedTexels) {
  // Two lobes, five texels of which one is not used.
  const std::vector<float> amplitudes{1.0F, -2.0F, 3.0F, -4.0F, 0.0F, 0.1F, 0.2F, 0.3F, 50.0F, 0.0F};
  EXPECT_EQ(precision_per_lobe(amplitudes, 2, 1.0), (std::vector<double>{4.0, 50.0}));
  EXPECT_EQ(precision_per_lobe(amplitudes, 2, 0.75)[0], 3.0);
  EXPECT_EQ(precision_per_lobe(std::vector<float>(4, 0.0F), 2, 0.9), (std::vector<double>{0.0, 0.0}));
}

}  // namespace
}  // namespace brdfit::bake
