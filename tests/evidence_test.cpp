// What the evidence of a bake says of colour: errors of RGB beside those of luminance.
#include "bake/evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "bake/reconstruct.h"
#include "data/synthetic/stack.h"

namespace brdfit::bake {
namespace {

using synthetic::StackRecipe;
using synthetic::SyntheticStack;

constexpr int kFolds = 3;

struct Pictures {
  StackInfo info;
  TexelBlock block;
};

// Grey but for what a test changes.
StackRecipe bumps(int lobes) {
  StackRecipe recipe;
  recipe.name = "bumps";
  recipe.width = 16;
  recipe.height = 10;
  recipe.shape.slope = 0.5;
  recipe.shape.wavelength_px = 8;
  Material material(Model::kLambertGgx);
  material.set("base_color", 0.5);
  material.set("specular", 0.0);
  recipe.materials = {material};
  recipe.albedo_variation = 0.5;
  recipe.cast_shadows = false;
  recipe.lights.count = 24;
  recipe.lights.theta_deg = 65;
  recipe.residual = {lobes, 5.0, 180.0, 0.2};
  recipe.files.give_normals = true;
  recipe.files.give_albedo = true;
  return recipe;
}

Pictures pictures_of(const StackRecipe& recipe) {
  SyntheticStack stack(recipe);
  return {stack.info(), stack.read_rows(0, stack.info().height)};
}

// The residual in red alone; in blue one of other lobes, taken away.
Pictures coloured_pictures() {
  StackRecipe recipe = bumps(4);
  Pictures pictures = pictures_of(recipe);
  recipe.residual.strength = 0.0;
  const Pictures plain = pictures_of(recipe);
  const Pictures other = pictures_of(bumps(3));
  for (std::size_t light = 0; light < plain.block.lights; ++light) {
    for (std::size_t k = 0; k < plain.block.count(); ++k) {
      const float grey = plain.block.plane(light, 0)[k];
      pictures.block.plane(light, 1)[k] = grey;
      pictures.block.plane(light, 2)[k] = grey - (other.block.plane(light, 0)[k] - grey);
    }
  }
  return pictures;
}

BakeSettings settings_for(RealisColour colour) {
  BakeSettings settings;
  settings.base = BaseKind::kLambert;
  settings.lobes = 4;
  settings.optimise = false;
  settings.colour = colour;
  return settings;
}

Evidence evidence_of(const Pictures& pictures, const BakeSettings& settings, EvidenceOptions options = {}) {
  options.folds = kFolds;
  options.other_lobes = {2};
  const BakePlan plan = plan_bake(pictures.info, pictures.block, all_lights(pictures.info),
                                  with_compared_lobes(settings, options));
  return evaluate(pictures.info, pictures.block, plan, settings, options);
}

void expect_close(const StackErrors& found, const StackErrors& expected, const std::string& what) {
  EXPECT_NEAR(found.rmse_255, expected.rmse_255, 1e-4 * expected.rmse_255) << what;
  EXPECT_NEAR(found.lit_rmse_255, expected.lit_rmse_255, 1e-4 * expected.lit_rmse_255) << what;
  EXPECT_NEAR(found.psnr_db, expected.psnr_db, 1e-3) << what;
  EXPECT_NEAR(found.worst_light_rmse_255, expected.worst_light_rmse_255, 1e-4 * expected.worst_light_rmse_255)
      << what;
  EXPECT_EQ(found.worst_light, expected.worst_light) << what;
}

TEST(Evidence, OfAGreyStackHasTheErrorsOfLuminanceInRgb) {
  const Pictures grey = pictures_of(bumps(4));
  for (const RealisColour colour : {RealisColour::kRgb, RealisColour::kScaledChroma}) {
    const Evidence evidence = evidence_of(grey, settings_for(colour));
    EXPECT_EQ(evidence.methods.size(), 11U);
    for (const MethodEvidence& method : evidence.methods) {
      ASSERT_TRUE(method.rgb) << method.name;
      EXPECT_GT(method.train.rmse_255, 0.0) << method.name;
      expect_close(method.rgb->train, method.train, method.name);
      expect_close(method.rgb->held_out, method.held_out, method.name);
    }
  }
}

TEST(Evidence, PlansOfOtherNumbersOfLobesAreComparedUnderTheSameNames) {
  // With --lobes auto each fold chooses its own number; sizes must not be judged by some of the folds alone.
  const Pictures pictures = pictures_of(bumps(4));
  const LightChoice all = all_lights(pictures.info);
  const auto methods_of = [&](int lobes) {
    BakeSettings settings = settings_for(RealisColour::kLuminance);
    settings.lobes = lobes;
    const BakePlan plan = plan_bake(pictures.info, pictures.block, all, settings);
    EXPECT_TRUE(plan.system);
    MethodOptions options;
    options.kept = 3;
    return compare_methods(pictures.info, pictures.block, plan, settings, options, all).methods;
  };
  const std::vector<MethodEvidence> six = methods_of(6);
  const std::vector<MethodEvidence> two = methods_of(2);
  ASSERT_EQ(six.size(), two.size());
  for (std::size_t k = 0; k < six.size(); ++k) {
    EXPECT_EQ(six[k].name, two[k].name);
    if (!six[k].name.ends_with("-m3")) continue;
    EXPECT_EQ(six[k].dominant, 3);
    EXPECT_EQ(two[k].dominant, 2);
  }
}

TEST(Evidence, OfLuminanceKnowsNothingOfColourAndIsTheSameBesideIt) {
  const Pictures pictures = coloured_pictures();
  const Evidence plain = evidence_of(pictures, settings_for(RealisColour::kLuminance));
  EXPECT_EQ(plain.find("realis-luminance"), nullptr);
  for (const MethodEvidence& method : plain.methods) EXPECT_FALSE(method.rgb) << method.name;
  for (const RealisColour colour : {RealisColour::kRgb, RealisColour::kScaledChroma}) {
    const Evidence coloured = evidence_of(pictures, settings_for(colour));
    ASSERT_EQ(coloured.methods.size(), plain.methods.size() + 1);
    // What Realis does without colour is what a bake of luminance does.
    for (const std::string name : {"lambert", "ptm", "sh9", "sh9-residual", "realis"}) {
      const MethodEvidence& expected = *plain.find(name);
      const MethodEvidence& found = *coloured.find(name == "realis" ? "realis-luminance" : name);
      EXPECT_EQ(found.train.per_light_255, expected.train.per_light_255) << name;
      EXPECT_EQ(found.held_out.per_light_255, expected.held_out.per_light_255) << name;
      EXPECT_EQ(found.held_out.lit_rmse_255, expected.held_out.lit_rmse_255) << name;
    }
  }
}

TEST(Evidence, ShowsWhatColourBuysWhereTheResidualHasIt) {
  const Pictures pictures = coloured_pictures();
  const Evidence rgb = evidence_of(pictures, settings_for(RealisColour::kRgb));
  const Evidence chroma = evidence_of(pictures, settings_for(RealisColour::kScaledChroma));
  // Three factors know the colour, but not that channels differ in direction.
  const double without = rgb.find("realis-luminance")->rgb->held_out.rmse_255;
  const double scaled = chroma.find("realis")->rgb->held_out.rmse_255;
  EXPECT_LT(scaled, 0.5 * without);
  EXPECT_LT(rgb.find("realis")->rgb->held_out.rmse_255, 0.7 * scaled);
  for (const Evidence& evidence : {rgb, chroma}) {
    const double expected = evidence.find("realis-luminance")->held_out.rmse_255;
    EXPECT_NEAR(evidence.find("realis")->held_out.rmse_255, expected, 0.05 * expected);
  }
  EXPECT_EQ(rgb.find("realis-8bit")->bytes_per_texel, 12.0);
  EXPECT_EQ(chroma.find("realis-8bit")->bytes_per_texel, 4.0 + 6.0);
}

// Lobes and penalty given, so that texels are corrected though nearly all there is to bring back is noise.
TEST(Evidence, OfCorrectionsIsNeverWorseThanNoneInTraining) {
  StackRecipe recipe = bumps(4);
  recipe.residual.strength = 0.01;
  recipe.noise.additive = 0.02;
  const Pictures noisy = pictures_of(recipe);
  for (const RealisColour colour : {RealisColour::kRgb, RealisColour::kScaledChroma}) {
    BakeSettings settings = settings_for(colour);
    settings.given_lobes = SyntheticStack(recipe).lobes();
    settings.given_penalty = 1e-3;
    const Evidence evidence = evidence_of(noisy, settings);
    const double none = evidence.find("lambert")->rgb->train.rmse_255;
    EXPECT_LT(evidence.find("realis")->rgb->train.rmse_255, none);
    for (const std::string name : {"realis", "realis-m2", "realis-k2"}) {
      EXPECT_LE(evidence.find(name)->rgb->train.rmse_255, (1.0 + 1e-6) * none) << name;
    }
  }
}

// Mean squared error of the channels under lights, of an asset that is relit as at run time.
double relit_error(const Pictures& pictures, const BakePlan& plan, const BakeSettings& settings,
                   const LightChoice& lights) {
  const BakedBlock baked = bake_block(pictures.info, pictures.block, plan, settings);
  const std::size_t count = pictures.block.count();
  RealisAsset asset;
  asset.width = pictures.info.width;
  asset.height = pictures.info.height;
  asset.colour = settings.colour;
  asset.base = plan.base.material;
  asset.lobes = plan.system->lobes();
  RunTimeTexels texels{baked.surface, baked.surface, {}, baked.chroma};
  for (std::size_t lobe = 0; lobe < asset.lobes.size(); ++lobe) {
    for (const SolveResult& channel : baked.solved) {
      const auto from = channel.amplitudes.begin() + static_cast<std::ptrdiff_t>(lobe * count);
      texels.amplitudes.insert(texels.amplitudes.end(), from, from + static_cast<std::ptrdiff_t>(count));
    }
  }
  double sum = 0.0;
  for (const std::uint32_t light : lights) {
    const StackLight& stated = pictures.info.lights[light];
    const Relit relit = relight(asset, texels, {stated.direction, stated.intensity});
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < count; ++k) {
        const float error = relit.corrected[c * count + k] - pictures.block.plane(light, c)[k];
        sum += static_cast<double>(error) * static_cast<double>(error) / static_cast<double>(3 * count);
      }
    }
  }
  return sum;
}

