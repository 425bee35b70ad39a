// Nested evaluation: what is held out is out of the sight of everything.
#include "fit/held_out.h"

#include <gmock/gmock.h>

#include <cmath>

#include "measured/grid_geometry.h"
#include "tests/fit_data.h"

namespace brdfit::fit {
namespace {

using testing_support::kSmallGrid;

MeasuredTable small_table() {
  return testing_support::table_of(
      testing_support::random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 3));
}

FitOptions quick(int folds = 3) {
  FitOptions options;
  options.model = Model::kLambertGgx;
  options.samples = 1000;
  options.held_out_folds = folds;
  return options;
}

FitResult plain_fit(const MeasuredTable& table, const FitOptions& options) {
  return fit(table, options);
}

TEST(SplitTable, GivesEveryValidCellToOneSideAndToOneFold) {
  const MeasuredTable table = small_table();
  std::vector<int> held_out(table.grid().cell_count(), 0);
  for (int fold = 0; fold < 4; ++fold) {
    const SplitTable split = split_table(table, 4, fold, 9);
    EXPECT_GT(split.held_out.valid_count(), table.valid_count() / 8);
    for (std::size_t cell = 0; cell < held_out.size(); ++cell) {
      ASSERT_EQ(split.seen.is_valid(cell) || split.held_out.is_valid(cell), table.is_valid(cell));
      ASSERT_FALSE(split.seen.is_valid(cell) && split.held_out.is_valid(cell));
      if (split.held_out.is_valid(cell)) {
        ++held_out[cell];
        ASSERT_EQ(split.held_out.value(cell), table.value(cell));
      } else if (table.is_valid(cell)) {
        ASSERT_EQ(split.seen.value(cell), table.value(cell));
      }
    }
  }
  for (std::size_t cell = 0; cell < held_out.size(); ++cell) {
    EXPECT_EQ(held_out[cell], table.is_valid(cell) ? 1 : 0);
  }
}

// They hold one value twice.
TEST(SplitTable, KeepsACellAndItsMirrorImageTogether) {
  for (const CellAnchor anchor : {CellAnchor::kLowerEdge, CellAnchor::kCentre}) {
    const Grid grid = {12, 10, 36, anchor};
    const GridGeometry geometry(grid);
    const MeasuredTable table(grid, std::vector<float>(3 * grid.cell_count(), 0.5F));
    const SplitTable split = split_table(table, 5, 2, 1);
    for (int h = 0; h < grid.n_theta_h; ++h) {
      for (int d = 0; d < grid.n_theta_d; ++d) {
        for (int p = 0; p < grid.n_phi_d; ++p) {
          if (geometry.mirror(p) >= grid.n_phi_d) continue;
          EXPECT_EQ(split.held_out.is_valid(grid.index(h, d, p)),
                    split.held_out.is_valid(grid.index(h, d, geometry.mirror(p))));
        }
      }
    }
  }
}

TEST(HeldOut, FitsSeeNeitherTheBlockNorTheInitialMaterial) {
  const MeasuredTable table = small_table();
  FitOptions options = quick();
  options.init = Material(Model::kLambertGgx);
  std::vector<std::size_t> missing;
  evaluate_held_out(table, options, [&](const MeasuredTable& seen, const FitOptions& asked) {
    EXPECT_FALSE(asked.init.has_value());
    missing.push_back(table.valid_count() - seen.valid_count());
    return fit(seen, asked);
  });
  EXPECT_EQ(missing.size(), 3U);
  EXPECT_EQ(missing[0] + missing[1] + missing[2], table.valid_count());
}

TEST(HeldOut, ErrorsAreThoseOfEachFitOnWhatItDidNotSee) {
  const MeasuredTable table = small_table();
  std::vector<Material> fitted;
  std::vector<MeasuredTable> seen;
  const HeldOutEvaluation result =
      evaluate_held_out(table, quick(), [&](const MeasuredTable& part, const FitOptions& options) {
        FitResult one = fit(part, options);
        fitted.push_back(one.material);
        seen.push_back(part);
        return one;
      });
  ASSERT_EQ(result.folds.size(), 3U);
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<float> planes;
    for (int c = 0; c < 3; ++c) planes.insert(planes.end(), table.plane(c).begin(), table.plane(c).end());
    for (std::size_t cell = 0; cell < table.grid().cell_count(); ++cell) {
      for (std::size_t c = 0; seen[k].is_valid(cell) && c < 3; ++c) {
        planes[c * table.grid().cell_count() + cell] = -1.0F;
      }
    }
    const Evaluation expected = evaluate(fitted[k], MeasuredTable(table.grid(), planes));
    EXPECT_EQ(result.folds[k].evaluation.table.log_ratio_pct, expected.table.log_ratio_pct);
    EXPECT_EQ(result.folds[k].evaluation.table.cells, expected.table.cells);
    sum += expected.table.log_ratio_pct;
  }
  const MeanAndSpread mean = over_folds(result, &Evaluation::table, &Measures::log_ratio_pct);
  EXPECT_NEAR(mean.mean, sum / 3.0, 1e-12);
  EXPECT_GT(mean.deviation, 0.0);
}

// Where the model is that of the table, what was not seen is known as well as what was.
TEST(HeldOut, ErrorOfAnExactMaterialIsNearNothing) {
  Material material(Model::kLambertGgx);
  material.set("roughness", 0.3);
  const HeldOutEvaluation result = evaluate_held_out(testing_support::table_of(material), quick(), plain_fit);
  EXPECT_LT(over_folds(result, &Evaluation::table, &Measures::log_ratio_pct).mean, 1e-3);
}

TEST(HeldOut, EveryChoiceIsMadeAnewInEachFold) {
  FitOptions options = quick(2);
  options.model = Model::kCallisto;
  options.choose_groups = true;
  options.choose_samples = true;
  int chosen = 0;
  const HeldOutEvaluation result =
      evaluate_held_out(small_table(), options, [&](const MeasuredTable& seen, const FitOptions& asked) {
        EXPECT_TRUE(asked.choose_groups && asked.choose_samples);
        EXPECT_FALSE(asked.groups.has_value());
        FitResult one = fit(seen, asked);
        chosen += one.selection && one.sample_size ? 1 : 0;
        return one;
      });
  EXPECT_EQ(chosen, 2);
  for (const HeldOutFold& fold : result.folds) EXPECT_GT(fold.free_parameters, 0);
}

TEST(HeldOut, AFoldWithoutASliceDoesNotCountForIt) {
  HeldOutEvaluation held_out;
  held_out.folds.resize(3);
  held_out.folds[0].evaluation.slice = {.log_ratio_pct = 4.0, .cells = 10};
  held_out.folds[1].evaluation.slice = {.log_ratio_pct = 8.0, .cells = 20};
  const MeanAndSpread value = over_folds(held_out, &Evaluation::slice, &Measures::log_ratio_pct);
  EXPECT_DOUBLE_EQ(value.mean, 6.0);
  EXPECT_DOUBLE_EQ(value.deviation, std::sqrt(8.0));
}

TEST(HeldOut, RefusesTablesThatCannotBeSplit) {
  std::vector<float> planes(3 * kSmallGrid.cell_count(), -1.0F);
  for (std::size_t c = 0; c < 3; ++c) planes[c * kSmallGrid.cell_count()] = 0.5F;
  EXPECT_THROW(evaluate_held_out(MeasuredTable(kSmallGrid, planes), quick(), plain_fit),
               std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::fit
