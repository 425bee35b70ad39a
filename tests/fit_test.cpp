// Fits as their callers see them: options, determinism, what is fixed and where a fit begins.
#include "fit/fit.h"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <cmath>
#include <stdexcept>

#include "fit/solve.h"
#include "tests/fit_data.h"

namespace brdfit::fit {
namespace {

using testing::HasSubstr;
using testing_support::random_full_material;
using testing_support::table_of;

class Fit : public testing::Test {
 protected:
  static void SetUpTestSuite() { silence_solver_logging(); }
};

FitOptions quick(Model model) {
  FitOptions options;
  options.model = model;
  options.samples = 1000;
  options.starts = 4;
  return options;
}

Material coloured() {
  Material material;
  material.set("base_color", Rgb{0.7, 0.4, 0.1});
  material.set("metallic", 0.3);
  material.set("specular", 0.6);
  material.set("roughness", 0.35);
  return material;
}

const ParameterState& state_of(const FitResult& result, std::string_view name) {
  const auto found = std::ranges::find(result.parameters, name, &ParameterState::name);
  if (found == result.parameters.end()) throw std::logic_error("no such parameter");
  return *found;
}

void expect_invalid(const FitOptions& options, const std::string& part) {
  std::string why;
  EXPECT_FALSE(options.is_valid(&why));
  EXPECT_FALSE(options.is_valid(nullptr));
  EXPECT_THAT(why, HasSubstr(part));
  EXPECT_THROW(fit(table_of(Material()), options), std::invalid_argument);
}

TEST_F(Fit, DefaultOptionsAreValidForEveryModel) {
  for (const Model model : all_models()) {
    FitOptions options;
    options.model = model;
    std::string why;
    EXPECT_TRUE(options.is_valid(&why)) << why;
    EXPECT_EQ(options.loss, Loss::kLogRatio);
    EXPECT_EQ(options.on, FitOn::kTable);
    EXPECT_EQ(options.material_options.masking, Masking::kSeparable);
  }
}

TEST_F(Fit, RefusesOptionsWithAReason) {
  const FitOptions good = quick(Model::kLambertGgx);
  FitOptions options = good;
  options.starts = -1;
  expect_invalid(options, "starts is -1");
  options = good;
  options.samples = 0;
  expect_invalid(options, "samples is 0");
  for (const double angle : {0.0, -5.0, 90.5, std::nan("")}) {
    options = good;
    options.max_theta_deg = angle;
    expect_invalid(options, "not in (0, 90]");
  }
  options = good;
  options.on = FitOn::kSlices;
  options.phi_d_deg = {};
  expect_invalid(options, "no phi_d");
  for (const double angle : {-1.0, 180.0, std::nan("")}) {
    options = good;
    options.phi_d_deg = {90.0, angle};
    expect_invalid(options, "not in [0, 180)");
  }
  options = good;
  options.init = Material(Model::kBurley);
  expect_invalid(options, "the material to start from is Burley, not Lambert + GGX");
}

TEST_F(Fit, RefusesFixedParametersThatTheModelDoesNotHave) {
  FitOptions options = quick(Model::kLambertGgx);
  options.fixed = {{"sheen", {0.5}}};
  EXPECT_THROW(fit(table_of(Material()), options), std::invalid_argument);
  options.fixed = {{"roughness", {2.0}}};
  EXPECT_THROW(fit(table_of(Material()), options), std::invalid_argument);
}

TEST_F(Fit, RefusesTablesWithoutACellToFit) {
  const Grid& grid = testing_support::kSmallGrid;
  const MeasuredTable nothing(grid, std::vector<float>(3 * grid.cell_count(), -1.0F));
  EXPECT_THROW(fit(nothing, quick(Model::kLambertGgx)), std::invalid_argument);
  // Valid cells, but only at grazing angles.
  synthetic::Recipe recipe = testing_support::recipe_of(coloured());
  std::vector<Rgb> values = synthetic::generate_values(recipe);
  std::vector<float> planes(3 * grid.cell_count(), -1.0F);
  for (std::size_t cell = 0; cell < values.size(); ++cell) {
    if (grid.angles_of(cell).theta_h_rad < 1.0) continue;
    for (std::size_t c = 0; c < 3; ++c)
      planes[c * values.size() + cell] = static_cast<float>(values[cell][c]);
  }
  const MeasuredTable grazing(grid, planes);
  ASSERT_GT(grazing.valid_count(), 0U);
  for (const FitOn on : {FitOn::kTable, FitOn::kSlices}) {
    FitOptions options = quick(Model::kLambertGgx);
    options.on = on;
    options.max_theta_deg = 20.0;
    try {
      fit(grazing, options);
      ADD_FAILURE() << "accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr("no valid cell"));
    }
  }
}

TEST_F(Fit, GivesTheSameBitsOnAnyNumberOfThreads) {
  const MeasuredTable table =
      table_of(random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 4));
  const auto with_threads = [&](std::size_t count) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, count);
    // Enough for several chunks of work.
    FitOptions options = quick(Model::kCallisto);
    options.samples = 12000;
    return fit(table, options);
  };
  const FitResult one = with_threads(1);
  const FitResult two = with_threads(2);
  EXPECT_EQ(one.material, two.material);
  EXPECT_EQ(one.cost, two.cost);
  EXPECT_EQ(one.iterations, two.iterations);
  EXPECT_EQ(one.evaluations, two.evaluations);
  EXPECT_EQ(one.evaluation.table.log_ratio_pct, two.evaluation.table.log_ratio_pct);
  ASSERT_EQ(one.parameters.size(), two.parameters.size());
  for (std::size_t k = 0; k < one.parameters.size(); ++k) {
    EXPECT_EQ(one.parameters[k].standard_error, two.parameters[k].standard_error) << one.parameters[k].name;
    EXPECT_EQ(one.parameters[k].reason, two.parameters[k].reason) << one.parameters[k].name;
  }
}

