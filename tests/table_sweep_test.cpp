// cli/cost/table_sweep.h and sweep_plan.h: what is planned, and what a point holds.
#include "cli/cost/table_sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fit/held_out.h"
#include "tests/fit_data.h"

namespace brdfit::cli {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing_support::random_full_material;
using testing_support::table_of;

constexpr Grid kTinyGrid = {16, 16, 24, CellAnchor::kLowerEdge};

TEST(SweepPlan, NamesAreUniqueAndTheDefaultIsFirst) {
  for (const bool quick : {false, true}) {
    const std::vector<PlannedFit> plan = plan_fits({}, quick);
    std::set<std::string> names;
    for (const PlannedFit& planned : plan) EXPECT_TRUE(names.insert(planned.name).second) << planned.name;
    EXPECT_EQ(plan.front().sweep, "default");
    EXPECT_EQ(std::ranges::count(plan, "default", &PlannedFit::sweep), 1);
  }
  EXPECT_LT(plan_fits({}, true).size(), plan_fits({}, false).size() / 2);
}

TEST(SweepPlan, EveryChoiceOfAFitIsSwept) {
  std::set<std::string> sweeps;
  for (const PlannedFit& planned : plan_fits({}, false)) sweeps.insert(planned.sweep);
  EXPECT_THAT(sweeps, testing::IsSupersetOf({"model", "tier", "effects", "samples", "starts", "loss", "on"}));
}

TEST(SweepPlan, EveryEffectIsTriedAloneAndLeftOut) {
  std::set<std::string> names;
  for (const PlannedFit& planned : plan_fits({}, false)) names.insert(planned.name);
  for (const char* effect : {"specular_fresnel_falloff", "diffuse_fresnel", "retroreflection",
                             "smooth_terminator", "dual_specular"}) {
    EXPECT_TRUE(names.contains(std::string("callisto full, only ") + effect)) << effect;
    EXPECT_TRUE(names.contains(std::string("callisto full, without ") + effect)) << effect;
  }
  for (const char* effect : {"subsurface", "specular_tint", "sheen", "clearcoat"}) {
    EXPECT_TRUE(names.contains(std::string("burley, without ") + effect)) << effect;
  }
}

TEST(SweepPlan, WhatHoldsForAllIsKept) {
  FitArguments common;
  common.seed = 7;
  common.max_theta_deg = 80.0;
  for (const PlannedFit& planned : plan_fits(common, false)) {
    EXPECT_EQ(planned.options.seed, 7U);
    EXPECT_EQ(planned.options.max_theta_deg, 80.0);
    EXPECT_THAT(fit_command(planned.arguments, "a.binary"), HasSubstr("--seed 7 --max-theta 80"));
  }
}

TEST(StoredBytes, CountNumbersThatLeaveTheirDefaultsOfEffectsThatAreOn) {
  Material material(Model::kCallisto);
  EXPECT_EQ(stored_bytes(material), 0.0);
  material.set("roughness", 0.3);
  EXPECT_EQ(stored_bytes(material), 4.0);
  material.set("base_color", Rgb{0.1, 0.18, 0.18});
  EXPECT_EQ(stored_bytes(material), 16.0);
  material.set("dual_specular_opacity", 0.5);
  EXPECT_EQ(stored_bytes(material), 16.0);
  material.set_effects(Effects().with(Effect::kDualSpecular));
  EXPECT_EQ(stored_bytes(material), 20.0);
}

// A sweep of a few points of a tiny table.
class TableSweep : public testing::Test {
 protected:
  TableSweep() {
    options_.repeats = 2;
    options_.folds = 2;
    for (const PlannedFit& planned : plan_fits({}, true)) {
      if (planned.name == "callisto full, all effects" || planned.name == "lambert-ggx")
        plan_.push_back(planned);
    }
    for (PlannedFit& planned : plan_) planned.options.starts = 2;
  }

