// The material that texels share comes back from rendered spheres, and is chosen where it helps held out.
#include "bake/shared_material.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bake/choose_base.h"
#include "bake_data.h"
#include "fit/solve.h"

namespace brdfit::bake {
namespace {

using test_data::cap_of_lights;
using test_data::material_sphere;
using test_data::TrueStack;

class SharedMaterialTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { fit::silence_solver_logging(); }
};

SharedMaterialOptions options_for(Model model) {
  SharedMaterialOptions options;
  options.model = model;
  options.effects = effects_of(model);
  options.values = 20000;
  return options;
}

const fit::ParameterState& state_of(const SharedMaterial& fit, std::string_view name) {
  return *std::ranges::find(fit.parameters, name, &fit::ParameterState::name);
}

Material glossy() {
  Material material(Model::kLambertGgx);
  material.set("roughness", 0.3);
  material.set("metallic", 0.2);
  material.set("specular", 0.8);
  return material;
}

TEST_F(SharedMaterialTest, LambertGgxIsRecovered) {
  const TrueStack s = material_sphere(16, cap_of_lights(40, 70.0), glossy());
  const SharedMaterial fit =
      fit_shared_material(s.info, s.block, s.truth, all_lights(s.info), options_for(Model::kLambertGgx));
  ASSERT_TRUE(fit.model.material.has_value());
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.model.material->number("roughness"), 0.3, 1e-4);
  EXPECT_NEAR(fit.model.material->number("metallic"), 0.2, 1e-3);
  EXPECT_NEAR(fit.model.material->number("specular"), 0.8, 1e-2);
  EXPECT_LT(fit.rmse, 1e-5);
  EXPECT_GT(fit.lambert_rmse, 1e-2);
  EXPECT_EQ(state_of(fit, "roughness").status, fit::Status::kOk);
  const Surface coloured = with_base_colour(s.info, s.block, s.truth, all_lights(s.info), fit.model);
  EXPECT_LT(test_data::largest_albedo_error(coloured, s.truth), 1e-3);
}

TEST_F(SharedMaterialTest, AFifthOfOutliersChangesLittle) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> share(0.0F, 1.0F);
  TrueStack s = material_sphere(16, cap_of_lights(40, 70.0), glossy());
  for (std::size_t k = 0; k < s.block.lights; ++k) {
    for (std::size_t t = 0; t < s.block.count(); ++t) {
      if (share(random) > 0.2F) continue;
      for (std::size_t c = 0; c < 3; ++c) s.block.plane(k, c)[t] *= 0.2F;
    }
  }
  const Surface surface = photometric_stereo(
      [&] {
        StackInfo info = s.info;
        info.has_normals = true;
        return info;
      }(),
      [&] {
        TexelBlock block = s.block;
        block.normals = s.truth.normals;
        return block;
      }(),
      all_lights(s.info));
  SharedMaterialOptions options = options_for(Model::kLambertGgx);
  options.robust_width = 0.5;
  const SharedMaterial fit = fit_shared_material(s.info, s.block, surface, all_lights(s.info), options);
  EXPECT_NEAR(fit.model.material->number("roughness"), 0.3, 0.03);
}

TEST_F(SharedMaterialTest, BurleyAndCallistoFitTheirOwnRenders) {
  Material burley(Model::kBurley);
  burley.set("roughness", 0.4);
  burley.set("specular", 0.7);
  Material callisto(Model::kCallisto);
  callisto.set_effects(Effects().with(Effect::kRetroreflection).with(Effect::kSpecularFresnelFalloff));
  callisto.set("roughness", 0.4);
  callisto.set("retroreflection", 1.8);
  callisto.set("specular_fresnel_falloff", 0.3);
  for (const Material& material : {burley, callisto}) {
    const TrueStack s = material_sphere(14, cap_of_lights(40, 80.0), material);
    SharedMaterialOptions options = options_for(material.model());
    options.effects = material.effects();
    const SharedMaterial fit = fit_shared_material(s.info, s.block, s.truth, all_lights(s.info), options);
    EXPECT_NEAR(fit.model.material->number("roughness"), 0.4, 0.01) << title_of(material.model());
    EXPECT_LT(fit.rmse, 0.02 * fit.lambert_rmse) << title_of(material.model());
  }
}