TEST_F(Fit, DependsOnItsSeed) {
  synthetic::Recipe recipe = testing_support::recipe_of(coloured());
  recipe.noise.multiplicative = 0.1;
  const MeasuredTable table = synthetic::generate_table(recipe);
  FitOptions options = quick(Model::kLambertGgx);
  const FitResult first = fit(table, options);
  EXPECT_EQ(fit(table, options).material, first.material);
  options.seed = 2;
  EXPECT_NE(fit(table, options).material, first.material);
}

TEST_F(Fit, LeavesFixedParametersAlone) {
  const MeasuredTable table =
      table_of(random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 4));
  FitOptions options = quick(Model::kCallisto);
  options.fixed = {{"metallic", {0.0}}, {"base_color", {0.1, 0.2, 0.3}}, {"retroreflection", {3.0}}};
  const FitResult result = fit(table, options);
  EXPECT_EQ(result.material.number("metallic"), 0.0);
  EXPECT_EQ(result.material.colour("base_color"), (Rgb{0.1, 0.2, 0.3}));
  EXPECT_EQ(result.material.number("retroreflection"), 3.0);
  for (const auto& [name, value] : options.fixed) EXPECT_EQ(state_of(result, name).status, Status::kFixed);
  EXPECT_NE(state_of(result, "roughness").status, Status::kFixed);
}

TEST_F(Fit, WithEverythingFixedEvaluatesTheMaterial) {
  FitOptions options = quick(Model::kLambertGgx);
  options.init = coloured();
  options.fixed = {
      {"base_color", {0.7, 0.4, 0.1}}, {"metallic", {0.3}}, {"specular", {0.6}}, {"roughness", {0.35}}};
  const FitResult result = fit(table_of(coloured()), options);
  EXPECT_EQ(result.free_parameters, 0);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.material.values()[0], 0.7);
  EXPECT_LT(result.evaluation.table.log_ratio_pct, 1e-4);
}

// With a start at the answer, no search is needed to find it.
TEST_F(Fit, BeginsAtTheInitialMaterialToo) {
  const Effects effects = effects_of(Model::kCallisto).without(Effect::kSmoothTerminator);
  const Material truth = random_full_material(Model::kCallisto, effects, 21);
  FitOptions options = quick(Model::kCallisto);
  options.effects = effects;
  options.starts = 1;
  options.init = truth;
  const FitResult result = fit(table_of(truth), options);
  EXPECT_LT(result.evaluation.table.log_ratio_pct, 1e-4);
}

TEST_F(Fit, TakesWhatIsNotFreeFromTheInitialMaterial) {
  Material init(Model::kCallisto);
  init.set_effects(effects_of(Model::kCallisto));
  init.set("smooth_terminator_length", 0.8);
  init.set("retroreflection_tint", Rgb{1.0, 0.5, 0.25});
  FitOptions options = quick(Model::kCallisto);
  options.tier = Tier::kBase;
  options.init = init;
  const FitResult result = fit(table_of(coloured()), options);
  EXPECT_EQ(result.material.number("smooth_terminator_length"), 0.8);
  EXPECT_EQ(result.material.colour("retroreflection_tint"), (Rgb{1.0, 0.5, 0.25}));
}

TEST_F(Fit, OfCallistoWithoutEffectsIsThatOfLambertGgx) {
  const MeasuredTable table = table_of(random_full_material(Model::kBurley, Effects(), 5));
  FitOptions options = quick(Model::kCallisto);
  options.effects = Effects();
  const FitResult callisto = fit(table, options);
  const FitResult lambert_ggx = fit(table, quick(Model::kLambertGgx));
  EXPECT_EQ(callisto.free_parameters, lambert_ggx.free_parameters);
  EXPECT_NEAR(callisto.cost, lambert_ggx.cost, 1e-6 * lambert_ggx.cost);
  EXPECT_NEAR(callisto.evaluation.table.log_ratio_pct, lambert_ggx.evaluation.table.log_ratio_pct,
              1e-3 * lambert_ggx.evaluation.table.log_ratio_pct);
  EXPECT_EQ(callisto.material.effects(), Effects());
}