  CostRun sweep() const {
    const TableMeter meter(table_, plan_, evaluators_);
    Progress silent(0, true);
    return sweep_table(meter, "tiny.binary", plan_, options_, silent);
  }

  MeasuredTable table_ =
      table_of(random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 3), kTinyGrid);
  Evaluators evaluators_ = [] {
    // Without a device, which may be absent.
    Evaluators all = run_time_evaluators("");
    std::erase_if(all.all, [](const Evaluator& one) { return one.device.starts_with("Vulkan"); });
    return all;
  }();
  // The first so many points, once, without folds: for what does not look at the rest.
  void shorten(std::size_t points) {
    plan_.resize(points);
    options_.repeats = 1;
    options_.folds = 0;
  }

  std::vector<PlannedFit> plan_;
  TableSweepOptions options_;
};

TEST_F(TableSweep, EveryPointHoldsEveryErrorAndFigure) {
  const CostRun run = sweep();
  ASSERT_EQ(run.points.size(), plan_.size() + evaluators_.all.size());
  EXPECT_GT(run.reference_seconds.median, 0.0);
  for (std::size_t k = 0; k < plan_.size(); ++k) {
    const CostPoint& point = run.points[k];
    std::vector<std::string> keys;
    for (const auto& [key, value] : point.errors) {
      keys.push_back(key);
      EXPECT_TRUE(std::isfinite(value) && value >= 0.0) << key;
    }
    EXPECT_EQ(keys, table_error_keys(options_.folds));
    EXPECT_EQ(point.make_seconds.repeats, 2);
    EXPECT_GT(point.make_seconds.median, 0.0);
    EXPECT_GT(point.evaluation_ns.low_quartile, 0.0);
    EXPECT_GT(point.free_numbers, 0.0);
    EXPECT_GT(point.observations, 0.0);
  }
}

TEST_F(TableSweep, ErrorsAreThoseOfTheFitsAndHeldOutErrorsThoseOfFitsWithoutTheFold) {
  options_.repeats = 1;
  const CostRun run = sweep();
  for (std::size_t k = 0; k < plan_.size(); ++k) {
    fit::FitOptions options = plan_[k].options;
    options.held_out_folds = options_.folds;
    const fit::FitResult fitted = fit::fit(table_, options);
    EXPECT_EQ(error_of(run.points[k], "table_log_ratio_pct"), fitted.evaluation.table.log_ratio_pct);
    EXPECT_EQ(error_of(run.points[k], "slice_srgb"), fitted.evaluation.slice.srgb);
    const fit::HeldOutEvaluation held_out = fit::evaluate_held_out(table_, options, fit_part);
    EXPECT_EQ(error_of(run.points[k], "held_out_log_ratio_pct"),
              fit::over_folds(held_out, &fit::Evaluation::table, &fit::Measures::log_ratio_pct).mean);
  }
}

TEST_F(TableSweep, EveryEvaluatorShowsTheSameMaterial) {
  shorten(1);
  const CostRun run = sweep();
  const double error = error_of(run.points.front(), "table_log_ratio_pct");
  for (const CostPoint& point : run.points) {
    if (point.sweep != "device") continue;
    // The values pass through a table of floats, and directions through floats.
    EXPECT_NEAR(error_of(point, "table_log_ratio_pct"), error, 1e-3 * error + 1e-3) << point.name;
    EXPECT_FALSE(point.on_run_front || point.on_make_front);
  }
}

TEST_F(TableSweep, APointThatCannotBeFittedIsLeftOutWithANote) {
  std::ranges::reverse(plan_);
  shorten(1);
  PlannedFit hopeless = plan_.back();
  hopeless.name = "hopeless";
  hopeless.options.samples = 0;
  plan_.push_back(hopeless);
  const CostRun run = sweep();
  EXPECT_EQ(std::ranges::count(run.points, "hopeless", &CostPoint::name), 0);
  EXPECT_THAT(run.notes, testing::Contains(HasSubstr("hopeless is left out: ")));
}

}  // namespace
}  // namespace brdfit::cli
