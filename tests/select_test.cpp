// The choice of effects: what it sees, what it finds, and what it says of it.
#include "fit/select.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include "brdf/models.h"
#include "fit/fit.h"
#include "fit/log_ratio.h"
#include "fit/metrics.h"
#include "fit/problem.h"
#include "tests/selection_study.h"

namespace brdfit::fit {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing_support::every_group;
using testing_support::make_study;
using testing_support::noisy_table;
using testing_support::select_all;
using testing_support::Study;

Material callisto_with(Effects effects, std::uint64_t seed) {
  return testing_support::random_full_material(Model::kCallisto, effects, seed);
}

TEST(HeldOutError, IsTheLogRatioOfTheTable) {
  for (const Model model : all_models()) {
    const MeasuredTable table = testing_support::table_of(callisto_with(effects_of(Model::kCallisto), 3));
    const Material material =
        testing_support::random_full_material(model, effects_of(model).without(Effect::kAnisotropic), 8);
    const double expected = evaluate(material, table).table.log_ratio_pct;
    // Cells on the horizon's edge are in neither.
    const SampleSet all = sample_table(table, kAllSamples, 1, {});
    EXPECT_NEAR(log_ratio_pct(material, all), expected, 1e-4 * expected) << name_of(model);
  }
}

TEST(HeldOutError, OfADifferenceHasTheStandardErrorOfPairs) {
  const HeldOut a = {2.0, {1.0, 2.0, 3.0}};
  EXPECT_EQ(standard_error_of_difference(a, {3.0, {2.0, 3.0, 4.0}}), 0.0);
  // Differences 0, 1, 2: standard deviation 1.
  EXPECT_NEAR(standard_error_of_difference(a, {3.0, {1.0, 3.0, 5.0}}), 1.0 / std::sqrt(3.0), 1e-15);
}

// Every cell that a fold holds out is replaced by nonsense: none of its fits may notice.
TEST(CrossValidation, NeverLooksAtWhatItHoldsOut) {
  const MeasuredTable table = noisy_table(callisto_with(effects_of(Model::kCallisto), 5), 0.01, 5);
  const CrossValidation::Request base = {Groups(), {}, 2};
  const CrossValidation::Request next = {every_group(Model::kCallisto), {{Groups(), {}}, {Groups(), {}}}, 1};
  CrossValidation validation = testing_support::validation_of(table, Model::kCallisto);
  validation.fit({base});
  validation.fit({next});
  for (std::size_t fold = 0; fold < validation.folds().size(); ++fold) {
    std::vector<float> planes;
    for (int c = 0; c < 3; ++c) planes.insert(planes.end(), table.plane(c).begin(), table.plane(c).end());
    const AngleBlocks blocks(table.grid(), 5, 1);
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const std::size_t cell = k % table.grid().cell_count();
      if (planes[k] >= 0.0F && blocks.fold_of(cell) == static_cast<int>(fold)) planes[k] = 7.0F;
    }
    CrossValidation blind =
        testing_support::validation_of(MeasuredTable(table.grid(), planes), Model::kCallisto);
    blind.fit({base});
    blind.fit({next});
    for (const Groups groups : {base.groups, next.groups}) {
      EXPECT_EQ(blind.materials(groups)[fold], validation.materials(groups)[fold]);
      EXPECT_GT(blind.held_out(groups).folds_pct[fold], validation.held_out(groups).folds_pct[fold]);
    }
  }
}

TEST(CrossValidation, KeepsTheBetterFitOfASet) {
  const MeasuredTable table = noisy_table(callisto_with(effects_of(Model::kCallisto), 6), 0.01, 6);
  CrossValidation validation = testing_support::validation_of(table, Model::kCallisto);
  const Groups all = every_group(Model::kCallisto);
  validation.fit({{all, {}, 1}});
  double cost = validation.cost(all);
  for (int starts = 2; starts < 8; ++starts) {
    validation.fit({{all, {}, starts}});
    EXPECT_LE(validation.cost(all), cost);
    cost = validation.cost(all);
  }
}

TEST(Selection, FindsTheEffectsOfAMaterial) {
  for (const Model model : {Model::kBurley, Model::kCallisto}) {
    for (std::uint64_t seed = 500; seed < 505; ++seed) {
      const Study study = make_study(model, Tier::kFull, 3.0 * kGroupThreshold, seed);
      const Selection selection = select_all(study.table, model);
      EXPECT_EQ(effects_of_groups(model, selection.chosen), study.effects) << name_of(model) << " " << seed;
    }
  }
}

