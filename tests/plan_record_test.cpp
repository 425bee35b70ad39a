// Plans and evidence through bytes: the same to the last bit, and nothing else passes for them.
#include "bake/plan_record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "bake/record.h"
#include "data/synthetic/stack.h"

namespace brdfit::bake {
namespace {

// Everything that a plan can hold: gains, a material, lobes that were chosen and others to compare with.
struct Made {
  synthetic::SyntheticStack stack;
  TexelBlock block;
  BakeSettings settings;
  BakePlan plan;

  Made() : stack(recipe()), block(stack.read_rows(0, stack.info().height)) {
    settings.base = BaseKind::kMaterial;
    settings.model = Model::kLambertGgx;
    settings.gains = true;
    settings.lobes = 3;
    settings.also_lobes = {2};
    plan = plan_bake(stack.info(), block, all_lights(stack.info()), settings);
    plan.warnings.push_back({"a-name", "a message"});
  }

  static synthetic::StackRecipe recipe() {
    synthetic::StackRecipe recipe;
    recipe.name = "bumps";
    recipe.width = 12;
    recipe.height = 10;
    recipe.shape.slope = 0.5;
    recipe.shape.wavelength_px = 8;
    Material material(Model::kLambertGgx);
    material.set("base_color", Rgb{0.5, 0.4, 0.3});
    recipe.materials = {material};
    recipe.cast_shadows = false;
    recipe.lights.count = 20;
    recipe.residual = {4, 6.0, 180.0, 0.15};
    return recipe;
  }
};

TEST(PlanRecord, BringsEveryBitBack) {
  const Made made;
  ASSERT_TRUE(made.plan.system);
  ASSERT_TRUE(made.plan.material);
  ASSERT_TRUE(made.plan.gain_estimate);
  ASSERT_TRUE(made.plan.lobe_choice);
  ASSERT_EQ(made.plan.also.size(), 1U);
  const std::vector<std::byte> record = plan_record(made.plan);
  const BakePlan back = plan_of_record(record);
  EXPECT_EQ(plan_record(back), record);
  EXPECT_EQ(back.lights, made.plan.lights);
  EXPECT_EQ(back.gains, made.plan.gains);
  EXPECT_EQ(back.base.material, made.plan.base.material);
  EXPECT_EQ(back.base.robust_width, made.plan.base.robust_width);
  EXPECT_EQ(back.material->parameters.size(), made.plan.material->parameters.size());
  EXPECT_EQ(back.system->lobes(), made.plan.system->lobes());
  EXPECT_EQ(back.system->penalty(), made.plan.system->penalty());
  EXPECT_EQ(back.system->packed().mixes, made.plan.system->packed().mixes);
  EXPECT_EQ(back.lobe_choice->error_without(), made.plan.lobe_choice->error_without());
  EXPECT_EQ(back.warnings.back().message, "a message");
}

TEST(PlanRecord, BakesTheSameTexels) {
  const Made made;
  const BakePlan back = plan_of_record(plan_record(made.plan));
  const BakedBlock expected = bake_block(made.stack.info(), made.block, made.plan, made.settings);
  const BakedBlock found = bake_block(made.stack.info(), made.block, back, made.settings);
  EXPECT_EQ(found.surface.albedo, expected.surface.albedo);
  EXPECT_EQ(found.solved[0].amplitudes, expected.solved[0].amplitudes);
  EXPECT_EQ(found.solved[0].confidence, expected.solved[0].confidence);
}

TEST(PlanRecord, KeepsAPlanWithoutAnything) {
  const BakePlan back = plan_of_record(plan_record({}));
  EXPECT_FALSE(back.system);
  EXPECT_FALSE(back.material);
  EXPECT_FALSE(back.base.material);
  EXPECT_TRUE(back.candidates.empty());
}

TEST(PlanRecord, LeavesNothingOutThatIsCutShortAndTakesNothingThatIsTooLong) {
  const Made made;
  std::vector<std::byte> record = plan_record(made.plan);
  for (std::size_t size = 0; size < record.size(); size += 7) {
    EXPECT_ANY_THROW(plan_of_record(std::span(record).first(size))) << size;
  }
  record.push_back(std::byte{0});
  EXPECT_THROW(plan_of_record(record), BadRecord);
  // A length that no memory could hold.
  std::vector<std::byte> huge(8, std::byte{0x7f});
  EXPECT_THROW(plan_of_record(huge), BadRecord);
}

void expect_evidence_through_records(const Made& made, RealisColour colour) {
  BakeSettings settings;
  settings.colour = colour;
  settings.base = BaseKind::kLambert;
  settings.optimise = false;
  settings.lobes = 2;
  const BakePlan plan = plan_bake(made.stack.info(), made.block, all_lights(made.stack.info()),
                                  with_compared_lobes(settings, {}));
  EvidenceOptions options;
  options.folds = 3;
  const Evidence expected = evaluate(made.stack.info(), made.block, plan, settings, options);
  std::map<int, std::vector<std::byte>> kept;
  options.fold_of = [&](int fold, const std::function<FoldEvidence()>& make) {
    kept[fold] = fold_record(make());
    return fold_of_record(kept[fold]);
  };
  EXPECT_EQ(evidence_record(evaluate(made.stack.info(), made.block, plan, settings, options)),
            evidence_record(expected));
  ASSERT_EQ(kept.size(), 3U);
  int made_anew = 0;
  options.fold_of = [&](int fold, const std::function<FoldEvidence()>& make) {
    if (fold == 1) return fold_of_record(kept[fold]);
    ++made_anew;
    return make();
  };
  EXPECT_EQ(evidence_record(evaluate(made.stack.info(), made.block, plan, settings, options)),
            evidence_record(expected));
  EXPECT_EQ(made_anew, 2);
  EXPECT_EQ(evidence_record(evidence_of_record(evidence_record(expected))), evidence_record(expected));
}

TEST(PlanRecord, EvidenceFromFoldsThatAreReadBackIsTheSame) {
  const Made made;
  expect_evidence_through_records(made, RealisColour::kLuminance);
  expect_evidence_through_records(made, RealisColour::kRgb);
}

TEST(PlanRecord, KeepsNumbersThatTextDoesNot) {
  std::vector<RealisRange> ranges = {{std::numeric_limits<double>::quiet_NaN(), 3}, {-0.0, -1}, {5e-324, 0}};
  const std::vector<std::byte> record = ranges_record(ranges);
  EXPECT_EQ(ranges_record(ranges_of_record(record)), record);
  EXPECT_TRUE(std::signbit(ranges_of_record(record)[1].step));
}

}  // namespace
}  // namespace brdfit::bake