TEST_F(Fit, NeverFreesAnisotropy) {
  FitOptions options = quick(Model::kBurley);
  options.effects = effects_of(Model::kBurley);
  const FitResult result = fit(table_of(coloured()), options);
  EXPECT_EQ(result.material.number("anisotropic"), 0.0);
  EXPECT_EQ(result.free_parameters, 12);
}

TEST_F(Fit, OfSlicesFindsAnExactMaterial) {
  FitOptions options = quick(Model::kLambertGgx);
  options.on = FitOn::kSlices;
  options.phi_d_deg = {0.0, 90.0};
  const FitResult result = fit(table_of(coloured()), options);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(result.material.values()[k], coloured().values()[k], 1e-4) << k;
  }
}

// Cells beyond max theta may hold anything.
TEST_F(Fit, DoesNotSeeCellsBeyondMaxTheta) {
  const Grid& grid = testing_support::kSmallGrid;
  std::vector<Rgb> values = synthetic::generate_values(testing_support::recipe_of(coloured()));
  std::vector<float> planes(3 * grid.cell_count(), -1.0F);
  const double lowest = std::cos(60.0 / 180.0 * 3.14159265358979);
  for (std::size_t cell = 0; cell < values.size(); ++cell) {
    const DirectionPair pair = directions_from_half_diff(grid.angles_of(cell));
    const bool spoilt = std::min(pair.wi.z, pair.wo.z) < lowest - 1e-9;
    for (std::size_t c = 0; c < 3; ++c) {
      planes[c * values.size() + cell] = static_cast<float>(values[cell][c] * (spoilt ? 50.0 : 1.0));
    }
  }
  FitOptions options = quick(Model::kLambertGgx);
  options.max_theta_deg = 60.0;
  const FitResult result = fit(MeasuredTable(grid, planes), options);
  EXPECT_LT(result.evaluation.table.log_ratio_pct, 1e-3);
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_NEAR(result.material.values()[k], coloured().values()[k], 1e-3) << k;
}

TEST_F(Fit, KeepsTheMaterialsOptions) {
  Material truth = coloured();
  truth.options().masking = Masking::kCorrelated;
  FitOptions options = quick(Model::kLambertGgx);
  options.material_options = truth.options();
  const FitResult result = fit(table_of(truth), options);
  EXPECT_EQ(result.material.options(), truth.options());
  EXPECT_LT(result.evaluation.table.log_ratio_pct, 1e-3);
}

TEST_F(Fit, ReportsItsCourse) {
  const FitResult result = fit(table_of(coloured()), quick(Model::kLambertGgx));
  EXPECT_EQ(result.free_parameters, 6);
  EXPECT_EQ(result.observations, 1000U);
  EXPECT_TRUE(result.converged);
  EXPECT_FALSE(result.termination.empty());
  EXPECT_GT(result.iterations, 0);
  EXPECT_GT(result.evaluations, result.iterations);
  EXPECT_GE(result.starts, 4);
  EXPECT_GE(result.starts_near_best, 1);
  EXPECT_LE(result.starts_near_best, result.starts);
  EXPECT_EQ(result.parameters.size(), 4U);
  const FitTimings& t = result.timings;
  for (const double seconds :
       {t.sample_seconds, t.explore_seconds, t.refine_seconds, t.evidence_seconds, t.measure_seconds}) {
    EXPECT_GE(seconds, 0.0);
    EXPECT_LE(seconds, t.total_seconds);
  }
}

TEST_F(Fit, ReportsMaterialsThatAreValid) {
  for (const Model model : all_models()) {
    for (const std::uint64_t seed : {1U, 2U}) {
      const Material other = random_full_material(Model::kCallisto, effects_of(Model::kCallisto), seed);
      std::string why;
      EXPECT_TRUE(fit(table_of(other), quick(model)).material.is_valid(&why)) << why;
    }
  }
}

TEST_F(Fit, NamesItsSourcesOfData) {
  for (const FitOn on : {FitOn::kTable, FitOn::kSlices}) EXPECT_EQ(fit_on_by_name(name_of(on)), on);
  EXPECT_EQ(name_of(FitOn::kTable), "table");
  EXPECT_EQ(name_of(FitOn::kSlices), "slices");
  EXPECT_EQ(fit_on_by_name("tables"), std::nullopt);
}

}  // namespace
}  // namespace brdfit::fit
