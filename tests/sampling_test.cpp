// Observations of a table: weights, strata, both orders of a cell, limits.
#include "measured/sampling.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <tuple>
#include <vector>

#include "brdf/kernel/math.h"
#include "measured/slice.h"

namespace brdfit {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr Grid kSmall = {15, 15, 30, CellAnchor::kLowerEdge};

double cos_i_of(const HalfDiff& a) {
  return directions_from_half_diff(a).wi.z;
}
double cos_o_of(const HalfDiff& a) {
  return directions_from_half_diff(a).wo.z;
}

// A table whose cells hold a function of their angles, three times; -1 below the horizon.
MeasuredTable table_of(const Grid& grid, const std::function<double(std::size_t, const HalfDiff&)>& f) {
  std::vector<float> planes(3 * grid.cell_count());
  for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
    const HalfDiff angles = grid.angles_of(cell);
    const bool above = cos_i_of(angles) > 1e-9 && cos_o_of(angles) > 1e-9;
    for (std::size_t c = 0; c < 3; ++c) {
      planes[c * grid.cell_count() + cell] =
          above ? static_cast<float>(f(cell, angles) * (1.0 + static_cast<double>(c))) : -1.0F;
    }
  }
  return MeasuredTable(grid, planes);
}

// Cells hold their own number, so that samples tell where they come from (exact in a float up to 2^24).
MeasuredTable numbered_table(const Grid& grid) {
  return table_of(grid, [](std::size_t cell, const HalfDiff&) { return static_cast<double>(cell); });
}

std::vector<std::size_t> cells_of(const SampleSet& samples) {
  std::vector<std::size_t> cells;
  for (std::size_t k = 0; k < samples.size(); ++k) cells.push_back(static_cast<std::size_t>(samples.f(0)[k]));
  return cells;
}

double sum(std::span<const double> x) {
  return std::accumulate(x.begin(), x.end(), 0.0);
}

TEST(CellGeometry, IsThatOfTheDirections) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int k = 0; k < 1000; ++k) {
    const HalfDiff angles = {share(random) * 90 * kDegree, share(random) * 90 * kDegree,
                             share(random) * 180 * kDegree};
    const CellGeometry g = cell_geometry(angles);
    EXPECT_NEAR(g.cos_i, cos_i_of(angles), 1e-15);
    EXPECT_NEAR(g.cos_o, cos_o_of(angles), 1e-15);
    EXPECT_DOUBLE_EQ(g.sin_h, std::sin(angles.theta_h_rad));
    EXPECT_DOUBLE_EQ(g.cos_h, std::cos(angles.theta_h_rad));
    EXPECT_DOUBLE_EQ(g.cos_d, std::cos(angles.theta_d_rad));
    EXPECT_NEAR(g.one_minus_cos_h, 1 - std::cos(angles.theta_h_rad), 1e-15);
    EXPECT_NEAR(g.one_minus_cos_d, 1 - std::cos(angles.theta_d_rad), 1e-15);
  }
}

// Where 1 - cos would have no digits left.
TEST(CellGeometry, KeepsSmallAngles) {
  const CellGeometry g = cell_geometry({1e-9, 1e-7, 0.0});
  EXPECT_DOUBLE_EQ(g.one_minus_cos_h, 0.5e-18);
  EXPECT_NEAR(g.one_minus_cos_d, 0.5e-14, 1e-28);
}

TEST(SampleSet, ScalesWeightsToASumOfOneAndPadsWithNone) {
  SampleSet samples;
  for (int k = 0; k < 70; ++k) {
    samples.add(cell_geometry({0.01 * k, 0.3, 1.0}), {1.0, 2.0, 3.0}, 1.0 + k);
  }
  samples.finish();
  EXPECT_EQ(samples.size(), 70U);
  EXPECT_EQ(samples.padded_size(), 128U);
  EXPECT_NEAR(sum(samples.weight()), 1.0, 1e-14);
  EXPECT_NEAR(samples.weight()[9] / samples.weight()[0], 10.0, 1e-12);
  for (std::size_t k = 70; k < 128; ++k) EXPECT_EQ(samples.weight()[k], 0.0);
}

TEST(SampleSet, PaddingIsGeometryThatEveryModelCanEvaluate) {
  SampleSet samples;
  samples.add(cell_geometry({0.5, 0.3, 1.0}), {1.0, 2.0, 3.0}, 1.0);
  samples.finish();
  const simd::GeometryColumns g = samples.geometry();
  for (std::size_t k = 0; k < samples.padded_size(); ++k) {
    EXPECT_GT(g.cos_i[k], 0.0);
    EXPECT_GT(g.cos_o[k], 0.0);
    for (const double* column : {g.log_cos_h, g.log_cos_d, g.log_one_minus_cos_h, g.log_one_minus_cos_d}) {
      EXPECT_TRUE(std::isfinite(column[k]));
    }
  }
}

