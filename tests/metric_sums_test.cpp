// Sums of the error measures against their definitions, for every instruction set.
#include "fit/metric_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "brdf/simd/dispatch.h"
#include "tests/direction_pairs.h"

namespace brdfit::fit {
namespace {

using testing_support::Random;
using testing_support::uniform;

constexpr std::size_t kCount = 3 * simd::kLineBlock;

double srgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

// Columns that a job points to.
struct Columns {
  std::array<std::vector<double>, 3> f, f_swapped;
  std::array<std::array<std::vector<float>, 3>, 2> r;
  std::array<std::vector<double>, 2> cos_i;
  std::array<std::vector<float>, 2> weight;

  // Values over fifteen decades, f near r in half of the cells, and some cells without a measurement.
  explicit Columns(Random& random) {
    for (std::size_t side = 0; side < 2; ++side) {
      for (std::size_t k = 0; k < kCount; ++k) {
        cos_i[side].push_back(uniform(random, 0.01, 1.0));
        weight[side].push_back(static_cast<float>(random() % 3));
      }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < kCount; ++k) {
        const double value = random() % 20 == 0 ? 0.0 : std::pow(10.0, uniform(random, -10.0, 5.0));
        f[c].push_back(value);
        f_swapped[c].push_back(value * uniform(random, 0.5, 1.5));
        for (auto& side : r) {
          const double other = random() % 2 == 0 ? value * (1.0 + uniform(random, -1e-3, 1e-3))
                                                 : std::pow(10.0, uniform(random, -10.0, 5.0));
          side[c].push_back(static_cast<float>(other));
        }
      }
    }
    for (auto& side : r) {
      for (std::size_t k = 0; k < kCount; k += 7) side[0][k] = side[1][k] = side[2][k] = -1.0F;
    }
  }

  MetricSide side(std::size_t i) const {
    return {
        {r[i][0].data(), r[i][1].data(), r[i][2].data()}, 1, 0, kCount, cos_i[i].data(), weight[i].data()};
  }

  MetricJob job(std::initializer_list<std::size_t> sides) const {
    MetricJob job;
    for (std::size_t c = 0; c < 3; ++c) {
      job.f[c] = f[c].data();
      job.f_swapped[c] = f_swapped[c].data();
    }
    job.count = kCount;
    job.side_count = 0;
    for (const std::size_t i : sides) job.sides[job.side_count++] = side(i);
    return job;
  }
};

// Term by term in double precision, from entries that the job's plain fields select.
MetricSums expected_sums(const MetricJob& job) {
  MetricSums s;
  for (int i = 0; i < job.side_count; ++i) {
    const MetricSide& side = job.sides[i];
    for (std::size_t k = side.begin; k < side.end; ++k) {
      const auto at = static_cast<std::ptrdiff_t>(k) * side.step;
      if (side.r[0][at] < 0.0F) continue;
      const double w = side.weight != nullptr ? side.weight[k] : 1.0;
      s.weight += w;
      for (std::size_t c = 0; c < 3; ++c) {
        const double f = job.f[c][k];
        const double r = side.r[c][at];
        const double a = f * side.cos_i[k];
        const double b = r * side.cos_i[k];
        s.log_ratio += w * std::abs(std::log((a + 1e-3) / (b + 1e-3)));
        s.relative += w * std::abs(f - r) / (r + 1e-3);
        s.cube_root += w * std::pow(std::cbrt(a) - std::cbrt(b), 2);
        s.srgb += w * std::pow(srgb(std::numbers::pi * a) - srgb(std::numbers::pi * b), 2);
        s.cosine_l2 += w * std::pow(a - b, 2);
        s.clipped += w * std::pow(std::min(f, 1.0) - std::min(r, 1.0), 2);
      }
    }
  }
  return s;
}

void expect_near(const MetricSums& actual, const MetricSums& expected, double tolerance) {
  const auto near = [&](double MetricSums::*member, const char* name) {
    EXPECT_NEAR(actual.*member, expected.*member, tolerance * expected.*member) << name;
  };
  EXPECT_EQ(actual.weight, expected.weight);
  near(&MetricSums::log_ratio, "log-ratio");
  near(&MetricSums::relative, "relative");
  near(&MetricSums::cube_root, "cube root");
  near(&MetricSums::srgb, "sRGB");
  near(&MetricSums::cosine_l2, "cosine L2");
  near(&MetricSums::clipped, "clipped");
}

MetricSums sums_of(simd::Isa isa, const MetricJob& job) {
  MetricSums sums;
  metric_function(isa)(job, sums);
  return sums;
}

// What a sum of a few hundred terms in single precision loses.
constexpr double kRounding = 2e-6;

class MetricSumsOf : public testing::TestWithParam<simd::Isa> {};

TEST_P(MetricSumsOf, ASideFollowTheDefinitions) {
  Random random(1);
  for (int round = 0; round < 20; ++round) {
    const Columns columns(random);
    const MetricJob job = columns.job({0});
    expect_near(sums_of(GetParam(), job), expected_sums(job), kRounding);
  }
}

// One cell at a time, so that no term hides behind a larger one.
TEST_P(MetricSumsOf, ASingleCellFollowTheDefinitionsAtEveryMagnitude) {
  Random random(2);
  const Columns columns(random);
  for (std::size_t k = 0; k < kCount; ++k) {
    MetricJob job = columns.job({0});
    job.sides[0].begin = k;
    job.sides[0].end = k + 1;
    SCOPED_TRACE(k);
    // The square of a cube root is the eighth power of a root that is good to 3e-7, and so on.
    expect_near(sums_of(GetParam(), job), expected_sums(job), 5e-6);
  }
}

TEST_P(MetricSumsOf, TwoSidesAreThoseOfEach) {
  Random random(3);
  const Columns columns(random);
  MetricSums apart = sums_of(GetParam(), columns.job({0}));
  apart += sums_of(GetParam(), columns.job({1}));
  expect_near(sums_of(GetParam(), columns.job({0, 1})), apart, kRounding);
}

TEST_P(MetricSumsOf, AReversedSideAreThoseOfItsCopy) {
  Random random(4);
  const Columns columns(random);
  MetricJob job = columns.job({0});
  std::array<std::vector<float>, 3> reversed = columns.r[0];
  for (std::size_t c = 0; c < 3; ++c) {
    std::ranges::reverse(reversed[c]);
    job.sides[0].r[c] = reversed[c].data() + kCount - 1;
  }
  job.sides[0].step = -1;
  const MetricSums actual = sums_of(GetParam(), job);
  const MetricSums expected = sums_of(GetParam(), columns.job({0}));
  EXPECT_EQ(actual.log_ratio, expected.log_ratio);
  EXPECT_EQ(actual.srgb, expected.srgb);
  EXPECT_EQ(actual.weight, expected.weight);
}

TEST_P(MetricSumsOf, EntriesThatAreLeftOutDoNotChange) {
  Random random(5);
  Columns columns(random);
  MetricJob job = columns.job({0});
  job.sides[0].begin = 5;
  job.sides[0].end = kCount - 9;
  const MetricSums before = sums_of(GetParam(), job);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < kCount; ++k) {
      if (k >= 5 && k < kCount - 9 && columns.r[0][c][k] >= 0.0F) continue;
      columns.f[c][k] = 1e6;
      columns.r[0][c][k] = columns.r[0][c][k] < 0.0F ? -1e38F : 3e38F;
    }
  }
  const MetricSums after = sums_of(GetParam(), job);
  EXPECT_EQ(before.relative, after.relative);
  EXPECT_EQ(before.cosine_l2, after.cosine_l2);
  EXPECT_EQ(before.weight, after.weight);
}

