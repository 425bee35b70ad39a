// The size of a sample: the rule, and that nothing of a fit sees the cells that it goes by.
#include "fit/sample_size.h"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

#include "fit/fit.h"
#include "fit/log_ratio.h"
#include "measured/nested_sample.h"
#include "tests/fit_data.h"

namespace brdfit::fit {
namespace {

using testing_support::kSmallGrid;

// A Callisto material with every effect is more than the other models can be: their fits have an error that
// samples can change.
MeasuredTable rich_table(std::uint64_t seed = 3) {
  return testing_support::table_of(
      testing_support::random_full_material(Model::kCallisto, effects_of(Model::kCallisto), seed));
}

FitOptions automatic(Model model = Model::kLambertGgx) {
  FitOptions options;
  options.model = model;
  options.choose_samples = true;
  return options;
}

Material of_roughness(double roughness) {
  Material material(Model::kLambertGgx);
  material.set("roughness", roughness);
  return material;
}

TEST(SizeChoice, IsMadeWhenNothingChanges) {
  SizeChoice choice(sample_table(rich_table(), 500, 1, {}));
  EXPECT_FALSE(choice.add(100, of_roughness(0.3)));
  EXPECT_TRUE(choice.add(200, of_roughness(0.3)));
  const SampleSize& outcome = choice.outcome();
  EXPECT_TRUE(outcome.converged);
  EXPECT_EQ(outcome.check_cells, 500U);
  ASSERT_EQ(outcome.trials.size(), 2U);
  EXPECT_EQ(outcome.trials[1].change_pct, 0.0);
  EXPECT_EQ(outcome.trials[1].standard_error_pct, 0.0);
}

TEST(SizeChoice, HoldsTheErrorsOnTheCheckCellsAndTheirChange) {
  const SampleSet check = sample_table(rich_table(), 500, 1, {});
  SizeChoice choice(check);
  choice.add(100, of_roughness(0.3));
  EXPECT_FALSE(choice.add(200, of_roughness(0.6)));
  const std::vector<SizeTrial>& trials = choice.outcome().trials;
  EXPECT_EQ(trials[0].held_out_pct, log_ratio_pct(of_roughness(0.3), check));
  EXPECT_EQ(trials[1].held_out_pct, log_ratio_pct(of_roughness(0.6), check));
  EXPECT_DOUBLE_EQ(trials[1].change_pct, trials[1].held_out_pct - trials[0].held_out_pct);
  EXPECT_FALSE(choice.outcome().converged);
}

// The change alone would be below the threshold, but it is not known well enough to say so.
TEST(SizeChoice, WaitsWhereTheChangeIsUncertain) {
  const SampleSet check = sample_table(rich_table(), 60, 1, {});
  SizeChoice trial(check, 0.0);
  trial.add(100, of_roughness(0.30));
  trial.add(200, of_roughness(0.33));
  const SizeTrial& change = trial.outcome().trials[1];
  ASSERT_GT(change.standard_error_pct, kLeastSizeChange);
  const double between =
      (std::abs(change.change_pct) + 0.5 * change.standard_error_pct) / change.held_out_pct;
  const double beyond = (std::abs(change.change_pct) + 1.5 * change.standard_error_pct) / change.held_out_pct;
  for (const auto& [threshold, is_enough] : {std::pair(between, false), std::pair(beyond, true)}) {
    SizeChoice choice(check, threshold);
    choice.add(100, of_roughness(0.30));
    EXPECT_EQ(choice.add(200, of_roughness(0.33)), is_enough);
  }
}

// The change measured on many sets of cells that are drawn freely scatters as it says, within a fifth (three
// standard errors of a standard deviation from 150 sets).
TEST(SizeChoice, KnowsHowUncertainItsChangeIs) {
  const SampleSet all = sample_table(rich_table(), kAllSamples, 1, {});
  std::mt19937_64 random(3);
  std::vector<double> changes;
  double said = 0.0;
  constexpr std::size_t kSets = 150;
  for (std::size_t set = 0; set < kSets; ++set) {
    std::vector<std::size_t> indices;
    for (std::size_t k = 0; k < 200; ++k) indices.push_back(random() % all.size());
    SizeChoice choice(all.subset(indices));
    choice.add(1, of_roughness(0.3));
    choice.add(2, of_roughness(0.5));
    changes.push_back(choice.outcome().trials[1].change_pct);
    said += choice.outcome().trials[1].standard_error_pct / kSets;
  }
  double mean = 0.0;
  double variance = 0.0;
  for (const double change : changes) mean += change / kSets;
  for (const double change : changes) variance += (change - mean) * (change - mean) / (kSets - 1);
  EXPECT_NEAR(said / std::sqrt(variance), 1.0, 0.2);
}

TEST(FitOfChosenSize, StatesWhatItTriedAndKeepsTheLast) {
  for (const Model model : all_models()) {
    const FitResult result = fit(rich_table(), automatic(model));
    ASSERT_TRUE(result.sample_size.has_value());
    const SampleSize& size = *result.sample_size;
    ASSERT_GE(size.trials.size(), 2U);
    EXPECT_TRUE(size.converged);
    EXPECT_EQ(result.observations, size.trials.back().samples);
    for (std::size_t k = 1; k < size.trials.size(); ++k) {
      const SizeTrial& trial = size.trials[k];
      EXPECT_NEAR(static_cast<double>(trial.samples) / static_cast<double>(size.trials[k - 1].samples), 2.0,
                  0.2);
      const double bound = std::max(size.threshold * trial.held_out_pct, kLeastSizeChange);
      EXPECT_EQ(std::abs(trial.change_pct) + trial.standard_error_pct <= bound, k + 1 == size.trials.size());
    }
  }
}

// The whole point: the error on the table is that of a fit to all of its cells, within a little more than the
// threshold (what is left beyond the last doubling, and a sampling error of the same size).
TEST(FitOfChosenSize, IsAsGoodAsAFitToEveryCell) {
  for (const std::uint64_t seed : {3U, 4U, 5U, 6U}) {
    for (const Model model : {Model::kLambertGgx, Model::kBurley}) {
      const MeasuredTable table = rich_table(seed);
      FitOptions all = automatic(model);
      all.choose_samples = false;
      all.samples = kAllSamples;
      const double best = fit(table, all).evaluation.table.log_ratio_pct;
      const FitResult result = fit(table, automatic(model));
      EXPECT_LT(result.evaluation.table.log_ratio_pct,
                (1.0 + 2.0 * kSizeThreshold) * best + kLeastSizeChange);
      EXPECT_LT(result.observations, table.valid_count());
    }
  }
}

// Other values in the cells of the check, and a rule that always stops at the second size: the same fit.
TEST(FitOfChosenSize, NeverSeesTheCellsThatItGoesBy) {
  const MeasuredTable table = rich_table();
  FitOptions options = automatic(Model::kCallisto);
  options.choose_groups = true;
  options.sample_threshold = 1e9;
  const FitResult result = fit(table, options);
  ASSERT_EQ(result.sample_size->trials.size(), 2U);
  std::vector<std::size_t> check;
  const NestedSample nested(table, {1600, 4096, options.seed, {}});
  nested.check(&check);
  ASSERT_EQ(check.size(), result.sample_size->check_cells);
  std::vector<float> planes;
  for (int c = 0; c < 3; ++c) planes.insert(planes.end(), table.plane(c).begin(), table.plane(c).end());
  for (const std::size_t cell : check) planes[cell] *= 3.0F;
  const FitResult other = fit(MeasuredTable(kSmallGrid, planes), options);
  EXPECT_NE(other.sample_size->trials[0].held_out_pct, result.sample_size->trials[0].held_out_pct);
  EXPECT_EQ(other.groups, result.groups);
  EXPECT_EQ(other.cost, result.cost);
  EXPECT_TRUE(std::ranges::equal(other.material.values(), result.material.values()));
}

TEST(FitOfChosenSize, TakesEveryCellWhereNothingIsEnough) {
  FitOptions options = automatic();
  options.sample_threshold = 0.0;
  // 12,000 cells above the horizon, and noise by which each of them counts.
  synthetic::Recipe recipe = testing_support::recipe_of(
      testing_support::random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 3),
      {20, 20, 40, CellAnchor::kLowerEdge});
  recipe.noise.multiplicative = 0.5;
  const MeasuredTable table = synthetic::generate_table(recipe);
  const FitResult result = fit(table, options);
  ASSERT_TRUE(result.sample_size.has_value());
  EXPECT_FALSE(result.sample_size->converged);
  EXPECT_EQ(result.observations, sample_table(table, kAllSamples, 1, {}).size());
}

TEST(FitOfChosenSize, OfASmallTableTakesAllWithoutAChoice) {
  const MeasuredTable table =
      testing_support::table_of(of_roughness(0.3), {10, 10, 20, CellAnchor::kLowerEdge});
  ASSERT_LT(table.valid_count(), kLeastToChoose);
  const FitResult result = fit(table, automatic());
  EXPECT_FALSE(result.sample_size.has_value());
  EXPECT_EQ(result.observations, sample_table(table, kAllSamples, 1, {}).size());
}

TEST(FitOfChosenSize, OfSlicesTakesTheSlices) {
  FitOptions options = automatic();
  options.on = FitOn::kSlices;
  const FitResult result = fit(rich_table(), options);
  EXPECT_FALSE(result.sample_size.has_value());
}

TEST(FitOfChosenSize, DoesNotDependOnTheNumberOfThreads) {
  const MeasuredTable table = rich_table();
  const auto on_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return fit(table, automatic(Model::kCallisto));
  };
  const FitResult one = on_threads(1);
  const FitResult two = on_threads(2);
  EXPECT_TRUE(std::ranges::equal(one.material.values(), two.material.values()));
  EXPECT_EQ(one.observations, two.observations);
  EXPECT_EQ(one.sample_size->trials.back().change_pct, two.sample_size->trials.back().change_pct);
}

}  // namespace
}  // namespace brdfit::fit