TEST(Evidence, IsOfTheAssetAsItIsRelit) {
  const Pictures pictures = coloured_pictures();
  for (const RealisColour colour : {RealisColour::kRgb, RealisColour::kScaledChroma}) {
    const BakeSettings settings = settings_for(colour);
    std::map<int, double> errors;  // of "realis" and of other numbers of lobes
    EvidenceOptions options;
    options.on_fold = [&](int fold, const FoldPlans& plans) {
      const LightChoice held = held_out_lights(pictures.info.lights.size(), fold, kFolds);
      errors[0] += relit_error(pictures, plans.plan, settings, held);
      for (const auto& [lobes, plan] : plans.other_lobes) {
        errors[lobes] += relit_error(pictures, plan, settings, held);
      }
    };
    const Evidence evidence = evidence_of(pictures, settings, options);
    ASSERT_EQ(errors.size(), 2U);
    for (const auto& [lobes, error] : errors) {
      const std::string name = lobes == 0 ? "realis" : "realis-k" + std::to_string(lobes);
      const double expected = 255.0 * std::sqrt(error / static_cast<double>(pictures.info.lights.size()));
      EXPECT_NEAR(evidence.find(name)->rgb->held_out.rmse_255, expected, 1e-4 * expected) << name;
    }
  }
}

}  // namespace
}  // namespace brdfit::bake