TEST(SampleSet, HoldsLogarithmsOfItsColumns) {
  const SampleSet samples = sample_table(numbered_table(kSmall), kAllSamples, 1, {});
  const simd::GeometryColumns g = samples.geometry();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    EXPECT_EQ(g.log_cos_h[k], kernel::log_or_zero(g.cos_h[k]));
    EXPECT_EQ(g.log_cos_d[k], kernel::log_or_zero(g.cos_d[k]));
    EXPECT_EQ(g.log_one_minus_cos_h[k], kernel::log_or_zero(g.one_minus_cos_h[k]));
    EXPECT_EQ(g.log_one_minus_cos_d[k], kernel::log_or_zero(g.one_minus_cos_d[k]));
  }
}

TEST(SampleSet, ThinnedKeepsEveryStridethObservation) {
  const SampleSet samples = sample_table(numbered_table(kSmall), 100, 1, {90.0});
  for (const std::size_t stride : {1, 3, 7, 99, 1000}) {
    const SampleSet thinned = samples.thinned(stride);
    ASSERT_EQ(thinned.size(), (samples.size() + stride - 1) / stride);
    EXPECT_NEAR(sum(thinned.weight()), 1.0, 1e-14);
    for (std::size_t k = 0; k < thinned.size(); ++k) {
      EXPECT_EQ(thinned.f(2)[k], samples.f(2)[k * stride]);
      EXPECT_EQ(thinned.cos_i()[k], samples.cos_i()[k * stride]);
      EXPECT_NEAR(thinned.weight()[k] / thinned.weight()[0],
                  samples.weight()[k * stride] / samples.weight()[0], 1e-12);
    }
  }
}

TEST(TableSample, OfEverythingHoldsEveryValidCellOnceWithOneWeight) {
  const MeasuredTable table = numbered_table(kSmall);
  for (const std::size_t count : {kAllSamples, table.valid_count(), table.valid_count() + 1}) {
    const SampleSet samples = sample_table(table, count, 1, {90.0});
    std::vector<std::size_t> cells = cells_of(samples);
    std::ranges::sort(cells);
    std::vector<std::size_t> expected;
    for (std::size_t cell = 0; cell < kSmall.cell_count(); ++cell) {
      if (table.is_valid(cell)) expected.push_back(cell);
    }
    EXPECT_EQ(cells, expected);
    EXPECT_NEAR(sum(samples.weight()), 1.0, 1e-12);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      EXPECT_NEAR(samples.weight()[k] * static_cast<double>(samples.size()), 1.0, 1e-10);
    }
  }
}

TEST(TableSample, HoldsTheGeometryAndTheValueOfItsCell) {
  const MeasuredTable table = numbered_table(kSmall);
  const SampleSet samples = sample_table(table, 500, 3, {90.0});
  ASSERT_EQ(samples.size(), 500U);
  const std::vector<std::size_t> cells = cells_of(samples);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const HalfDiff angles = kSmall.angles_of(cells[k]);
    EXPECT_NEAR(samples.cos_i()[k], cos_i_of(angles), 1e-14);
    EXPECT_NEAR(samples.cos_o()[k], cos_o_of(angles), 1e-14);
    EXPECT_NEAR(samples.cos_h()[k], std::cos(angles.theta_h_rad), 1e-15);
    EXPECT_NEAR(samples.cos_d()[k], std::cos(angles.theta_d_rad), 1e-15);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(samples.f(c)[k], table.value(cells[k])[static_cast<std::size_t>(c)]);
    }
  }
}

TEST(TableSample, DrawsNoCellTwiceAndHasTheCountThatIsAskedFor) {
  for (const std::size_t count : {1, 2, 10, 777, 3000}) {
    const SampleSet samples = sample_table(numbered_table(kSmall), count, 5, {90.0});
    std::vector<std::size_t> cells = cells_of(samples);
    EXPECT_EQ(cells.size(), count);
    std::ranges::sort(cells);
    EXPECT_EQ(std::ranges::adjacent_find(cells), cells.end());
    EXPECT_NEAR(sum(samples.weight()), 1.0, 1e-12);
  }
}