TEST_P(MetricSumsOf, EqualValuesAreZero) {
  Random random(6);
  Columns columns(random);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < kCount; ++k) columns.f[c][k] = std::max(columns.r[0][c][k], 0.0F);
  }
  const MetricSums sums = sums_of(GetParam(), columns.job({0}));
  for (const double sum :
       {sums.log_ratio, sums.relative, sums.cube_root, sums.srgb, sums.cosine_l2, sums.clipped}) {
    EXPECT_EQ(sum, 0.0);
  }
}

// Ratios are multiplied before their logarithm is taken.
TEST_P(MetricSumsOf, HugeRatiosHaveFiniteLogarithms) {
  Random random(8);
  Columns columns(random);
  for (std::size_t c = 0; c < 3; ++c) {
    std::ranges::fill(columns.f[c], 1e13 * static_cast<double>(c + 1));
    std::ranges::fill(columns.r[0][c], 0.0F);
  }
  const MetricJob job = columns.job({0});
  const double expected = expected_sums(job).log_ratio;
  EXPECT_NEAR(sums_of(GetParam(), job).log_ratio, expected, kRounding * expected);
}

TEST_P(MetricSumsOf, OrdersAreTheirLogRatio) {
  Random random(7);
  const Columns columns(random);
  const MetricJob job = columns.job({0, 1});
  double expected = 0.0;
  for (const MetricSide& side : job.sides) {
    for (std::size_t k = 0; k < kCount; ++k) {
      if (side.r[0][k] < 0.0F) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        expected += side.weight[k] * std::abs(std::log((job.f[c][k] * side.cos_i[k] + 1e-3) /
                                                       (job.f_swapped[c][k] * side.cos_i[k] + 1e-3)));
      }
    }
  }
  EXPECT_NEAR(order_gap_function(GetParam())(job), expected, kRounding * expected);
}

std::string isa_name(const testing::TestParamInfo<simd::Isa>& isa) {
  return std::string(simd::name_of(isa.param));
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, MetricSumsOf,
                         testing::ValuesIn(simd::available_isas().begin(), simd::available_isas().end()),
                         isa_name);

}  // namespace
}  // namespace brdfit::fit
