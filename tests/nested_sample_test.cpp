// Growing samples: each within the next, fair to every cell, and blind to those of the check.
#include "measured/nested_sample.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "tests/fit_data.h"

namespace brdfit {
namespace {

using testing_support::kSmallGrid;

// Every cell valid, and most of them above the horizon.
MeasuredTable uniform_table(const Grid& grid = kSmallGrid) {
  return MeasuredTable(grid, std::vector<float>(3 * grid.cell_count(), 0.5F));
}

NestedSample::Options options_of(std::uint64_t seed, std::size_t least = 500, std::size_t check = 400) {
  return {least, check, seed, {}};
}

std::set<std::size_t> cells_of(const NestedSample& sample) {
  std::vector<std::size_t> cells;
  sample.samples(&cells);
  return {cells.begin(), cells.end()};
}

std::set<std::size_t> check_cells_of(const NestedSample& sample) {
  std::vector<std::size_t> cells;
  sample.check(&cells);
  return {cells.begin(), cells.end()};
}

std::set<std::size_t> observed_cells(const MeasuredTable& table) {
  std::vector<std::size_t> cells;
  sample_table(table, kAllSamples, 1, {}, &cells);
  return {cells.begin(), cells.end()};
}

TEST(NestedSample, HoldsTheSmallerOne) {
  const MeasuredTable table = uniform_table();
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    NestedSample sample(table, options_of(seed));
    std::set<std::size_t> before = cells_of(sample);
    while (sample.grow()) {
      const std::set<std::size_t> after = cells_of(sample);
      EXPECT_TRUE(std::ranges::includes(after, before));
      before = after;
    }
  }
}

TEST(NestedSample, NeverHoldsACellOfTheCheckNorOneTwice) {
  const MeasuredTable table = uniform_table();
  NestedSample sample(table, options_of(5));
  const std::set<std::size_t> check = check_cells_of(sample);
  do {
    std::vector<std::size_t> cells;
    EXPECT_EQ(sample.samples(&cells).size(), sample.size());
    for (const std::size_t cell : cells) EXPECT_FALSE(check.contains(cell));
    EXPECT_EQ(std::set(cells.begin(), cells.end()).size(), cells.size());
    EXPECT_EQ(check_cells_of(sample), check);
  } while (sample.grow());
}

TEST(NestedSample, GrowsToEveryObservedCellThatIsNotChecked) {
  const MeasuredTable table = uniform_table();
  NestedSample sample(table, options_of(7));
  while (sample.grow()) {
  }
  std::set<std::size_t> all = cells_of(sample);
  all.merge(check_cells_of(sample));
  EXPECT_EQ(all, observed_cells(table));
}

TEST(NestedSample, IsAboutAsLargeAsAskedForAndDoubles) {
  const MeasuredTable table = uniform_table();
  NestedSample sample(table, options_of(1));
  EXPECT_NEAR(static_cast<double>(check_cells_of(sample).size()), 400.0, 120.0);
  double before = static_cast<double>(sample.size());
  EXPECT_NEAR(before, 500.0, 150.0);
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(sample.grow());
    const auto now = static_cast<double>(sample.size());
    EXPECT_NEAR(now / before, 2.0, 0.15);
    before = now;
  }
}

// The weighted sum over draws is that over observed cells in the mean over seeds, at every size: no cell is
// favoured. The mean over 400 seeds is within five standard errors.
TEST(NestedSample, IsFairAtEverySize) {
  const MeasuredTable table = uniform_table({10, 12, 24, CellAnchor::kLowerEdge});
  const std::set<std::size_t> observed = observed_cells(table);
  constexpr int kSeeds = 400;
  const auto f = [&](std::size_t cell) { return std::sin(0.01 * static_cast<double>(cell)) + 1.5; };
  for (int growths = 0; growths < 3; ++growths) {
    std::vector<double> means;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      NestedSample sample(table, options_of(seed, 40, 0));
      for (int k = 0; k < growths; ++k) sample.grow();
      std::vector<std::size_t> cells;
      const SampleSet samples = sample.samples(&cells);
      double mean = 0.0;
      for (std::size_t k = 0; k < cells.size(); ++k) mean += samples.weight()[k] * f(cells[k]);
      means.push_back(mean);
    }
    double expected = 0.0;
    for (const std::size_t cell : observed) expected += f(cell) / static_cast<double>(observed.size());
    const double mean = std::accumulate(means.begin(), means.end(), 0.0) / kSeeds;
    double variance = 0.0;
    for (const double m : means) variance += (m - mean) * (m - mean) / (kSeeds - 1);
    // A ratio of sums is biased by a share of 1 / size, hence the second term.
    EXPECT_NEAR(mean, expected, 5.0 * std::sqrt(variance / kSeeds) + 0.002);
    EXPECT_GT(variance, 0.0);
  }
}

TEST(NestedSample, LeavesOutWhatIsInvalidOrTooFarFromTheNormal) {
  const MeasuredTable whole = uniform_table();
  std::vector<float> planes;
  for (int c = 0; c < 3; ++c) planes.insert(planes.end(), whole.plane(c).begin(), whole.plane(c).end());
  for (std::size_t k = 0; k < planes.size(); k += 2) planes[k] = -1.0F;
  const MeasuredTable table(kSmallGrid, planes);
  NestedSample::Options options = options_of(3);
  options.sampling.max_theta_deg = 60.0;
  NestedSample sample(table, options);
  std::vector<std::size_t> allowed;
  sample_table(table, kAllSamples, 1, options.sampling, &allowed);
  std::ranges::sort(allowed);
  do {
    EXPECT_GE(sample.size(), options.least / 2);
    for (const std::size_t cell : cells_of(sample)) {
      EXPECT_TRUE(std::ranges::binary_search(allowed, cell));
    }
  } while (sample.grow());
}

TEST(NestedSample, OfATableWithNothingToObserveIsEmpty) {
  const MeasuredTable nothing(kSmallGrid, std::vector<float>(3 * kSmallGrid.cell_count(), -1.0F));
  const NestedSample sample(nothing, options_of(1));
  EXPECT_EQ(sample.size(), 0U);
  EXPECT_EQ(sample.samples().size(), 0U);
  EXPECT_EQ(sample.check().size(), 0U);
}

TEST(NestedSample, HoldsTheValuesOfItsCellsAndDependsOnItsSeed) {
  const MeasuredTable table = testing_support::table_of(
      testing_support::random_full_material(Model::kBurley, effects_of(Model::kBurley), 3));
  const NestedSample sample(table, options_of(1));
  std::vector<std::size_t> cells;
  const SampleSet samples = sample.samples(&cells);
  for (std::size_t k = 0; k < cells.size(); ++k) {
    EXPECT_EQ(samples.f(1)[k], table.value(cells[k])[1]);
    EXPECT_NEAR(samples.cos_h()[k], std::cos(table.grid().angles_of(cells[k]).theta_h_rad), 1e-14);
  }
  EXPECT_EQ(cells_of(sample), cells_of(NestedSample(table, options_of(1))));
  EXPECT_NE(cells_of(sample), cells_of(NestedSample(table, options_of(2))));
}

}  // namespace
}  // namespace brdfit