// "each with the same weight": strata have equal sizes, as far as whole cells allow.
TEST(TableSample, WeighsCellsAlike) {
  const MeasuredTable table = numbered_table(kSmall);
  const SampleSet samples = sample_table(table, 400, 5, {90.0});
  const double cells = static_cast<double>(table.valid_count());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double stratum = samples.weight()[k] * cells;
    EXPECT_NEAR(stratum, std::round(stratum), 1e-9);
    EXPECT_NEAR(stratum, cells / 400.0, 1.0);
  }
}

TEST(TableSample, DependsOnTheSeedAlone) {
  const MeasuredTable table = numbered_table(kSmall);
  const auto cells = [&](std::uint64_t seed) { return cells_of(sample_table(table, 300, seed, {})); };
  EXPECT_EQ(cells(4), cells(4));
  EXPECT_NE(cells(4), cells(5));
}

// The mean of a smooth function over strata is closer to that over the table than over cells drawn freely. A
// ratio of two equal variances of 60 draws each is below 1/2.7 in one case of 10^4.
TEST(TableSample, OfStrataConvergesFasterThanRandomDraws) {
  const MeasuredTable table =
      table_of({45, 45, 90, CellAnchor::kLowerEdge}, [](std::size_t, const HalfDiff& a) {
        return 1.0 + std::sin(a.theta_h_rad) * std::cos(a.theta_d_rad) + 0.5 * std::cos(2 * a.phi_d_rad);
      });
  const auto mean = [](const SampleSet& s) {
    return std::inner_product(s.weight().begin(), s.weight().end(), s.f(0).begin(), 0.0);
  };
  const SampleSet all = sample_table(table, kAllSamples, 1, {90.0});
  constexpr std::size_t kCount = 1000;
  double stratified = 0.0;
  double free = 0.0;
  std::mt19937_64 random(9);
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    stratified += std::pow(mean(sample_table(table, kCount, seed, {90.0})) - mean(all), 2);
    double drawn = 0.0;
    for (std::size_t k = 0; k < kCount; ++k) drawn += all.f(0)[random() % all.size()] / kCount;
    free += std::pow(drawn - mean(all), 2);
  }
  EXPECT_LT(stratified, free / 2.7);
}

// The square-root rows near the peak get their share of cells.
TEST(TableSample, ResolvesThePeak) {
  const MeasuredTable table = numbered_table({});
  const SampleSet samples = sample_table(table, 5000, 1, {90.0});
  std::size_t within_a_degree = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    within_a_degree += samples.cos_h()[k] > std::cos(kDegree) ? 1 : 0;
  }
  std::size_t stored = 0;
  for (std::size_t cell = 0; cell < table.grid().cell_count(); ++cell) {
    const HalfDiff a = table.grid().angles_of(cell);
    stored += table.is_valid(cell) && a.theta_h_rad < kDegree ? 1 : 0;
  }
  const double share = static_cast<double>(stored) / static_cast<double>(table.valid_count());
  EXPECT_NEAR(static_cast<double>(within_a_degree) / 5000.0, share, 0.1 * share);
}

TEST(TableSample, LeavesInvalidCellsOut) {
  const MeasuredTable whole = numbered_table(kSmall);
  std::vector<float> planes;
  for (int c = 0; c < 3; ++c) planes.insert(planes.end(), whole.plane(c).begin(), whole.plane(c).end());
  for (std::size_t cell = 0; cell < kSmall.cell_count(); cell += 2) planes[cell] = -1.0F;
  const MeasuredTable table(kSmall, planes);
  const SampleSet samples = sample_table(table, kAllSamples, 1, {90.0});
  EXPECT_EQ(samples.size(), table.valid_count());
  for (const std::size_t cell : cells_of(samples)) EXPECT_EQ(cell % 2, 1U);
}

// A table may call cells at or below the horizon valid (real files do): models are 0 there.
TEST(TableSample, LeavesCellsBelowTheHorizonOut) {
  const MeasuredTable table(kSmall, std::vector<float>(3 * kSmall.cell_count(), 0.5F));
  const SampleSet samples = sample_table(table, kAllSamples, 1, {});
  ASSERT_GT(samples.size(), 0U);
  EXPECT_GT(std::ranges::min(samples.cos_i()), 0.0);
  EXPECT_GT(std::ranges::min(samples.cos_o()), 0.0);
}