TEST_F(SharedMaterialTest, LambertHasNoHighlightToFit) {
  const TrueStack s = test_data::lambert_sphere(14, cap_of_lights(30, 70.0));
  const SharedMaterial fit =
      fit_shared_material(s.info, s.block, s.truth, all_lights(s.info), options_for(Model::kLambertGgx));
  ASSERT_TRUE(fit.model.material.has_value());
  EXPECT_TRUE(fit.model.material->is_valid(nullptr));
  EXPECT_LT(fit.rmse, 0.05);
}

TEST_F(SharedMaterialTest, NothingToSeeIsLambert) {
  TrueStack s = test_data::lambert_sphere(6, cap_of_lights(10, 70.0));
  std::ranges::fill(s.block.rgb, 0.0F);
  const Surface black = photometric_stereo(s.info, s.block, all_lights(s.info));
  const SharedMaterial fit = fit_shared_material(s.info, s.block, black, all_lights(s.info));
  EXPECT_FALSE(fit.model.material.has_value());
  EXPECT_EQ(fit.texels, 0U);
  EXPECT_FALSE(fit.termination.empty());
}

TEST_F(SharedMaterialTest, HardValuesStayFinite) {
  TrueStack s = material_sphere(10, cap_of_lights(5, 10.0), glossy());
  for (std::size_t k = 0; k < s.block.rgb.size(); k += 11) s.block.rgb[k] = 1e5F;
  s.info.lights[2] = s.info.lights[1];
  const Surface surface = photometric_stereo(s.info, s.block, all_lights(s.info));
  const SharedMaterial fit = fit_shared_material(s.info, s.block, surface, all_lights(s.info));
  EXPECT_TRUE(std::isfinite(fit.rmse));
  if (fit.model.material) {
    EXPECT_TRUE(fit.model.material->is_valid(nullptr));
  }
}

TEST_F(SharedMaterialTest, IsTheSameForAnyNumberOfThreads) {
  const TrueStack s = material_sphere(16, cap_of_lights(20, 70.0), glossy());
  const auto fit = [&] {
    return fit_shared_material(s.info, s.block, s.truth, all_lights(s.info), options_for(Model::kLambertGgx));
  };
  const SharedMaterial many = fit();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(*many.model.material, *fit().model.material);
}

ChooseBaseOptions quick() {
  ChooseBaseOptions options;
  options.models = {Model::kLambertGgx};
  options.folds = 4;
  options.material.values = 8000;
  return options;
}

TEST_F(SharedMaterialTest, AGlossySphereIsFitted) {
  const TrueStack s = material_sphere(12, cap_of_lights(30, 70.0), glossy());
  const BaseChoice choice = choose_base_model(s.info, s.block, all_lights(s.info), quick());
  ASSERT_EQ(choice.candidates.size(), 2U);
  EXPECT_EQ(choice.chosen, 1U);
  EXPECT_TRUE(choice.fit.model.material.has_value());
  EXPECT_LT(choice.candidates[1].held_out_rmse, choice.candidates[0].held_out_rmse);
}

TEST_F(SharedMaterialTest, ALambertSphereStaysLambert) {
  std::mt19937 random(6);
  std::normal_distribution<float> noise(0.0F, 0.01F);
  TrueStack s = test_data::lambert_sphere(12, cap_of_lights(30, 70.0));
  for (float& x : s.block.rgb) x += noise(random);
  const BaseChoice choice = choose_base_model(s.info, s.block, all_lights(s.info), quick());
  EXPECT_EQ(choice.chosen, 0U);
  EXPECT_FALSE(choice.fit.model.material.has_value());
}

TEST_F(SharedMaterialTest, WhatIsHeldOutDoesNotSeeItself) {
  // A light whose values are of another world spoils its own fold's error and nothing of the others': with it
  // alone in a fold, the error is that of its values.
  TrueStack s = test_data::lambert_sphere(8, cap_of_lights(10, 60.0));
  for (std::size_t c = 0; c < 3; ++c) std::ranges::fill(s.block.plane(3, c), 100.0F);
  ChooseBaseOptions options = quick();
  options.models = {};
  options.folds = 10;
  const BaseChoice choice = choose_base_model(s.info, s.block, all_lights(s.info), options);
  EXPECT_NEAR(choice.candidates[0].held_out_rmse, 100.0 / std::sqrt(10.0), 1.0);
}

TEST_F(SharedMaterialTest, OneLightLeavesNothingToHoldOut) {
  const TrueStack s = test_data::lambert_sphere(4, cap_of_lights(1, 60.0));
  const BaseChoice choice = choose_base_model(s.info, s.block, all_lights(s.info), quick());
  EXPECT_EQ(choice.chosen, 0U);
}

}  // namespace
}  // namespace brdfit::bake