TEST(Selection, OfAMaterialWithoutEffectsIsEmpty) {
  for (const Model model : {Model::kBurley, Model::kCallisto}) {
    const Selection selection = select_all(noisy_table(Material(model), 0.01, 2), model);
    EXPECT_TRUE(selection.chosen.empty()) << name_of(model);
    EXPECT_TRUE(selection.ladder.empty());
    EXPECT_EQ(selection.parameters, 6);
  }
}

// Tables that no set of effects explains: Burley's by Callisto and the other way round.
TEST(Selection, IsNeverWorseThanEverythingByMoreThanTheThreshold) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (const Model model : {Model::kBurley, Model::kCallisto}) {
      const Model other = model == Model::kBurley ? Model::kCallisto : Model::kBurley;
      const Material material =
          testing_support::random_full_material(other, effects_of(other).without(Effect::kAnisotropic), seed);
      for (const double threshold : {0.003, 0.05}) {
        const Selection selection = select_all(noisy_table(material, 0.01, seed), model, threshold);
        EXPECT_LE(selection.held_out.log_ratio_pct, (1.0 + threshold) * selection.held_out_all.log_ratio_pct);
      }
    }
  }
}

// What a material costs on samples under the loss of the folds.
double cost_of(const Material& material, Groups groups, const SampleSet& samples) {
  const Model model = material.model();
  const Parametrisation parametrisation =
      make_parametrisation(Material(model), {Tier::kFull, effects_of_groups(model, groups), {}, groups});
  const Targets targets = make_targets(samples, Loss::kLogRatio);
  return Problem(parametrisation, samples, targets, Loss::kLogRatio)
      .cost(parametrisation.from_material(material));
}

TEST(Selection, HasAMaterialForEveryStepThatFitsAllSamplesAtLeastAsWellAsAnyFold) {
  const MeasuredTable table = noisy_table(callisto_with(effects_of(Model::kCallisto), 11), 0.01, 11);
  CrossValidation validation = testing_support::validation_of(table, Model::kCallisto);
  Selection selection =
      select_groups(validation, Model::kCallisto, {every_group(Model::kCallisto), {}, kGroupThreshold});
  const SampleSet samples = sample_table(table, 2000, 1, {});
  fit_ladder(validation, samples, selection);
  ASSERT_GT(selection.ladder.size(), 1U);
  const auto check = [&](const Material& material, Groups set) {
    EXPECT_EQ(material.effects(), effects_of_groups(Model::kCallisto, set));
    EXPECT_TRUE(material.is_valid(nullptr));
    for (const ParameterInfo& info : parameters_of(Model::kCallisto)) {
      const auto group = group_of_parameter(Model::kCallisto, info.name);
      if (!group || set.has(*group)) continue;
      EXPECT_EQ(material.number(info.name), info.default_value) << info.name;
    }
    const double cost = cost_of(material, set, samples);
    for (const Material& of_fold : validation.materials(set)) {
      EXPECT_LE(cost, cost_of(of_fold, set, samples) * (1.0 + 1e-12));
    }
  };
  check(selection.material_without, selection.required);
  for (const LadderStep& step : selection.ladder) check(step.material, step.set);
}

TEST(Selection, HoldsALadderFromItsBeginningToItsEnd) {
  const MeasuredTable table = noisy_table(callisto_with(effects_of(Model::kCallisto), 9), 0.01, 9);
  const Selection selection = select_all(table, Model::kCallisto);
  ASSERT_FALSE(selection.ladder.empty());
  Groups set = selection.required;
  double error = selection.held_out_without.log_ratio_pct;
  int parameters = selection.parameters_without;
  for (const LadderStep& step : selection.ladder) {
    Groups moved;
    for (const std::string& name : step.groups) moved = moved.with(*group_by_name(Model::kCallisto, name));
    set = step.removed ? set.without(moved) : set | moved;
    EXPECT_EQ(step.set, set);
    EXPECT_EQ(step.held_out_before_pct, error);
    error = step.held_out_after_pct;
    EXPECT_EQ(step.parameters < 0, step.removed);
    parameters += step.parameters;
  }
  EXPECT_EQ(set, selection.chosen);
  EXPECT_EQ(error, selection.held_out.log_ratio_pct);
  EXPECT_EQ(parameters, selection.parameters);
}

TEST(Selection, KeepsWhatIsRequired) {
  const MeasuredTable table = noisy_table(Material(Model::kLambertGgx), 0.01, 2);
  CrossValidation validation = testing_support::validation_of(table, Model::kCallisto);
  const Groups required = groups_by_names(Model::kCallisto, std::vector<std::string>{"retroreflection_tint"});
  const Selection selection =
      select_groups(validation, Model::kCallisto, {every_group(Model::kCallisto), required, 0.01});
  EXPECT_EQ(selection.chosen, required);
}

