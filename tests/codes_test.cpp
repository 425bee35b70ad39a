// Codes of a texel's amplitudes: a search never loses to rounding, whatever the lobes, ranges and dither.
#include "bake/codes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bake/dither.h"
#include "tests/lobe_equations.h"

namespace brdfit::bake {
namespace {

using test_data::error_of;
using test_data::overlapping_lobes;

constexpr int kManySteps = 1 << 20;

// Ranges that reach `share` of the largest amplitude on both sides, 0 a little off their middle.
Quantiser quantiser_for(const LobeVector& amplitudes, int bits, double share = 1.0) {
  const int zero = realis_top_code(bits) / 2 - 1;
  const RealisRange range{share * amplitudes.cwiseAbs().maxCoeff() / zero, zero};
  return {bits, std::vector<RealisRange>(static_cast<std::size_t>(amplitudes.size()), range)};
}

LobeVector decoded(const Quantiser& quantiser, const std::vector<int>& codes) {
  LobeVector out(static_cast<Eigen::Index>(codes.size()));
  for (std::size_t k = 0; k < codes.size(); ++k) {
    out[static_cast<Eigen::Index>(k)] = quantiser.amplitude(k, codes[k]);
  }
  return out;
}

TEST(Codes, TheCodeZeroIsNoAmplitude) {
  const Quantiser quantiser{4, {{0.25, 0}, {0.25, 5}, {0.25, 15}, {0.0, 3}}};
  for (std::size_t lobe = 0; lobe < 4; ++lobe) EXPECT_EQ(quantiser.amplitude(lobe, 0), 0.0);
  EXPECT_EQ(quantiser.amplitude(1, quantiser.smallest_code(1)), -1.25);
  EXPECT_EQ(quantiser.amplitude(1, quantiser.largest_code(1)), 2.5);
}

TEST(Codes, ATexelWithoutLightHasNone) {
  const TexelEquations dark{LobeMatrix::Zero(4, 4), LobeVector::Zero(4)};
  const Quantiser quantiser{8, std::vector<RealisRange>(4, {1.0, 100})};
  for (const int code : quantise(dark, quantiser, 0xF, {}, kManySteps)) EXPECT_EQ(code, 0);
}

TEST(Codes, FeedbackBeatsRoundingAlone) {
  double with_feedback = 0.0;
  double alone = 0.0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const TexelEquations equations = overlapping_lobes(seed);
    const LobeVector best = solve(equations);
    const Quantiser quantiser = quantiser_for(best, 4);
    with_feedback += error_of(equations, decoded(quantiser, quantise(equations, quantiser, 0xFF, {}, 0)));
    std::vector<int> rounded;
    for (std::size_t k = 0; k < 8; ++k) {
      rounded.push_back(
          static_cast<int>(std::lround(best[static_cast<Eigen::Index>(k)] / quantiser.ranges[k].step)));
    }
    alone += error_of(equations, decoded(quantiser, rounded));
  }
  EXPECT_LT(with_feedback, 0.6 * alone);
}

// Sixteen lobes overlap more than eight: searched as briefly, they left more error.
TEST(Codes, MoreLobesAreSearchedForLonger) {
  double briefly = 0.0;
  double as_long_as_usual = 0.0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const TexelEquations equations = overlapping_lobes(seed, 16);
    const CodeSearch search(equations, 0xFFFF);
    const Quantiser quantiser = quantiser_for(search.amplitudes(), 4);
    std::vector<int> codes(16);
    briefly += search.find(quantiser, {}, search_steps(4, 8), codes);
    as_long_as_usual += search.find(quantiser, {}, search_steps(4, 16), codes);
  }
  EXPECT_LT(as_long_as_usual, 0.9 * briefly);
}