TEST(TableSample, RespectsMaxThetaInBothDirections) {
  const MeasuredTable table = numbered_table(kSmall);
  for (const double max_theta : {10.0, 45.0, 80.0}) {
    const SampleSet samples = sample_table(table, kAllSamples, 1, {max_theta});
    std::vector<std::size_t> cells = cells_of(samples);
    std::ranges::sort(cells);
    std::vector<std::size_t> expected;
    for (std::size_t cell = 0; cell < kSmall.cell_count(); ++cell) {
      const HalfDiff a = kSmall.angles_of(cell);
      const double lowest = std::cos(max_theta * kDegree) - 1e-9;
      if (table.is_valid(cell) && std::min(cos_i_of(a), cos_o_of(a)) >= lowest) expected.push_back(cell);
    }
    EXPECT_EQ(cells, expected) << max_theta;
  }
}

TEST(TableSample, IsEmptyWhereNothingIsObserved) {
  const MeasuredTable nothing(kSmall, std::vector<float>(3 * kSmall.cell_count(), -1.0F));
  EXPECT_EQ(sample_table(nothing, 100, 1, {}).size(), 0U);
  EXPECT_EQ(sample_table(nothing, kAllSamples, 1, {}).size(), 0U);
}

TEST(TwoOrders, AreToldApartOnlyWhereCosinesDiffer) {
  const MeasuredTable table = numbered_table(kSmall);
  EXPECT_TRUE(sample_table(table, 500, 2, {}).has_two_orders());
  const std::vector<double> symmetric = {90.0};
  EXPECT_FALSE(sample_slices(table, symmetric, {}).has_two_orders());
  const std::vector<double> skew = {45.0};
  EXPECT_TRUE(sample_slices(table, skew, {}).has_two_orders());
}

// Rows of a slice that is linear in theta_h: half their width, half the pixels that show them.
TEST(SliceSample, WeighsRowsByWidthAndByPixels) {
  const Grid grid;
  const MeasuredTable table(grid, std::vector<float>(3 * grid.cell_count(), 0.5F));
  const std::vector<double> phi_d = {90.0};
  const SampleSet samples = sample_slices(table, phi_d, {90.0});
  // Of theta_d = 0, whose cells are above the horizon in every row.
  std::vector<double> by_row;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (samples.cos_d()[k] == 1.0) by_row.push_back(samples.weight()[k]);
  }
  std::map<int, double> pixels;
  for (const SlicePixel& pixel : make_slice(table).pixels) {
    if (pixel.row == 0) pixels[pixel.i_theta_h] += 1.0;
  }
  ASSERT_EQ(by_row.size(), 90U);
  const double total = sum(by_row);
  EXPECT_GT(by_row[0], 0.0);
  for (int i = 0; i < 90; ++i) {
    const double width = (grid.theta_h_rad(1) * (std::pow(i + 1, 2) - std::pow(i, 2))) / (90 * kDegree);
    EXPECT_NEAR(by_row[static_cast<std::size_t>(i)] / total, 0.5 * width + 0.5 * pixels[i] / 90.0, 1e-12)
        << i;
  }
}

TEST(SliceSample, HoldsTheValidCellsOfItsSlicesAlone) {
  const MeasuredTable table = numbered_table(kSmall);
  const std::vector<double> phi_d = {0.0, 45.0, 90.0};
  const SampleSet samples = sample_slices(table, phi_d, {90.0});
  std::vector<std::size_t> cells = cells_of(samples);
  std::ranges::sort(cells);
  std::vector<std::size_t> expected;
  for (std::size_t cell = 0; cell < kSmall.cell_count(); ++cell) {
    const int i_p = static_cast<int>(cell % 30);
    // 6 deg a cell: 0, 45 -> 42, 90.
    if (table.is_valid(cell) && (i_p == 0 || i_p == 7 || i_p == 15)) expected.push_back(cell);
  }
  EXPECT_EQ(cells, expected);
  EXPECT_NEAR(sum(samples.weight()), 1.0, 1e-12);
}

TEST(SliceSample, RespectsMaxTheta) {
  const std::vector<double> phi_d = {60.0};
  const SampleSet samples = sample_slices(numbered_table(kSmall), phi_d, {50.0});
  ASSERT_GT(samples.size(), 0U);
  const double lowest = std::cos(50.0 * kDegree) - 1e-9;
  EXPECT_GE(std::ranges::min(samples.cos_i().first(samples.size())), lowest);
  EXPECT_GE(std::ranges::min(samples.cos_o().first(samples.size())), lowest);
}

// At phi_d = 90 deg the cosines are equal: one observation says all.
TEST(SliceSample, At90DegreesIsReciprocal) {
  const std::vector<double> phi_d = {90.0};
  const MeasuredTable table = numbered_table(kSmall);
  EXPECT_EQ(sample_slices(table, phi_d, {90.0}).size(), sample_slices(table, phi_d, {90.0}).size());
}

}  // namespace
}  // namespace brdfit
