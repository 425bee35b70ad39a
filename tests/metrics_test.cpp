// Error measures against their definitions, written out over single cells.
#include "fit/metrics.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "brdf/half_diff.h"
#include "brdf/models.h"
#include "tests/fit_data.h"

namespace brdfit::fit {
namespace {

using testing_support::kSmallGrid;
using testing_support::random_full_material;
using testing_support::table_of;

constexpr double kDegree = std::numbers::pi / 180.0;

double clip(double x) {
  return std::clamp(x, 0.0, 1.0);
}

double srgb(double linear) {
  const double x = clip(linear);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

// Sums over single cells and channels.
struct Sums {
  double log_ratio = 0, relative = 0, cube_root = 0, srgb = 0, cosine_l2 = 0, slice = 0;
  double n = 0, n_slice = 0;

  void add(const Rgb& f, const Rgb& r, double cos_i, bool below_80) {
    for (std::size_t c = 0; c < 3; ++c) {
      log_ratio += std::abs(std::log((f[c] * cos_i + 1e-3) / (r[c] * cos_i + 1e-3)));
      relative += std::abs(f[c] - r[c]) / (r[c] + 1e-3);
      cube_root += std::pow(std::cbrt(f[c] * cos_i) - std::cbrt(r[c] * cos_i), 2);
      srgb += std::pow(
          fit::srgb(std::numbers::pi * f[c] * cos_i) - fit::srgb(std::numbers::pi * r[c] * cos_i), 2);
      cosine_l2 += std::pow((f[c] - r[c]) * cos_i, 2);
      n += 1;
      if (!below_80) continue;
      slice += std::pow(clip(f[c]) - clip(r[c]), 2);
      n_slice += 1;
    }
  }
};

// f of a cell as a candidate has it.
using CellValue = std::function<Rgb(std::size_t cell, const DirectionPair&)>;

CellValue mean_of_orders(const Material& material) {
  return [material](std::size_t, const DirectionPair& pair) {
    const Rgb forth = eval(material, pair.wi, pair.wo);
    const Rgb back = eval(material, pair.wo, pair.wi);
    Rgb mean;
    for (std::size_t c = 0; c < 3; ++c) mean[c] = 0.5 * (forth[c] + back[c]);
    return mean;
  };
}

struct Expected {
  Sums slice;
  Sums table;
  std::size_t table_cells = 0;
};

void add_cell(Sums& sums, const CellValue& f, const MeasuredTable& reference, std::size_t cell, double lowest,
              bool below_80, std::size_t* count) {
  if (!reference.is_valid(cell)) return;
  const DirectionPair pair = directions_from_half_diff(reference.grid().angles_of(cell));
  if (std::min(pair.wi.z, pair.wo.z) < std::max(lowest, 1e-9)) return;
  sums.add(f(cell, pair), reference.value(cell), pair.wi.z, below_80);
  if (count != nullptr) ++*count;
}

// The definitions of the measures over cells of the table, and over the pixels of the slice.
Expected expected_sums(const CellValue& f, const MeasuredTable& reference, double max_theta_deg) {
  const Grid& grid = reference.grid();
  const double lowest = std::cos(max_theta_deg * kDegree) - 1e-12;
  const double end = 80.0 * kDegree - 1e-9;
  Expected expected;
  for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
    add_cell(expected.table, f, reference, cell, lowest, true, &expected.table_cells);
  }
  for (int row = 0; row < 90; ++row) {
    for (int column = 0; column < 90; ++column) {
      // In whole numbers: (i/n)^2 <= (column + 1/2) / 90.
      int i_h = 0;
      while (i_h + 1 < grid.n_theta_h &&
             180 * (i_h + 1) * (i_h + 1) <= (2 * column + 1) * grid.n_theta_h * grid.n_theta_h) {
        ++i_h;
      }
      const int i_d = (2 * row + 1) * grid.n_theta_d / 180;
      const std::size_t cell = grid.index(i_h, i_d, grid.n_phi_d / 2);
      const bool below_80 = (column + 0.5) * kDegree < end && (row + 0.5) * kDegree < end;
      add_cell(expected.slice, f, reference, cell, lowest, below_80, nullptr);
    }
  }
  return expected;
}

// tolerance: relative, of sums that are rounded.
void expect_measures(const Measures& actual, const Sums& s, double tolerance) {
  const auto near = [&](double value, double expected, const char* name) {
    EXPECT_NEAR(value, expected, tolerance * expected + 1e-15) << name;
  };
  near(actual.log_ratio_pct, 100 * s.log_ratio / s.n, "log-ratio");
  near(actual.relative, s.relative / s.n, "relative");
  near(actual.cube_root, std::sqrt(s.cube_root / s.n), "cube root");
  near(actual.srgb, std::sqrt(s.srgb / s.n), "sRGB");
  near(actual.cosine_l2, std::sqrt(s.cosine_l2 / s.n), "cosine L2");
  near(actual.slice_pct, 100 * std::sqrt(s.slice / s.n_slice), "slice");
}

// A table of one random material with noise and holes, looked at with another.
MeasuredTable rough_table(const Grid& grid) {
  synthetic::Recipe recipe = testing_support::recipe_of(
      random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 5), grid);
  recipe.noise = {0.3, 0.01};
  recipe.invalid.fraction = 0.2;
  recipe.invalid.blocks = 3;
  return synthetic::generate_table(recipe);
}

// Cells are compared in single precision, as they are stored: 6e-8 of each value.
constexpr double kRounding = 1e-6;

TEST(Evaluate, OfAMaterialFollowsTheDefinitions) {
  for (const Grid& grid :
       {kSmallGrid, Grid{90, 45, 36, CellAnchor::kLowerEdge}, Grid{31, 17, 44, CellAnchor::kCentre}}) {
    const MeasuredTable reference = rough_table(grid);
    for (const Model model : all_models()) {
      const Material material = random_full_material(model, effects_of(model), 6);
      for (const double max_theta : {90.0, 70.0}) {
        const Evaluation actual = evaluate(material, reference, max_theta);
        const Expected expected = expected_sums(mean_of_orders(material), reference, max_theta);
        SCOPED_TRACE(testing::Message()
                     << name_of(model) << ", max theta " << max_theta << ", grid " << grid.n_theta_h);
        expect_measures(actual.table, expected.table, kRounding);
        expect_measures(actual.slice, expected.slice, kRounding);
        EXPECT_EQ(actual.table.cells, expected.table_cells);
      }
    }
  }
}

TEST(Evaluate, OfMaterialsWithOtherOptionsFollowsTheDefinitions) {
  const MeasuredTable reference = rough_table(kSmallGrid);
  for (const Masking masking : {Masking::kSeparable, Masking::kCorrelated}) {
    for (const Diffuse diffuse : {Diffuse::kLambert, Diffuse::kProxima}) {
      Material material = random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 6);
      material.options().masking = masking;
      material.options().diffuse = diffuse;
      const Expected expected = expected_sums(mean_of_orders(material), reference, 90.0);
      const Evaluation actual = evaluate(material, reference);
      expect_measures(actual.table, expected.table, kRounding);
      expect_measures(actual.slice, expected.slice, kRounding);
    }
  }
}

