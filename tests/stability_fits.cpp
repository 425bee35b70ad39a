// Tables that are hard to fit, and fits that begin or end in hard places.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <span>

#include "fit/explore.h"
#include "fit/fit.h"
#include "fit/held_out.h"
#include "fit/solve.h"
#include "tests/fit_data.h"
#include "tests/random_parameters.h"
#include "tests/stability_data.h"
#include "tests/stability_walk.h"

namespace brdfit::stability {
namespace {

using fit::FitOptions;
using fit::FitResult;

constexpr Grid kGrid = {12, 12, 24, CellAnchor::kLowerEdge};
constexpr float kLargest = 1e7F;

MeasuredTable table_of(const Material& material) {
  return testing_support::table_of(material, kGrid);
}

Material grey_plastic() {
  Material material;
  material.set("base_color", 0.3);
  material.set("roughness", 0.4);
  return material;
}

std::vector<Rgb> values_of(const Material& material) {
  return synthetic::generate_values(testing_support::recipe_of(material, kGrid));
}

// A table whose valid cells hold what `change` makes of them.
template <class Change>
MeasuredTable changed(const Material& material, const Change& change) {
  const std::vector<Rgb> values = values_of(material);
  std::vector<float> planes(3 * values.size(), -1.0F);
  for (std::size_t cell = 0; cell < values.size(); ++cell) {
    if (values[cell][0] < 0.0) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      planes[c * values.size() + cell] = change(cell, static_cast<float>(values[cell][c]));
    }
  }
  return {kGrid, std::move(planes)};
}

std::vector<std::size_t> valid_cells(const MeasuredTable& table) {
  std::vector<std::size_t> cells;
  for (std::size_t cell = 0; cell < table.grid().cell_count(); ++cell) {
    if (table.is_valid(cell)) cells.push_back(cell);
  }
  return cells;
}

MeasuredTable constant_table(float value) {
  return changed(grey_plastic(), [value](std::size_t, float) { return value; });
}

FitOptions quick(Model model, fit::Loss loss = fit::Loss::kLogRatio) {
  FitOptions options;
  options.model = model;
  options.loss = loss;
  options.samples = 400;
  options.starts = 2;
  return options;
}

void expect_finite(const fit::Measures& measures) {
  for (const double measure : {measures.slice_pct, measures.log_ratio_pct, measures.relative,
                               measures.cube_root, measures.srgb, measures.cosine_l2}) {
    EXPECT_TRUE(std::isfinite(measure));
  }
}

std::size_t fits_done = 0;

// A material inside its ranges, and evidence that is made of numbers.
void expect_sound(const FitResult& result) {
  ++fits_done;
  std::string why;
  EXPECT_TRUE(result.material.is_valid(&why)) << why;
  EXPECT_TRUE(std::isfinite(result.cost));
  EXPECT_GE(result.cost, 0.0);
  EXPECT_TRUE(std::isfinite(result.largest_albedo));
  EXPECT_TRUE(std::isfinite(result.evaluation.reciprocity_gap_pct));
  expect_finite(result.evaluation.slice);
  expect_finite(result.evaluation.table);
  for (const fit::ParameterState& state : result.parameters) {
    for (const std::optional<double>& error : state.standard_error) {
      if (!error) continue;
      EXPECT_TRUE(std::isfinite(*error)) << state.name;
      EXPECT_GE(*error, 0.0) << state.name;
    }
  }
  for (const fit::CorrelatedPair& pair : result.correlated) EXPECT_LE(std::abs(pair.correlation), 1.0 + 1e-9);
}

// Every model under every loss, or under some.
void expect_sound_fits(const MeasuredTable& table, std::span<const fit::Loss> losses = fit::all_losses()) {
  for (const Model model : all_models()) {
    for (const fit::Loss loss : losses) {
      SCOPED_TRACE(std::string(name_of(model)) + " " + std::string(name_of(loss)));
      expect_sound(fit::fit(table, quick(model, loss)));
    }
  }
}

// With choices of groups, of the number of samples and of what is held out as well.
void expect_sound_choices(const MeasuredTable& table) {
  FitOptions options = quick(Model::kCallisto);
  options.choose_groups = true;
  options.choose_samples = true;
  options.tier = Tier::kBase;
  expect_sound(fit::fit(table, options));
  options = quick(Model::kLambertGgx);
  options.on = fit::FitOn::kSlices;
  expect_sound(fit::fit(table, options));
}

void values_to_1e7() {
  // A highlight that reaches them: F D V of alpha = 1e-4 is F / (4 pi alpha^2) at its peak.
  Material metal = grey_plastic();
  metal.set("base_color", Rgb{0.9, 0.6, 0.3});
  metal.set("metallic", 1.0);
  metal.set("roughness", 0.01);
  const MeasuredTable sharp = table_of(metal);
  EXPECT_GT(sharp.largest(), 5e6);
  const FitResult result = fit::fit(sharp, quick(Model::kLambertGgx));
  expect_sound(result);
  EXPECT_NEAR(result.material.number("roughness"), 0.01, 1e-4);
  // Cells that are wrong: one in fifty.
  expect_sound_fits(
      changed(grey_plastic(), [](std::size_t cell, float f) { return cell % 50 == 0 ? kLargest : f; }));
  // All of the table.
  expect_sound_fits(constant_table(kLargest));
}

void one_valid_cell() {
  const std::vector<std::size_t> cells = valid_cells(table_of(grey_plastic()));
  for (const std::size_t kept : {cells.front(), cells[cells.size() / 2], cells.back()}) {
    const MeasuredTable table =
        changed(grey_plastic(), [kept](std::size_t cell, float f) { return cell == kept ? f : -1.0F; });
    ASSERT_EQ(table.valid_count(), 1U);
    expect_sound_fits(table, kept == cells.front() ? fit::all_losses() : fit::all_losses().first(1));
    const FitResult result = fit::fit(table, quick(Model::kCallisto));
    EXPECT_EQ(result.observations, 1U);
    EXPECT_LT(result.evaluation.table.log_ratio_pct, 1.0);
    FitOptions options = quick(Model::kCallisto);
    options.choose_groups = true;
    options.choose_samples = true;
    expect_sound(fit::fit(table, options));
    // There is nothing to hold out.
    options.held_out_folds = 2;
    const auto by_fit = [](const MeasuredTable& of, const FitOptions& with) { return fit::fit(of, with); };
    EXPECT_THROW(fit::evaluate_held_out(table, options, by_fit), std::invalid_argument);
  }
}

void constant() {
  for (const float value : {0.0F, 1e-30F, 0.05F, 1.0F}) {
    const MeasuredTable table = constant_table(value);
    expect_sound_fits(table, value == 0.0F ? fit::all_losses() : fit::all_losses().first(1));
    if (value == 0.0F || value == 1.0F) expect_sound_choices(table);
  }
  // A Lambert surface has such a table, but for the highlight.
  const FitResult result = fit::fit(constant_table(0.1F), quick(Model::kLambertGgx));
  EXPECT_LT(result.evaluation.table.log_ratio_pct, 15.0);
}

void hot_cell() {
  const Material truth = grey_plastic();
  const std::size_t hot = valid_cells(table_of(truth))[700];
  const MeasuredTable table =
      changed(truth, [hot](std::size_t cell, float f) { return cell == hot ? kLargest : f; });
  expect_sound_fits(table);
  expect_sound_choices(table);
  // The log-ratio counts large residuals less: the others decide.
  FitOptions options = quick(Model::kLambertGgx);
  options.samples = kAllSamples;
  const FitResult result = fit::fit(table, options);
  EXPECT_NEAR(result.material.number("roughness"), 0.4, 0.01);
  EXPECT_NEAR(result.material.number("base_color"), 0.3, 0.01);
}

void noise_above_signal() {
  std::mt19937_64 random(81);
  std::normal_distribution<float> normal(0.0F, 3.0F);
  const MeasuredTable table = changed(
      grey_plastic(), [&](std::size_t, float f) { return std::max(0.0F, f * (1.0F + normal(random))); });
  expect_sound_fits(table);
  expect_sound_choices(table);
}

void all_invalid() {
  const std::vector<float> planes(3 * kGrid.cell_count(), -1.0F);
  const MeasuredTable table(kGrid, planes);
  for (const Model model : all_models()) {
    EXPECT_THROW(fit::fit(table, quick(model)), std::invalid_argument);
  }
  expect_finite(fit::evaluate(grey_plastic(), table).table);
}

// Every way in which a start may stand at ends of its ranges must come to a minimum of its own.
void start_at_bounds() {
  const Material truth =
      testing_support::random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 4);
  Material start(Model::kCallisto);
  start.set_effects(effects_of(Model::kCallisto));
  const testing_support::OwnedProblem owned(table_of(truth), start, {Tier::kFull, start.effects(), {}},
                                            fit::Loss::kLogRatio, 400);
  const fit::Parametrisation& free = owned.parametrisation;
  const fit::Box box = fit::full_box(free);
  std::mt19937_64 random(82);
  for (int repeat = 0; repeat < 12; ++repeat) {
    std::vector<double> x;
    for (const fit::FreeParameter& parameter : free.free) {
      const bool low = repeat == 0 || (repeat != 1 && random() % 2 == 0);
      x.push_back(low ? parameter.lower : parameter.upper);
    }
    const double before = owned.problem.cost(x);
    const fit::Solution solution = fit::solve_pinning(owned.problem, x, box, {});
    EXPECT_TRUE(std::isfinite(solution.cost));
    EXPECT_LT(solution.cost, before) << "start " << repeat;
    for (std::size_t k = 0; k < x.size(); ++k) {
      EXPECT_GE(solution.x[k], free.free[k].lower);
      EXPECT_LE(solution.x[k], free.free[k].upper);
    }
  }
}

