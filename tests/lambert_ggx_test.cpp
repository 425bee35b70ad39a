// Lambert + GGX against the published formulas, its symmetries and its energy.
#include "tests/model_matchers.h"

namespace brdfit {
namespace {

using testing_support::Pair;
using testing_support::Random;

constexpr MaterialOptions kSeparable = {.masking = Masking::kSeparable};
constexpr MaterialOptions kCorrelated = {.masking = Masking::kCorrelated};

// Of light from everywhere, the share that leaves towards wo.
Rgb directional_albedo(const Material& material, const Vec3& wo) {
  constexpr int kPolar = 2000;
  constexpr int kAzimuth = 100;
  Rgb albedo = {0, 0, 0};
  for (int i = 0; i < kPolar; ++i) {
    const double cosine = (i + 0.5) / kPolar;
    for (int k = 0; k < kAzimuth; ++k) {
      const double phi = 2 * std::numbers::pi * (k + 0.5) / kAzimuth;
      const Rgb f = eval_cos(material, testing_support::direction(std::acos(cosine), phi), wo);
      for (std::size_t c = 0; c < 3; ++c) albedo[c] += f[c] * 2 * std::numbers::pi / (kPolar * kAzimuth);
    }
  }
  return albedo;
}

TEST(LambertGgx, EqualsThePublishedFormulasWithSeparableMasking) {
  testing_support::expect_equals_reference(Model::kLambertGgx, kSeparable, 1e-12);
}

TEST(LambertGgx, EqualsThePublishedFormulasWithCorrelatedMasking) {
  testing_support::expect_equals_reference(Model::kLambertGgx, kCorrelated, 1e-12);
}

TEST(LambertGgx, IsReciprocal) {
  testing_support::expect_reciprocal(Model::kLambertGgx, kSeparable, {});
  testing_support::expect_reciprocal(Model::kLambertGgx, kCorrelated, {});
}

TEST(LambertGgx, IsDarkBelowTheHorizon) {
  testing_support::expect_dark_below_horizon(Model::kLambertGgx, kSeparable);
  testing_support::expect_dark_below_horizon(Model::kLambertGgx, kCorrelated);
}

TEST(LambertGgx, WithoutSpecularAtNormalIncidenceIsLambert) {
  Material material(Model::kLambertGgx);
  material.set("base_color", Rgb{0.1, 0.5, 1.0});
  material.set("specular", 0.0);
  const Rgb f = eval(material, {0, 0, 1}, {0, 0, 1});
  const Rgb base = material.colour("base_color");
  for (std::size_t c = 0; c < 3; ++c) EXPECT_DOUBLE_EQ(f[c], base[c] / std::numbers::pi);
}

TEST(LambertGgx, EvalTimesCosineIsEvalCos) {
  Random random(3);
  const Material material = testing_support::random_material(Model::kLambertGgx, {}, random);
  for (const Pair& pair : testing_support::test_pairs(200, random)) {
    const Rgb f = eval(material, pair.wi, pair.wo);
    const Rgb f_cos = eval_cos(material, pair.wi, pair.wo);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(f[c] * pair.wi.z, f_cos[c], 1e-15 * f_cos[c]);
  }
}

// Facets that reflect everything: single scattering loses energy between the facets and never makes any.
TEST(LambertGgx, OfAWhiteMetalReflectsAtMostEverything) {
  for (const MaterialOptions& options : {kSeparable, kCorrelated}) {
    for (const double roughness : {0.3, 0.6, 1.0}) {
      Material material(Model::kLambertGgx);
      material.options() = options;
      material.set("base_color", 1.0);
      material.set("metallic", 1.0);
      material.set("roughness", roughness);
      for (const double theta : {0.1, 0.8, 1.4}) {
        const double albedo = directional_albedo(material, testing_support::direction(theta, 0.0))[0];
        EXPECT_LE(albedo, 1.0 + 1e-3) << roughness << " " << theta;
        EXPECT_GE(albedo, 0.3) << roughness << " " << theta;
      }
    }
  }
}

TEST(LambertGgx, OfASmoothWhiteMetalReflectsNearlyEverything) {
  Material material(Model::kLambertGgx);
  material.set("base_color", 1.0);
  material.set("metallic", 1.0);
  material.set("roughness", 0.25);
  EXPECT_NEAR(directional_albedo(material, testing_support::direction(0.5, 0.0))[0], 1.0, 0.01);
}

// What the base colour adds under light from everywhere, with the specular the same: Lambert's albedo.
TEST(LambertGgx, DiffuseReflectsItsAlbedo) {
  Material coloured(Model::kLambertGgx);
  coloured.set("base_color", Rgb{0.2, 0.6, 1.0});
  Material black(Model::kLambertGgx);
  black.set("base_color", 0.0);
  const Vec3 wo = testing_support::direction(1.0, 0.0);
  const Rgb with = directional_albedo(coloured, wo);
  const Rgb without = directional_albedo(black, wo);
  const Rgb base = coloured.colour("base_color");
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(with[c] - without[c], base[c], 1e-9);
}

TEST(LambertGgx, MetalHasNoDiffuse) {
  Material material(Model::kLambertGgx);
  material.set("base_color", 0.8);
  material.set("metallic", 1.0);
  material.set("roughness", 0.01);
  const Rgb f = eval(material, testing_support::direction(0.7, 0.0), testing_support::direction(0.7, 0.5));
  EXPECT_LT(f[0], 1e-5);
}

TEST(LambertGgx, StaysFiniteAtTheSmallestCosines) {
  for (const MaterialOptions& options : {kSeparable, kCorrelated}) {
    Material material(Model::kLambertGgx);
    material.options() = options;
    material.set("roughness", 0.01);
    for (const double z : {1e-20, 1e-160, 1e-310, 5e-324}) {
      for (const Pair& pair :
           {Pair{{1, 0, z}, {-1, 0, z}}, Pair{{1, 0, z}, {0, 0, 1}}, Pair{{1, 0, z}, {1, 0, z}}}) {
        for (const Rgb& f : {eval(material, pair.wi, pair.wo), eval_cos(material, pair.wi, pair.wo)}) {
          for (const double x : f) EXPECT_TRUE(std::isfinite(x)) << z;
        }
      }
    }
  }
}

}  // namespace
}  // namespace brdfit