// Ranges are an asset's: a texel whose lobes cancel may lie between codes far apart.
TEST(Codes, AreNeverWorseThanNoneWhereLobesAlmostCoincide) {
  int none_is_best = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    TexelEquations equations = overlapping_lobes(seed, 4);
    for (const Eigen::Index k : {1, 3}) {
      equations.a.row(k) = equations.a.row(k - 1) * (1.0 + 1e-4 * static_cast<double>(k));
      equations.a.col(k) = equations.a.row(k).transpose();
      equations.a(k, k) = equations.a(k - 1, k - 1) * (1.0 + 1e-3);
      equations.b[k] = equations.b[k - 1] * 1.001;
    }
    const double without = error_of(equations, LobeVector::Zero(4));
    for (const double step : {0.01, 0.3, 1.0}) {
      const Quantiser quantiser{8, std::vector<RealisRange>(4, {step, 128})};
      std::vector<int> codes(4);
      const double error = CodeSearch(equations, 0xF).find(quantiser, {}, 0, codes);
      EXPECT_LE(error, without * (1.0 + 1e-9));
      EXPECT_NEAR(error, error_of(equations, decoded(quantiser, codes)), 1e-6 * without);
      if (codes == std::vector<int>(4, 0)) ++none_is_best;
    }
  }
  EXPECT_GT(none_is_best, 0);
  EXPECT_LT(none_is_best, 400);
}

TEST(Codes, EveryFurtherStepIsNoWorse) {
  double nearest_plane = 0.0;
  double searched = 0.0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const TexelEquations equations = overlapping_lobes(seed);
    for (const double share : {0.3, 1.0}) {
      const Quantiser quantiser = quantiser_for(solve(equations), 4, share);
      double before = error_of(equations, decoded(quantiser, quantise(equations, quantiser, 0xFF, {}, 0)));
      nearest_plane += before;
      for (const int steps : {8, 32, 256, 4096}) {
        const double error =
            error_of(equations, decoded(quantiser, quantise(equations, quantiser, 0xFF, {}, steps)));
        EXPECT_LE(error, before * (1.0 + 1e-9)) << seed << ' ' << steps;
        before = error;
      }
      searched += before;
    }
  }
  EXPECT_LT(searched, 0.8 * nearest_plane);
}

// All codes of three lobes are few enough to try.
TEST(Codes, ASearchToTheEndFindsTheLeastErrorOfAll) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const TexelEquations equations = overlapping_lobes(seed, 3);
    const Quantiser quantiser = quantiser_for(solve(equations), 3, 0.8);
    double least = 1e300;
    for (int code = 0; code < 512; ++code) {
      const std::vector<int> codes{code % 8 + quantiser.smallest_code(0),
                                   code / 8 % 8 + quantiser.smallest_code(1),
                                   code / 64 + quantiser.smallest_code(2)};
      least = std::min(least, error_of(equations, decoded(quantiser, codes)));
    }
    std::array<int, 3> found{};
    const double error = CodeSearch(equations, 0b111).find(quantiser, {}, kManySteps, found);
    EXPECT_NEAR(error, least, 1e-9 * (1.0 + least)) << seed;
    EXPECT_NEAR(error_of(equations, decoded(quantiser, {found.begin(), found.end()})), least,
                1e-9 * (1.0 + least));
  }
}

TEST(Codes, StayInRangeAndOutsideTheMaskThereIsNone) {
  for (const int bits : {4, 8}) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      const TexelEquations equations = overlapping_lobes(seed);
      Quantiser quantiser = quantiser_for(solve(equations), bits, 0.2);  // most amplitudes are cut
      quantiser.ranges[1].zero = 0;
      quantiser.ranges[2].zero = realis_top_code(bits);
      quantiser.ranges[3].step = 0.0;
      for (const double shift : {-0.5, 0.0, 0.5}) {
        const std::vector<int> codes =
            quantise(equations, quantiser, 0x0F, std::vector<double>(8, shift), search_steps(bits, 4));
        for (std::size_t k = 0; k < 8; ++k) {
          EXPECT_GE(codes[k], quantiser.smallest_code(k));
          EXPECT_LE(codes[k], quantiser.largest_code(k));
          if (k >= 3) {
            EXPECT_EQ(codes[k], 0);
          }
        }
      }
    }
  }
}