TEST(Selection, DoesNotDependOnTheNumberOfThreads) {
  const MeasuredTable table = noisy_table(callisto_with(effects_of(Model::kCallisto), 12), 0.01, 1);
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    FitOptions options;
    options.choose_groups = true;
    options.samples = 4000;
    return fit(table, options);
  };
  const FitResult one = run(1);
  const FitResult two = run(2);
  ASSERT_TRUE(one.selection && two.selection);
  EXPECT_EQ(one.selection->chosen, two.selection->chosen);
  EXPECT_EQ(one.selection->held_out.folds_pct, two.selection->held_out.folds_pct);
  EXPECT_EQ(one.selection->held_out_all.folds_pct, two.selection->held_out_all.folds_pct);
  EXPECT_EQ(one.material, two.material);
}

TEST(FitWithChosenEffects, HasThoseAloneInItsMaterial) {
  const Effects effects = Effects().with(Effect::kDualSpecular).with(Effect::kDiffuseFresnel);
  const MeasuredTable table = noisy_table(callisto_with(effects, 4), 0.01, 4);
  FitOptions options;
  options.choose_groups = true;
  options.samples = 4000;
  const FitResult result = fit(table, options);
  ASSERT_TRUE(result.selection);
  EXPECT_EQ(result.material.effects(), effects);
  EXPECT_EQ(result.groups, result.selection->chosen);
  EXPECT_EQ(result.free_parameters, result.selection->parameters);
  EXPECT_EQ(result.options.groups, std::nullopt);
  EXPECT_TRUE(result.options.choose_groups);
  EXPECT_GT(result.timings.select_seconds, 0.0);
}

TEST(FitWithChosenEffects, LeavesOffWhatTheTierLacks) {
  const MeasuredTable table = noisy_table(callisto_with(effects_of(Model::kCallisto), 4), 0.01, 4);
  FitOptions options;
  options.choose_groups = true;
  options.samples = 3000;
  options.tier = Tier::kBase;
  const FitResult result = fit(table, options);
  const Groups base = usable_groups(Model::kCallisto, Tier::kBase, effects_of(Model::kCallisto));
  EXPECT_TRUE(base.has_all(result.groups));
  EXPECT_EQ(result.material.colour("retroreflection_tint"), (Rgb{1.0, 1.0, 1.0}));
}

TEST(FitWithChosenEffects, KeepsTheEffectsOfFixedParameters) {
  const MeasuredTable table = noisy_table(Material(Model::kLambertGgx), 0.01, 4);
  FitOptions options;
  options.choose_groups = true;
  options.samples = 3000;
  options.fixed["smooth_terminator_length"] = {0.25};
  const FitResult result = fit(table, options);
  EXPECT_TRUE(result.material.effects().has(Effect::kSmoothTerminator));
  EXPECT_EQ(result.material.number("smooth_terminator_length"), 0.25);
}

// A material whose terminator the table shows.
MeasuredTable softened() {
  Material material(Model::kCallisto);
  material.set_effects(Effects().with(Effect::kSmoothTerminator));
  material.set("smooth_terminator", 0.8);
  material.set("smooth_terminator_length", 0.9);
  return noisy_table(material, 0.01, 3);
}

FitOptions on_slice() {
  FitOptions options;
  options.choose_groups = true;
  options.on = FitOn::kSlices;
  return options;
}

TEST(FitToTheSliceAt90, LeavesTheTerminatorAtItsDefaultAndSaysSo) {
  const FitResult result = fit(softened(), on_slice());
  EXPECT_FALSE(result.material.effects().has(Effect::kSmoothTerminator));
  EXPECT_EQ(result.material.number("smooth_terminator"), 0.0);
  EXPECT_THAT(result.notes, testing::Contains(HasSubstr("does not show the smooth terminator")));
  EXPECT_THAT(result.notes, testing::Contains(HasSubstr(fmt::format("{:.1f}% on the whole table",
                                                                    result.evaluation.table.log_ratio_pct))));
}

TEST(FitToTheSliceAt90, MayUseTheTerminatorWhenTold) {
  FitOptions options = on_slice();
  options.groups = groups_by_names(Model::kCallisto, std::vector<std::string>{"smooth_terminator"});
  const FitResult told = fit(softened(), options);
  EXPECT_TRUE(told.material.effects().has(Effect::kSmoothTerminator));
  EXPECT_THAT(told.notes, Each(testing::Not(HasSubstr("does not show the smooth terminator"))));
}

TEST(FitToOtherSlices, MayUseTheTerminator) {
  FitOptions options = on_slice();
  options.phi_d_deg = {0.0, 90.0};
  const FitResult result = fit(softened(), options);
  EXPECT_TRUE(result.material.effects().has(Effect::kSmoothTerminator));
}

}  // namespace
}  // namespace brdfit::fit
