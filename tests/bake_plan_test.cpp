// Stacks with known answers through the whole of a bake: what must come back, and what must not be made
// worse.
#include "bake/plan.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "bake/capture_warnings.h"
#include "bake/evidence.h"
#include "bake/luminance.h"
#include "data/synthetic/stack.h"

namespace brdfit {
namespace {

using bake::BakePlan;
using bake::BakeSettings;
using synthetic::StackRecipe;
using synthetic::SyntheticStack;

StackRecipe matte_bumps() {
  StackRecipe recipe;
  recipe.name = "bumps";
  recipe.width = 24;
  recipe.height = 16;
  recipe.shape.slope = 0.5;
  recipe.shape.wavelength_px = 12;
  Material material(Model::kLambertGgx);
  material.set("base_color", Rgb{0.5, 0.4, 0.3});
  material.set("specular", 0.0);
  recipe.materials = {material};
  recipe.albedo_variation = 0.5;
  recipe.cast_shadows = false;
  recipe.lights.count = 40;
  recipe.lights.theta_deg = 70;
  recipe.residual = {4, 6.0, 180.0, 0.15};
  return recipe;
}

TexelBlock all_of(SyntheticStack& stack) {
  return stack.read_rows(0, stack.info().height);
}

BakeSettings lambert_with(int lobes) {
  BakeSettings settings;
  settings.base = bake::BaseKind::kLambert;
  settings.lobes = lobes;
  return settings;
}

TEST(Bake, BringsKnownAmplitudesBack) {
  StackRecipe recipe = matte_bumps();
  recipe.files.give_normals = true;
  recipe.files.give_albedo = true;
  SyntheticStack stack(recipe);
  const TexelBlock block = all_of(stack);
  BakeSettings settings;
  settings.given_lobes = stack.lobes();
  BakePlan plan;
  plan.lights = bake::all_lights(stack.info());
  plan.gains.assign(plan.lights.size(), 1.0);
  plan.base.material = recipe.materials[0];
  plan_lobes(plan, stack.info(), block, settings);
  ASSERT_TRUE(plan.system);
  const bake::BakedBlock baked = bake_block(stack.info(), block, plan, settings);
  double largest = 0.0;
  for (std::size_t k = 0; k < block.count(); ++k) {
    for (std::size_t lobe = 0; lobe < 4; ++lobe) {
      const double found = baked.solved[0].amplitudes[lobe * block.count() + k];
      largest = std::max(largest, std::abs(found - stack.amplitude(block.texels[k], lobe)));
    }
  }
  EXPECT_LT(largest, 1e-5) << "ridge " << plan.system->ridge();
}

// Noise of 0.01 under 40 lights: what is held out has it whole, and the amplitudes of four lobes carry a
// share of it too.
TEST(Bake, HoldsOutNoMoreThanTheNoise) {
  StackRecipe recipe = matte_bumps();
  recipe.files.give_normals = true;
  recipe.files.give_albedo = true;
  recipe.noise.additive = 0.01;
  SyntheticStack stack(recipe);
  const TexelBlock block = all_of(stack);
  const BakeSettings settings = lambert_with(4);
  const BakePlan plan = plan_bake(stack.info(), block, bake::all_lights(stack.info()), settings);
  bake::EvidenceOptions options;
  options.folds = 5;
  options.compressed = false;
  options.other_lobes = {};
  const bake::Evidence evidence = evaluate(stack.info(), block, plan, settings, options);
  // Of the luminance of three channels with noises of their own.
  const double noise =
      255.0 * 0.01 * std::hypot(bake::kLuminance[0], bake::kLuminance[1], bake::kLuminance[2]);
  EXPECT_GT(evidence.find("lambert")->held_out.rmse_255, 2.0 * noise);
  EXPECT_LT(evidence.find("realis")->held_out.rmse_255, 1.15 * noise);
  EXPECT_GT(evidence.find("realis")->held_out.rmse_255, 0.95 * noise);
}

// A stack that is hard in one way.
struct HardStack {
  StackInfo info;
  TexelBlock block;
};

HardStack hard_stack(const StackRecipe& recipe) {
  SyntheticStack stack(recipe);
  return {stack.info(), all_of(stack)};
}

bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

std::vector<std::string> warnings_of(const HardStack& hard, const BakePlan& plan) {
  std::vector<std::string> names;
  for (const bake::SolveWarning& warning : bake::capture_warnings(hard.info, hard.block, false))
    names.push_back(warning.name);
  for (const bake::SolveWarning& warning : plan.warnings) names.push_back(warning.name);
  return names;
}

// Every bake of the stack is finite, names the hardship, and is no worse under lights held out than the base
// model that it corrects.
void expect_sound(const HardStack& hard, const std::string& warning, const BakeSettings& settings) {
  const BakePlan plan = plan_bake(hard.info, hard.block, bake::all_lights(hard.info), settings);
  EXPECT_THAT(warnings_of(hard, plan), testing::Contains(warning));
  const bake::BakedBlock baked = bake_block(hard.info, hard.block, plan, settings);
  EXPECT_TRUE(all_finite(baked.surface.normals));
  EXPECT_TRUE(all_finite(baked.surface.albedo));
  for (const bake::SolveResult& solved : baked.solved) {
    EXPECT_TRUE(all_finite(solved.amplitudes));
    EXPECT_TRUE(all_finite(solved.confidence));
  }
  bake::EvidenceOptions options;
  options.folds = 6;
  options.compressed = false;
  options.other_lobes = {};
  const bake::Evidence evidence = evaluate(hard.info, hard.block, plan, settings, options);
  const double base = evidence.find("lambert")->held_out.rmse_255;
  const double realis = evidence.find("realis")->held_out.rmse_255;
  EXPECT_TRUE(std::isfinite(realis));
  EXPECT_LE(realis, base * (1.0 + 1e-9));
}

void expect_sound(const HardStack& hard, const std::string& warning) {
  for (const int lobes : {2, 8}) expect_sound(hard, warning, lambert_with(lobes));
}

TEST(EasyBake, IsWarnedOfNothing) {
  StackRecipe recipe = matte_bumps();
  recipe.shape.slope = 1.0;
  recipe.residual.strength = 0.03;  // one that all texels share would look like gains
  const HardStack easy = hard_stack(recipe);
  const BakePlan plan = plan_bake(easy.info, easy.block, bake::all_lights(easy.info), lambert_with(4));
  EXPECT_TRUE(plan.system);
  EXPECT_THAT(warnings_of(easy, plan), testing::IsEmpty());
}

TEST(HardBake, FewerLightsThanLobes) {
  StackRecipe recipe = matte_bumps();
  recipe.lights.count = 6;
  expect_sound(hard_stack(recipe), "fewer-lights-than-lobes", lambert_with(8));
}

TEST(HardBake, AllLightsWithinTenDegrees) {
  StackRecipe recipe = matte_bumps();
  recipe.lights.count = 12;
  recipe.lights.theta_deg = 10;
  recipe.noise.additive = 0.01;
  expect_sound(hard_stack(recipe), "narrow-lights");
}

TEST(HardBake, LightsOnTheHorizonWithNoise) {
  StackRecipe recipe = matte_bumps();
  recipe.shape.relief = synthetic::Relief::kPlane;
  recipe.lights.arrangement = synthetic::Arrangement::kRing;
  recipe.lights.count = 24;
  recipe.lights.theta_deg = 89.5;
  recipe.noise.additive = 0.01;
  expect_sound(hard_stack(recipe), "lights-on-the-horizon");
}

TEST(HardBake, LobesThatNearlyCoincide) {
  const StackRecipe recipe = matte_bumps();
  BakeSettings settings = lambert_with(4);
  settings.given_lobes = SyntheticStack(recipe).lobes();
  for (std::size_t k = 0; k < 4; ++k) {
    Lobe twin = (*settings.given_lobes)[k];
    twin.sharpness *= 1.0 + 1e-6;
    settings.given_lobes->push_back(twin);
  }
  expect_sound(hard_stack(recipe), "coincident-lobes", settings);
}

TEST(HardBake, TexelsLitByFewerLightsThanLobes) {
  HardStack hard = hard_stack(matte_bumps());
  hard.block.weight.assign(hard.block.lights * hard.block.count(), 1.0F);
  for (std::size_t light = 5; light < hard.block.lights; ++light) {
    for (std::size_t k = 0; k < hard.block.count(); k += 3)
      hard.block.weight[light * hard.block.count() + k] = 0.0F;
  }
  expect_sound(hard, "few-lights-per-texel", lambert_with(8));
}

TEST(HardBake, GainsThatAreOffByThirtyPercent) {
  StackRecipe recipe = matte_bumps();
  // Gains cannot be told from a residual of their size, nor on a surface that is nearly flat.
  recipe.residual.strength = 0.03;
  recipe.shape.slope = 1.2;
  std::mt19937 random(1);
  for (int light = 0; light < recipe.lights.count; ++light) {
    recipe.faults.gains.emplace_back(light, random() % 2 == 0 ? 1.3 : 0.7);
  }
  expect_sound(hard_stack(recipe), "uneven-gains");
}

TEST(HardBake, ValuesFarAboveOne) {
  HardStack hard = hard_stack(matte_bumps());
  for (std::size_t k = 0; k < hard.block.rgb.size(); k += 7) hard.block.rgb[k] *= 65504.0F;
  expect_sound(hard, "values-far-above-one");
}

// Readers hand out such pixels as 0 with weight 0.
TEST(HardBake, PixelsThatAreNoNumbers) {
  HardStack hard = hard_stack(matte_bumps());
  hard.block.weight.assign(hard.block.lights * hard.block.count(), 1.0F);
  for (std::size_t at = 0; at < hard.block.weight.size(); at += 5) {
    hard.block.weight[at] = 0.0F;
    const std::size_t light = at / hard.block.count();
    for (std::size_t c = 0; c < 3; ++c) hard.block.plane(light, c)[at % hard.block.count()] = 0.0F;
  }
  expect_sound(hard, "unusable-values");
}

TEST(HardBake, ALightListedTwice) {
  HardStack hard = hard_stack(matte_bumps());
  hard.info.lights[7].direction = hard.info.lights[3].direction;
  for (std::size_t c = 0; c < 3; ++c) {
    std::copy_n(hard.block.plane(3, c).begin(), hard.block.count(), hard.block.plane(7, c).begin());
  }
  expect_sound(hard, "coincident-lights");
}

TEST(HardBake, ABlackTexel) {
  HardStack hard = hard_stack(matte_bumps());
  for (std::size_t light = 0; light < hard.block.lights; ++light) {
    for (std::size_t c = 0; c < 3; ++c) hard.block.plane(light, c)[5] = 0.0F;
  }
  expect_sound(hard, "black-texels");
}

}  // namespace
}  // namespace brdfit