TEST(Codes, DitherOfAWholeStepKeepsTheMeanOfAFlatArea) {
  TexelEquations equations{LobeMatrix::Identity(1, 1), LobeVector(1)};
  equations.b[0] = 0.37;
  const Quantiser quantiser{4, {{1.0, 7}}};
  double mean = 0.0;
  for (std::uint32_t y = 0; y < 64; ++y) {
    for (std::uint32_t x = 0; x < 64; ++x) {
      const std::vector<double> noise{dither_threshold(x, y, 0)};
      mean += quantiser.amplitude(0, quantise(equations, quantiser, 1, noise, 0, 1.0)[0]) / 4096.0;
    }
  }
  EXPECT_NEAR(mean, 0.37, 0.01);
}

// A ramp of slowly changing amplitudes over size x size texels, rounded to 4 bits.
class Ramp {
 public:
  explicit Ramp(double strength) {
    const TexelEquations from = overlapping_lobes(3);
    const LobeVector target = from.b + 0.3 * overlapping_lobes(4).b;
    const Quantiser quantiser = quantiser_for(solve(from), 4);
    for (std::uint32_t y = 0; y < kSize; ++y) {
      for (std::uint32_t x = 0; x < kSize; ++x) {
        const double along = (x + 0.2 * y) / kSize;
        const TexelEquations texel{from.a, from.b + along * (target - from.b)};
        std::vector<double> noise;
        for (int k = 0; k < 8; ++k) noise.push_back(dither_threshold(x, y, k));
        errors_.push_back(
            decoded(quantiser, quantise(texel, quantiser, 0xFF, noise, search_steps(4, 8), strength)) -
            solve(texel));
      }
    }
    a_ = from.a;
  }

  // RMS of what the mean over (2 radius + 1)^2 neighbours is off.
  double error_of_means(int radius) const {
    double sum = 0.0;
    int count = 0;
    for (int y = radius; y < kSize - radius; ++y) {
      for (int x = radius; x < kSize - radius; ++x) {
        LobeVector mean = LobeVector::Zero(8);
        for (int dy = -radius; dy <= radius; ++dy) {
          for (int dx = -radius; dx <= radius; ++dx)
            mean += errors_[static_cast<std::size_t>((y + dy) * kSize + x + dx)];
        }
        mean /= (2 * radius + 1) * (2 * radius + 1);
        sum += mean.dot(a_ * mean);
        ++count;
      }
    }
    return std::sqrt(sum / count);
  }

 private:
  static constexpr int kSize = 32;
  LobeMatrix a_;
  std::vector<LobeVector> errors_;
};

// Rounding a shift away leaves nothing: it stays within the amplitudes whose codes are the same.
TEST(Codes, DitherMovesAmplitudesByNoMoreThanRounding) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const TexelEquations equations = overlapping_lobes(seed);
    const Quantiser quantiser = quantiser_for(solve(equations), 4);
    std::vector<double> noise;
    LobeVector by_lobe(8);
    for (int k = 0; k < 8; ++k) {
      noise.push_back(dither_threshold(seed, 2 * seed, k));
      by_lobe[k] = noise.back() * quantiser.ranges[static_cast<std::size_t>(k)].step;
    }
    const CodeSearch search(equations, 0xFF);
    const LobeVector shift = search.dither(quantiser, noise, kManySteps);
    EXPECT_LE(shift.dot(equations.a * shift), by_lobe.dot(equations.a * by_lobe) * (1.0 + 1e-9));
    std::array<int, 8> codes{};
    CodeSearch({equations.a, equations.a * shift}, 0xFF).find(quantiser, {}, kManySteps, codes);
    for (const int code : codes) EXPECT_EQ(code, 0);
  }
}

TEST(Codes, DitherMakesMeansOverNeighboursFollowASlowRamp) {
  const Ramp plain(0.0);
  const Ramp dithered(kDitherStrength);
  EXPECT_LT(dithered.error_of_means(1), 0.7 * plain.error_of_means(1));
  EXPECT_LT(dithered.error_of_means(2), 0.6 * plain.error_of_means(2));
  // What it costs each texel is less than dither of a whole step does.
  EXPECT_LT(dithered.error_of_means(0), 1.5 * plain.error_of_means(0));
  EXPECT_LT(dithered.error_of_means(0), Ramp(1.0).error_of_means(0));
}

}  // namespace
}  // namespace brdfit::bake