// A start given twice is two candidates with the same end, and no division by what tells them apart.
void identical_starts() {
  Material start(Model::kCallisto);
  start.set_effects(effects_of(Model::kCallisto));
  const testing_support::OwnedProblem owned(table_of(grey_plastic()), start,
                                            {Tier::kFull, start.effects(), {}}, fit::Loss::kLogRatio, 400);
  fit::Targets wide = owned.targets;
  wide.robust_width *= 3.0;
  const fit::Problem on_wide(owned.parametrisation, owned.samples, wide, fit::Loss::kLogRatio);
  const std::vector<double> x = owned.parametrisation.from_material(start);
  const auto explored = [&](const std::vector<std::vector<double>>& seeds) {
    return fit::explore(owned.problem, on_wide, owned.samples, seeds, {1, 1});
  };
  const std::vector<fit::Candidate> once = explored({x});
  const std::vector<fit::Candidate> twice = explored({x, x});
  EXPECT_GT(twice.size(), once.size());
  for (const fit::Candidate& candidate : twice) EXPECT_TRUE(std::isfinite(candidate.solution.cost));
  EXPECT_LE(twice.front().solution.cost, 1.05 * once.front().solution.cost + 1e-12);
  FitOptions options = quick(Model::kCallisto);
  options.starts = 1;
  options.init = start;
  expect_sound(fit::fit(table_of(grey_plastic()), options));
}

