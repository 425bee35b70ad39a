// The sweep of a light stack says what `brdfit bake` and its evidence say, and writes what it chose.
#include "cli/cost/stack_sweep.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <numeric>
#include <set>
#include <stdexcept>

#include "bake/evidence.h"
#include "cli/bake_stack.h"
#include "cli/threads.h"
#include "data/synthetic/stack_files.h"
#include "io/realis_json.h"
#include "tests/temp_folder.h"

namespace brdfit::cli {
namespace {

constexpr int kFolds = 2;

TEST(StackChoice, SettingsAreReadBackAndNamesAndChoicesAreThoseOfOnePointEach) {
  for (const bool quick : {false, true}) {
    std::set<std::string> names;
    const std::vector<PlannedChoice> plan = plan_choices(Model::kCallisto, std::nullopt, quick);
    EXPECT_EQ(plan.front().sweep, "default");
    EXPECT_GE(plan.size(), quick ? 10U : 30U);
    for (const PlannedChoice& planned : plan) {
      EXPECT_TRUE(names.insert(planned.name).second) << planned.name;
      CostPoint point;
      point.settings = settings_of(planned.choice);
      EXPECT_EQ(choice_of(point), planned.choice) << planned.name;
      EXPECT_GE(planned.choice.dominant, 1);
      EXPECT_LE(planned.choice.dominant, planned.choice.lobes);
    }
  }
  EXPECT_THROW(choice_of(CostPoint()), std::invalid_argument);
}

TEST(StackChoice, BytesAreThoseOfTheTexturesSpreadOverThePicture) {
  StackInfo info;
  info.width = 8;
  info.height = 6;
  StackChoice choice;
  EXPECT_EQ(choice.bytes_per_texel(info), 8.0);
  choice.bits = bake::AmplitudeBits::kHalf;
  EXPECT_EQ(choice.bytes_per_texel(info), 16.0);
  choice.bits = bake::AmplitudeBits::k4;
  choice.dominant = 2;
  EXPECT_EQ(choice.bytes_per_texel(info), 2.0);
  choice.shrink = 2;
  EXPECT_EQ(choice.bytes_per_texel(info), 0.5);
}

// One small stack and its sweep, for all tests.
class StackSweepTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new tests::TempFolder;
    synthetic::StackRecipe recipe;
    recipe.name = "bumps";
    recipe.width = 14;
    recipe.height = 10;
    recipe.shape.slope = 0.4;
    recipe.shape.wavelength_px = 12;
    Material material(Model::kLambertGgx);
    material.set("base_color", Rgb{0.6, 0.4, 0.3});
    material.set("specular", 0.0);
    recipe.materials = {material};
    recipe.cast_shadows = false;
    recipe.lights.count = 24;
    recipe.lights.theta_deg = 60;
    recipe.residual = {4, 6.0, 180.0, 0.2};
    synthetic::write_stack(recipe, folder_->path());
    options_ = new StackSweepOptions;
    options_->bake.stack = (*folder_ / "bumps.olat.json").string();
    options_->bake.base = "lambert";
    options_->bake.model = "lambert-ggx";
    options_->bake.folds = kFolds;
    options_->bake.common.quiet = true;
    options_->bake.common.force = true;
    options_->quick = true;
    run_ = new CostRun(sweep_stack(*options_));
  }
  static void TearDownTestSuite() {
    delete run_;
    delete options_;
    delete folder_;
  }

  static const CostPoint& point(const std::string& sweep) {
    return *std::ranges::find(run_->points, sweep, &CostPoint::sweep);
  }
  static double error(const std::string& sweep, const std::string& key) {
    return error_of(point(sweep), key);
  }

  static tests::TempFolder* folder_;
  static StackSweepOptions* options_;
  static CostRun* run_;
};
tests::TempFolder* StackSweepTest::folder_ = nullptr;
StackSweepOptions* StackSweepTest::options_ = nullptr;
CostRun* StackSweepTest::run_ = nullptr;

TEST_F(StackSweepTest, EveryPointHasEveryFigure) {
  EXPECT_EQ(run_->kind, "stack");
  EXPECT_EQ(run_->input, "bumps.olat.json");
  const auto devices =
      static_cast<std::size_t>(std::ranges::count(run_->points, "device", &CostPoint::sweep));
  EXPECT_GE(devices, 1U);
  ASSERT_EQ(run_->points.size() - devices, plan_choices(std::nullopt, Model::kLambertGgx, true).size());
  for (const CostPoint& point : run_->points) {
    for (const std::string& key : stack_error_keys()) {
      EXPECT_TRUE(std::isfinite(error_of(point, key))) << point.name << " " << key;
    }
    EXPECT_EQ(point.errors.size(), stack_error_keys().size());
    EXPECT_GT(point.make_seconds.median, 0.0);
    EXPECT_GT(point.evaluation_ns.median, 0.0);
    EXPECT_GT(point.bytes, 0.0);
  }
}

// Of a bake of that colour, which plans everything for itself.
bake::Evidence evidence_of_bake(BakeArguments arguments, const std::string& colour) {
  BakeStack stack(arguments, true);
  std::vector<std::uint32_t> all(stack.info().texel_count());
  std::iota(all.begin(), all.end(), 0U);
  const TexelBlock sample = stack.read_texels(all);
  arguments.lobes = "8";
  arguments.colour = colour;
  const bake::BakeSettings settings = bake_settings_of(arguments);
  bake::EvidenceOptions options;
  options.folds = kFolds;
  const bake::BakePlan plan = bake::plan_bake(stack.info(), sample, bake::all_lights(stack.info()), settings);
  return bake::evaluate(stack.info(), sample, plan, settings, options);
}