TEST(Evaluate, OfATableFollowsTheDefinitions) {
  const MeasuredTable reference = rough_table(kSmallGrid);
  const MeasuredTable candidate =
      table_of(random_full_material(Model::kBurley, effects_of(Model::kBurley), 2));
  for (const double max_theta : {90.0, 60.0}) {
    const Evaluation actual = evaluate(candidate, reference, max_theta);
    const Expected expected = expected_sums(
        [&](std::size_t cell, const DirectionPair&) { return candidate.value(cell); }, reference, max_theta);
    expect_measures(actual.table, expected.table, kRounding);
    expect_measures(actual.slice, expected.slice, kRounding);
    EXPECT_EQ(actual.table.cells, expected.table_cells);
    EXPECT_EQ(actual.reciprocity_gap_pct, 0.0);
  }
}

// Lines shorter than a vector, with and without a middle, at the ends of the table.
TEST(Evaluate, OnTinyGridsFollowsTheDefinitions) {
  for (const CellAnchor anchor : {CellAnchor::kLowerEdge, CellAnchor::kCentre}) {
    for (const Grid& grid : {Grid{5, 4, 7, anchor}, Grid{2, 9, 2, anchor}, Grid{3, 2, 1, anchor}}) {
      const MeasuredTable reference =
          table_of(random_full_material(Model::kBurley, effects_of(Model::kBurley), 4), grid);
      const Material material = random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 6);
      const MeasuredTable candidate = table_of(material, grid);
      const CellValue stored = [&](std::size_t cell, const DirectionPair&) { return candidate.value(cell); };
      SCOPED_TRACE(testing::Message() << grid.n_theta_h << " x " << grid.n_theta_d << " x " << grid.n_phi_d);
      // Of a few cells, errors of single precision do not cancel.
      constexpr double kRoundingOfFew = 5e-6;
      const Expected of_material = expected_sums(mean_of_orders(material), reference, 90.0);
      const Expected of_table = expected_sums(stored, reference, 90.0);
      const Evaluation actual = evaluate(material, reference);
      expect_measures(actual.table, of_material.table, kRoundingOfFew);
      EXPECT_EQ(actual.table.cells, of_material.table_cells);
      const Evaluation stored_actual = evaluate(candidate, reference);
      expect_measures(stored_actual.table, of_table.table, kRoundingOfFew);
      EXPECT_EQ(stored_actual.table.cells, of_table.table_cells);
    }
  }
}

