// Renders of blocks agree with the scalar models; base colours come back from them.
#include "bake/base_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "bake_data.h"

namespace brdfit::bake {
namespace {

using test_data::cap_of_lights;
using test_data::material_sphere;
using test_data::TrueStack;

std::vector<Material> materials() {
  std::vector<Material> result;
  for (const Model model : all_models()) {
    Material plain(model);
    plain.set("roughness", 0.35);
    plain.set("metallic", 0.3);
    result.push_back(plain);
  }
  Material burley(Model::kBurley);
  burley.set_effects(effects_of(Model::kBurley).without(Effect::kAnisotropic));
  burley.set("subsurface", 0.4);
  burley.set("sheen", 0.5);
  burley.set("sheen_tint", 0.0);
  burley.set("clearcoat", 0.7);
  result.push_back(burley);
  Material callisto(Model::kCallisto);
  callisto.set_effects(effects_of(Model::kCallisto));
  callisto.set("diffuse_fresnel", 3.0);
  callisto.set("retroreflection", 2.0);
  callisto.set("retroreflection_tint", Rgb{1.0, 0.6, 0.4});
  callisto.set("smooth_terminator", 0.5);
  callisto.set("dual_specular_opacity", 0.4);
  callisto.set("specular_fresnel_falloff", 0.3);
  result.push_back(callisto);
  return result;
}

TEST(BaseModel, RendersAsTheScalarModels) {
  for (const Material& material : materials()) {
    const TrueStack s = material_sphere(9, cap_of_lights(12, 85.0), material);
    const std::vector<float> render =
        render_block(s.info, s.block, s.truth, all_lights(s.info), {.material = material});
    for (std::size_t k = 0; k < render.size(); ++k) {
      EXPECT_NEAR(render[k], s.block.rgb[k], 1e-4F * std::abs(s.block.rgb[k]) + 2e-6F)
          << title_of(material.model()) << " at " << k;
    }
  }
}

TEST(BaseModel, RendersLambert) {
  const TrueStack s = test_data::lambert_sphere(9, cap_of_lights(12, 90.0));
  const std::vector<float> render = render_block(s.info, s.block, s.truth, all_lights(s.info), {});
  for (std::size_t k = 0; k < render.size(); ++k) EXPECT_NEAR(render[k], s.block.rgb[k], 1e-6F);
}

TEST(BaseModel, RendersChosenLightsOnly) {
  const TrueStack s = test_data::lambert_sphere(9, cap_of_lights(12, 60.0));
  const std::vector<float> render = render_block(s.info, s.block, s.truth, {7}, {});
  ASSERT_EQ(render.size(), 3 * s.block.count());
  for (std::size_t t = 0; t < s.block.count(); ++t) EXPECT_NEAR(render[t], s.block.plane(7, 0)[t], 1e-6F);
}

TEST(BaseModel, IntensityAndFalloffScaleTheRender) {
  Material material(Model::kCallisto);
  material.set_effects(effects_of(Model::kCallisto));
  TrueStack s = material_sphere(5, cap_of_lights(3, 40.0), material);
  const std::vector<float> before =
      render_block(s.info, s.block, s.truth, all_lights(s.info), {.material = material});
  s.info.lights[1].intensity = {2.0, 3.0, 4.0};
  const std::vector<float> after =
      render_block(s.info, s.block, s.truth, all_lights(s.info), {.material = material});
  const std::size_t n = s.block.count();
  for (std::size_t t = 0; t < n; ++t) {
    EXPECT_EQ(after[t], before[t]);
    EXPECT_FLOAT_EQ(after[(3 + 2) * n + t], 4.0F * before[(3 + 2) * n + t]);
  }
}

TEST(BaseModel, NearLightsFollowTheirIncidence) {
  Material material(Model::kLambertGgx);
  TrueStack s = material_sphere(9, cap_of_lights(4, 50.0), material);
  s.info.plane = {{-0.6, 0.6, 0.0}, 0.15};
  for (StackLight& light : s.info.lights) {
    light.position = Vec3{2.0 * light.direction.x, 2.0 * light.direction.y, 2.0 * light.direction.z};
  }
  const std::vector<float> near =
      render_block(s.info, s.block, s.truth, all_lights(s.info), {.material = material});
  const std::size_t n = s.block.count();
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t t = 0; t < n; t += 7) {
      StackInfo far = s.info;
      const Incidence at = incidence(s.info, k, s.block.texels[t]);
      far.lights[k].position.reset();
      far.lights[k].direction = at.direction;
      for (StackLight& light : far.lights) light.position.reset();
      const std::vector<float> one =
          render_block(far, s.block, s.truth, all_lights(s.info), {.material = material});
      EXPECT_NEAR(near[3 * k * n + t], at.falloff * one[3 * k * n + t], 1e-5F);
    }
  }
}

TEST(BaseModel, BaseColoursComeBackFromARender) {
  for (const Material& material : materials()) {
    const TrueStack s = material_sphere(9, cap_of_lights(20, 60.0), material);
    Surface unknown = s.truth;
    std::ranges::fill(unknown.albedo, 0.1F);
    const Surface found =
        with_base_colour(s.info, s.block, unknown, all_lights(s.info), {.material = material});
    EXPECT_LT(test_data::largest_albedo_error(found, s.truth), 2e-4) << title_of(material.model());
    EXPECT_EQ(found.normals, s.truth.normals);
  }
}

TEST(BaseModel, BlackAndUnweightedTexelsAreFinite) {
  Material material(Model::kLambertGgx);
  TrueStack s = material_sphere(8, cap_of_lights(10, 60.0), material);
  s.block.weight.assign(s.block.lights * s.block.count(), 1.0F);
  for (std::size_t k = 0; k < s.block.lights; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      s.block.plane(k, c)[0] = 0.0F;
      s.block.plane(k, c)[1] = std::numeric_limits<float>::quiet_NaN();
    }
    s.block.weight[k * s.block.count() + 1] = 0.0F;
  }
  const Surface found = with_base_colour(s.info, s.block, s.truth, all_lights(s.info),
                                         {.material = material, .robust_width = 0.1});
  for (const float x : found.albedo) EXPECT_TRUE(std::isfinite(x) && x >= 0.0F);
  EXPECT_EQ(found.albedo[0], 0.0F);
  for (const float x : render_block(s.info, s.block, found, all_lights(s.info), {.material = material})) {
    EXPECT_TRUE(std::isfinite(x));
  }
}

TEST(BaseModel, GivenAlbedoStays) {
  Material material(Model::kLambertGgx);
  TrueStack s = material_sphere(5, cap_of_lights(5, 60.0), material);
  s.block.albedo.assign(3 * s.block.count(), 0.5F);
  const Surface found =
      with_base_colour(s.info, s.block, s.truth, all_lights(s.info), {.material = material});
  EXPECT_EQ(found.albedo, s.truth.albedo);
}

TEST(BaseModel, RefusesTintsThatAreNotAffine) {
  Material burley(Model::kBurley);
  burley.set_effects(effects_of(Model::kBurley));
  EXPECT_TRUE(is_affine(burley));
  burley.set("specular_tint", 0.5);
  EXPECT_FALSE(is_affine(burley));
  const TrueStack s = test_data::lambert_sphere(3, cap_of_lights(3, 60.0));
  EXPECT_THROW(render_block(s.info, s.block, s.truth, {0}, {.material = burley}), std::invalid_argument);
  EXPECT_THROW(render_block(s.info, s.block, s.truth, {3}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::bake