TEST_F(StackSweepTest, ErrorsOfLuminanceAreThoseOfTheEvidenceOfABake) {
  const bake::Evidence evidence = evidence_of_bake(options_->bake, "luminance");
  for (const auto& [sweep, method] :
       {std::pair("default", "realis-8bit"), {"bits", "realis-4bit"}, {"dominant", "realis-m4-8bit"}}) {
    const bake::MethodEvidence& expected = *evidence.find(method);
    EXPECT_NEAR(error(sweep, "held_out_rmse_255") / expected.held_out.rmse_255, 1.0, 1e-4) << method;
    EXPECT_NEAR(error(sweep, "held_out_lit_rmse_255") / expected.held_out.lit_rmse_255, 1.0, 1e-4) << method;
    EXPECT_NEAR(error(sweep, "held_out_worst_light_rmse_255") / expected.held_out.worst_light_rmse_255, 1.0,
                1e-4)
        << method;
    EXPECT_NEAR(error(sweep, "train_rmse_255") / expected.train.rmse_255, 1.0, 1e-4) << method;
    EXPECT_EQ(point(sweep).bytes, expected.bytes_per_texel) << method;
  }
}

TEST_F(StackSweepTest, ErrorsOfColourAreThoseOfTheEvidenceOfABake) {
  for (const std::string colour : {"scaled-chroma", "rgb"}) {
    const bake::MethodEvidence expected = *evidence_of_bake(options_->bake, colour).find("realis-8bit");
    const CostPoint& found = *std::ranges::find_if(
        run_->points, [&](const CostPoint& p) { return setting_of(p, "colour") == colour; });
    const auto expect_near = [&](const char* key, double figure) {
      EXPECT_NEAR(error_of(found, key) / figure, 1.0, 1e-4) << colour << " " << key;
    };
    expect_near("held_out_rgb_rmse_255", expected.rgb->held_out.rmse_255);
    expect_near("train_rgb_rmse_255", expected.rgb->train.rmse_255);
    expect_near("held_out_rmse_255", expected.held_out.rmse_255);
    expect_near("held_out_worst_light_rmse_255", expected.held_out.worst_light_rmse_255);
    EXPECT_EQ(found.bytes, expected.bytes_per_texel) << colour;
  }
}

TEST_F(StackSweepTest, MoreIsNoWorseWhereNothingIsHeldOut) {
  const double chosen = error("default", "train_rgb_rmse_255");
  EXPECT_LT(chosen, error("bits", "train_rgb_rmse_255"));
  EXPECT_LT(chosen, error("lobes", "train_rgb_rmse_255"));
  EXPECT_LT(chosen, error("dominant", "train_rgb_rmse_255"));
  const CostPoint& rgb = *std::ranges::find_if(
      run_->points, [](const CostPoint& p) { return setting_of(p, "colour") == "rgb"; });
  EXPECT_LT(error_of(rgb, "train_rgb_rmse_255"), chosen);
}

// Points share plans in the sweep, and have one of their own when they are measured alone.
TEST_F(StackSweepTest, APointMeasuredAgainHasTheSameErrorsForAnyNumberOfThreads) {
  const ThreadLimit one(1);
  for (const char* sweep : {"ridge-factor", "shrink"}) {
    const CostPoint again = measure_stack_choice(point(sweep), *options_);
    EXPECT_EQ(again.name, point(sweep).name);
    EXPECT_EQ(again.bytes, point(sweep).bytes);
    for (std::size_t k = 0; k < again.errors.size(); ++k) {
      EXPECT_EQ(again.errors[k], point(sweep).errors[k]) << again.name << " " << again.errors[k].first;
    }
  }
}

TEST_F(StackSweepTest, WhatIsWrittenIsTheChoice) {
  for (const CostPoint& point : run_->points) {
    const StackChoice choice = choice_of(point);
    if (choice.base || point.sweep == "device") continue;
    const std::filesystem::path to = *folder_ / "baked";
    ASSERT_EQ(write_stack_choice(point, *options_, to), kDone) << point.name;
    const RealisAsset asset = io::read_realis(to / "bumps.realis.json");
    EXPECT_EQ(static_cast<int>(asset.lobes.size()), choice.lobes) << point.name;
    EXPECT_EQ(asset.packing.dominant, choice.dominant) << point.name;
    EXPECT_EQ(asset.colour, choice.colour) << point.name;
    EXPECT_EQ(asset.width, (14 + choice.shrink - 1) / choice.shrink) << point.name;
    if (!choice.is_code()) continue;
    EXPECT_EQ(asset.packing.bits, static_cast<int>(choice.bits)) << point.name;
    EXPECT_NEAR(asset.bytes_per_texel() * static_cast<double>(asset.texel_count()) / (14.0 * 10.0),
                point.bytes, 1e-9)
        << point.name;
  }
}

TEST_F(StackSweepTest, RidgesAreHeldAgainstThatOfTheDefault) {
  const auto penalty_of = [&](const CostPoint& point) {
    EXPECT_EQ(write_stack_choice(point, *options_, *folder_ / "ridges"), kDone);
    return *io::read_realis(*folder_ / "ridges" / "bumps.realis.json").penalty;
  };
  EXPECT_NEAR(penalty_of(point("ridge-factor")) / penalty_of(point("default")), 10.0, 1e-9);
}

}  // namespace
}  // namespace brdfit::cli