// What `export` followed by `table` shows is what `fit` printed: stored values are floats.
TEST(Evaluate, OfAnExportedTableIsThatOfItsMaterial) {
  const MeasuredTable reference = rough_table(kSmallGrid);
  for (const Model model : all_models()) {
    const Material material = random_full_material(model, effects_of(model).without(Effect::kAnisotropic), 8);
    const Evaluation direct = evaluate(material, reference);
    const Evaluation exported = evaluate(table_of(material), reference);
    const auto expect_same = [](const Measures& a, const Measures& b) {
      EXPECT_NEAR(a.log_ratio_pct, b.log_ratio_pct, 1e-6 * a.log_ratio_pct);
      EXPECT_NEAR(a.relative, b.relative, 1e-6 * a.relative);
      EXPECT_NEAR(a.cube_root, b.cube_root, 1e-6 * a.cube_root);
      EXPECT_NEAR(a.srgb, b.srgb, 1e-6 * a.srgb);
      EXPECT_NEAR(a.cosine_l2, b.cosine_l2, 1e-6 * a.cosine_l2);
      EXPECT_NEAR(a.slice_pct, b.slice_pct, 1e-6 * a.slice_pct);
      EXPECT_EQ(a.cells, b.cells);
    };
    expect_same(direct.table, exported.table);
    expect_same(direct.slice, exported.slice);
  }
}

// Each model, reciprocal or not: the mean of both orders is what its own table stores.
TEST(Evaluate, OfAMaterialAgainstItsOwnTableIsRounding) {
  for (const Model model : all_models()) {
    const Material material = random_full_material(model, effects_of(model).without(Effect::kAnisotropic), 9);
    const Evaluation evaluation = evaluate(material, table_of(material));
    for (const Measures& m : {evaluation.table, evaluation.slice}) {
      EXPECT_LT(m.log_ratio_pct, 1e-5);
      EXPECT_LT(m.slice_pct, 1e-5);
      EXPECT_LT(m.relative, 1e-7);
      EXPECT_LT(m.cube_root, 1e-6);
      EXPECT_LT(m.srgb, 1e-7);
      EXPECT_GT(m.cells, 0U);
    }
  }
}

TEST(Evaluate, OfATableAgainstItselfIsZero) {
  const MeasuredTable table = rough_table(kSmallGrid);
  const Evaluation evaluation = evaluate(table, table);
  for (const Measures& m : {evaluation.table, evaluation.slice}) {
    EXPECT_EQ(m.log_ratio_pct, 0.0);
    EXPECT_EQ(m.slice_pct, 0.0);
    EXPECT_EQ(m.relative, 0.0);
    EXPECT_EQ(m.cube_root, 0.0);
    EXPECT_EQ(m.srgb, 0.0);
    EXPECT_EQ(m.cosine_l2, 0.0);
  }
}

TEST(Evaluate, LeavesOutCellsThatEitherTableLacks) {
  const MeasuredTable whole = table_of(random_full_material(Model::kBurley, {}, 2));
  const MeasuredTable holed = rough_table(kSmallGrid);
  EXPECT_EQ(evaluate(whole, holed).table.cells, holed.valid_count());
  EXPECT_EQ(evaluate(holed, whole).table.cells, holed.valid_count());
}