void more_parameters_than_samples() {
  const Material truth =
      testing_support::random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 4);
  for (const std::size_t samples : {1U, 2U, 5U}) {
    for (const Model model : all_models()) {
      FitOptions options = quick(model);
      options.samples = samples;
      const FitResult result = fit::fit(table_of(truth), options);
      expect_sound(result);
      EXPECT_EQ(result.observations, samples);
      if (model == Model::kLambertGgx && samples > 1) continue;
      // Something is not seen, and that is said.
      const auto unseen = std::ranges::count_if(result.parameters, [](const fit::ParameterState& state) {
        return state.status != fit::Status::kOk;
      });
      EXPECT_GT(unseen, 0) << name_of(model) << " " << samples;
    }
  }
}

// Neutral intensities hide their falloffs, opacity 0 the second lobe, a black base colour the diffuse part:
// columns of zeros. A grey dielectric ties metallic, specular and base colour.
void rank_deficient() {
  Material neutral(Model::kCallisto);
  neutral.set_effects(effects_of(Model::kCallisto));
  Material black = neutral;
  black.set("base_color", 0.0);
  for (const Material& truth : {neutral, black, grey_plastic()}) {
    const testing_support::OwnedProblem owned(table_of(truth), neutral, {Tier::kFull, neutral.effects(), {}},
                                              fit::Loss::kLogRatio, 400);
    const std::vector<double> x = owned.parametrisation.from_material(neutral);
    const Eigen::MatrixXd gram = owned.problem.gram(x);
    ASSERT_TRUE(gram.allFinite());
    const Eigen::Index n = gram.rows() - 1;
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gram.topLeftCorner(n, n)).eigenvalues();
    EXPECT_LT(eigenvalues[0], 1e-12 * eigenvalues[n - 1]);
    const fit::Solution solution =
        fit::solve_pinning(owned.problem, x, fit::full_box(owned.parametrisation), {});
    EXPECT_TRUE(std::isfinite(solution.cost));
    EXPECT_LE(solution.cost, owned.problem.cost(x));
    FitOptions options = quick(Model::kCallisto);
    options.init = neutral;
    const FitResult result = fit::fit(table_of(truth), options);
    expect_sound(result);
    EXPECT_LT(result.evaluation.table.log_ratio_pct, 1.0);
  }
}

}  // namespace

const std::vector<DataCase>& fit_cases() {
  static const std::vector<DataCase> all = {
      {"table-values-to-1e7", values_to_1e7},
      {"table-one-valid-cell", one_valid_cell},
      {"table-constant", constant},
      {"table-hot-cell", hot_cell},
      {"table-noise-above-signal", noise_above_signal},
      {"table-all-invalid", all_invalid},
      {"fit-starts-at-bounds", start_at_bounds},
      {"fit-identical-starts", identical_starts},
      {"fit-more-parameters-than-samples", more_parameters_than_samples},
      {"fit-rank-deficient", rank_deficient},
  };
  return all;
}

namespace {

TEST(Stability, TablesAndFits) {
  fit::silence_solver_logging();
  for (const DataCase& one : fit_cases()) {
    SCOPED_TRACE(one.id);
    one.run();
  }
  print_walked("double", fit_cases().size(), "tables and fits", fits_done);
}

}  // namespace
}  // namespace brdfit::stability
