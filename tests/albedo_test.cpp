// Directional albedo: known integrals, and the furnace bound of materials that promise it.
#include "brdf/albedo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "brdf/models.h"

namespace brdfit {
namespace {

TEST(DirectionalAlbedo, OfALambertSurfaceIsItsAlbedoFromEveryDirection) {
  Material material;
  material.set("base_color", Rgb{0.2, 0.5, 0.8});
  material.set("specular", 0.0);
  material.set("roughness", 1.0);
  for (const double theta : {0.0, 0.5, 1.0, 1.4}) {
    const Rgb albedo = directional_albedo(material, theta);
    // Specular 0 still leaves Schlick's rise from 0: at these angles it only adds.
    EXPECT_NEAR(directional_albedo(material, 0.0)[2], 0.8, 0.03);
    EXPECT_GE(albedo[0], 0.2 * 0.99);
    EXPECT_NEAR(albedo[1] - albedo[0], 0.3, 0.003);
    EXPECT_NEAR(albedo[2] - albedo[1], 0.3, 0.003);
  }
}

TEST(DirectionalAlbedo, OfAWhiteSmoothMetalIsOneMinusWhatMaskingLoses) {
  // A single-scattering microfacet lobe with F = 1 loses next to nothing when smooth, and never gains.
  Material material;
  material.set("base_color", 1.0);
  material.set("metallic", 1.0);
  for (const double roughness : {0.05, 0.1, 0.3}) {
    material.set("roughness", roughness);
    const double albedo = directional_albedo(material, 0.3)[1];
    EXPECT_LT(albedo, 1.005) << roughness;
    EXPECT_GT(albedo, 0.97) << roughness;
  }
}

// The quadrature takes one half of the hemisphere for both.
TEST(DirectionalAlbedo, OfAStretchedLobeIsThatOfAPlainSum) {
  Material material(Model::kBurley);
  material.set_effects(effects_of(Model::kBurley));
  material.set("base_color", Rgb{0.2, 0.5, 0.8});
  material.set("roughness", 0.5);
  material.set("anisotropic", 0.7);
  material.set("sheen", 0.5);
  const double theta_o = 0.6;
  const Vec3 wo = {std::sin(theta_o), 0.0, std::cos(theta_o)};
  constexpr int kSteps = 400;
  Rgb expected = {};
  for (int i = 0; i < kSteps; ++i) {
    const double cosine = (i + 0.5) / kSteps;
    const double sine = std::sqrt(1.0 - cosine * cosine);
    for (int j = 0; j < kSteps; ++j) {
      const double phi = (j + 0.5) / kSteps * 2.0 * std::numbers::pi;
      const Rgb f_cos = eval_cos(material, {sine * std::cos(phi), sine * std::sin(phi), cosine}, wo);
      for (std::size_t c = 0; c < 3; ++c)
        expected[c] += f_cos[c] * 2.0 * std::numbers::pi / (kSteps * kSteps);
    }
  }
  const Rgb albedo = directional_albedo(material, theta_o);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(albedo[c], expected[c], 0.01 * expected[c]);
}

TEST(DirectionalAlbedo, ExposesAMaterialThatGivesBackMoreThanItGets) {
  Material material(Model::kCallisto);
  material.set_effects(effects_of(Model::kCallisto));
  material.set("base_color", 0.5);
  EXPECT_LT(largest_directional_albedo(material), 1.0);
  material.set("retroreflection", 200.0);
  material.set("retroreflection_falloff", 1.0);
  EXPECT_GT(largest_directional_albedo(material), 1.0);
}

}  // namespace
}  // namespace brdfit