TEST(Evaluate, RefusesTablesOnDifferentGrids) {
  const MeasuredTable table = rough_table(kSmallGrid);
  Grid centred = kSmallGrid;
  centred.anchor = CellAnchor::kCentre;
  EXPECT_THROW(evaluate(table, rough_table(centred)), std::invalid_argument);
  EXPECT_THROW(evaluate(table, rough_table({30, 30, 30, CellAnchor::kLowerEdge})), std::invalid_argument);
}

TEST(ReciprocityGap, IsZeroForReciprocalMaterials) {
  const MeasuredTable reference = rough_table(kSmallGrid);
  for (const Model model : all_models()) {
    const Effects effects = effects_of(model).without(Effect::kSmoothTerminator);
    EXPECT_EQ(evaluate(random_full_material(model, effects, 3), reference).reciprocity_gap_pct, 0.0);
  }
}

TEST(ReciprocityGap, IsTheMeanLogRatioOfTheOrders) {
  const MeasuredTable reference = rough_table(kSmallGrid);
  Material material = random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 3);
  material.set("smooth_terminator", 0.5);
  double sum = 0.0;
  double n = 0.0;
  for (std::size_t cell = 0; cell < kSmallGrid.cell_count(); ++cell) {
    const DirectionPair pair = directions_from_half_diff(kSmallGrid.angles_of(cell));
    if (!reference.is_valid(cell) || pair.wi.z < 1e-9 || pair.wo.z < 1e-9) continue;
    const Rgb forth = eval(material, pair.wi, pair.wo);
    const Rgb back = eval(material, pair.wo, pair.wi);
    for (std::size_t c = 0; c < 3; ++c) {
      sum += std::abs(std::log((forth[c] * pair.wi.z + 1e-3) / (back[c] * pair.wi.z + 1e-3)));
      n += 1;
    }
  }
  const double actual = evaluate(material, reference).reciprocity_gap_pct;
  EXPECT_NEAR(actual, 100 * sum / n, kRounding * actual);
  EXPECT_GT(actual, 0.1);
}

TEST(Evaluate, OfNothingIsZeroAndSaysSo) {
  const MeasuredTable nothing(kSmallGrid, std::vector<float>(3 * kSmallGrid.cell_count(), -1.0F));
  const Evaluation evaluation = evaluate(Material(), nothing);
  EXPECT_EQ(evaluation.table.cells, 0U);
  EXPECT_EQ(evaluation.slice.cells, 0U);
  EXPECT_EQ(evaluation.table.log_ratio_pct, 0.0);
  EXPECT_EQ(evaluation.slice.slice_pct, 0.0);
}

// Cells without light, in either: no logarithm of 0 comes out.
TEST(Evaluate, OfDarknessIsFinite) {
  const MeasuredTable dark(kSmallGrid, std::vector<float>(3 * kSmallGrid.cell_count(), 0.0F));
  const Material material = random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 3);
  const Expected expected = expected_sums(mean_of_orders(material), dark, 90.0);
  expect_measures(evaluate(material, dark).table, expected.table, kRounding);
  Material black;
  black.set("base_color", 0.0);
  black.set("specular", 0.0);
  const Measures m = evaluate(black, dark).table;
  for (const double value : {m.log_ratio_pct, m.slice_pct, m.relative, m.cube_root, m.srgb, m.cosine_l2}) {
    EXPECT_TRUE(std::isfinite(value));
  }
}

TEST(Evaluate, DoesNotDependOnTheNumberOfThreads) {
  const MeasuredTable reference = rough_table(kSmallGrid);
  const Material material = random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 6);
  const auto with_threads = [&](std::size_t count) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, count);
    return evaluate(material, reference);
  };
  const Evaluation one = with_threads(1);
  for (const std::size_t count : {2U, 4U}) {
    const Evaluation other = with_threads(count);
    EXPECT_EQ(one.table.log_ratio_pct, other.table.log_ratio_pct);
    EXPECT_EQ(one.table.cosine_l2, other.table.cosine_l2);
    EXPECT_EQ(one.table.srgb, other.table.srgb);
    EXPECT_EQ(one.slice.slice_pct, other.slice.slice_pct);
    EXPECT_EQ(one.reciprocity_gap_pct, other.reciprocity_gap_pct);
  }
}

}  // namespace
}  // namespace brdfit::fit
