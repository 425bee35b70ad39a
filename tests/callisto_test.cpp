// Callisto against the published formulas, its neutral settings, and its effects one by one.
#include "tests/model_matchers.h"

namespace brdfit {
namespace {

using testing_support::Pair;
using testing_support::Random;

constexpr MaterialOptions kSeparable = {.masking = Masking::kSeparable};
constexpr MaterialOptions kCorrelated = {.masking = Masking::kCorrelated};
constexpr double kDegree = std::numbers::pi / 180;

const Effects kAllEffects = effects_of(Model::kCallisto);

Material callisto(Effects effects) {
  Material material(Model::kCallisto);
  material.set("base_color", Rgb{0.1, 0.3, 0.6});
  material.set_effects(effects);
  return material;
}

// The same base parameters and options in Lambert + GGX.
Material as_lambert_ggx(const Material& material) {
  Material result(Model::kLambertGgx);
  result.options() = material.options();
  for (const ParameterInfo& info : parameters_of(Model::kLambertGgx)) {
    if (info.components == 3) {
      result.set(info.name, material.colour(info.name));
    } else {
      result.set(info.name, material.number(info.name));
    }
  }
  return result;
}

void expect_same(const Material& actual, const Material& expected, double relative) {
  Random random(12);
  for (const Pair& pair : testing_support::test_pairs(100, random)) {
    const Rgb a = eval_cos(actual, pair.wi, pair.wo);
    const Rgb e = eval_cos(expected, pair.wi, pair.wo);
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(a[c], e[c], relative * e[c]) << testing_support::describe(actual, pair);
    }
  }
}

TEST(Callisto, EqualsThePublishedFormulasWithSeparableMasking) {
  testing_support::expect_equals_reference(Model::kCallisto, kSeparable, 1e-12);
}

TEST(Callisto, EqualsThePublishedFormulasWithCorrelatedMasking) {
  testing_support::expect_equals_reference(Model::kCallisto, kCorrelated, 1e-12);
}

TEST(Callisto, IsDarkBelowTheHorizon) {
  testing_support::expect_dark_below_horizon(Model::kCallisto, kSeparable);
  testing_support::expect_dark_below_horizon(Model::kCallisto, kCorrelated);
}

TEST(Callisto, WithEveryDefaultIsLambertGgxWhateverTheEffects) {
  Random random(13);
  for (unsigned index = 0; index < 64; ++index) {
    Material material(Model::kCallisto);
    material.options() = index % 2 == 0 ? kSeparable : kCorrelated;
    material.options().diffuse = index < 32 ? Diffuse::kLambert : Diffuse::kProxima;
    material.set_effects(testing_support::effect_subset(Model::kCallisto, index % 32));
    for (const ParameterInfo& info : parameters_of(Model::kLambertGgx)) {
      material.set(info.name, testing_support::any_value(info, random));
    }
    expect_same(material, as_lambert_ggx(material), 1e-13);
    if (HasFatalFailure()) return;
  }
}

TEST(Callisto, ParametersOfEffectsThatAreOffDoNotMatter) {
  Random random(14);
  for (unsigned index = 0; index < 32; ++index) {
    const Effects effects = testing_support::effect_subset(Model::kCallisto, index);
    const Material one = testing_support::random_material(Model::kCallisto, effects, random);
    Material other = one;
    for (const ParameterInfo& info : parameters_of(Model::kCallisto)) {
      if (!effects.has(info.effect)) other.set(info.name, info.upper);
    }
    for (const Pair& pair : testing_support::random_pairs(20, random)) {
      EXPECT_EQ(eval_cos(one, pair.wi, pair.wo), eval_cos(other, pair.wi, pair.wo));
    }
  }
}

TEST(Callisto, IsReciprocalWithoutTheTerminator) {
  const Effects effects = kAllEffects.without(Effect::kSmoothTerminator);
  testing_support::expect_reciprocal(Model::kCallisto, kSeparable, effects);
  testing_support::expect_reciprocal(Model::kCallisto, kCorrelated, effects);
}

// The example: at theta_h = theta_d = 40 deg the terminator gives 0.65 one way and 1 the other.
TEST(Callisto, TerminatorIsNotReciprocal) {
  Material material = callisto(Effects().with(Effect::kSmoothTerminator));
  EXPECT_FALSE(is_reciprocal(material));
  material.set("smooth_terminator", 0.5);
  material.set("smooth_terminator_length", 0.5);
  const Material plain = callisto({});
  const Pair pair = testing_support::pair_at(40 * kDegree, 40 * kDegree, 0.0);
  const double there = eval(material, pair.wi, pair.wo)[0] / eval(plain, pair.wi, pair.wo)[0];
  const double back = eval(material, pair.wo, pair.wi)[0] / eval(plain, pair.wo, pair.wi)[0];
  EXPECT_NEAR(there, 0.65, 0.005);
  EXPECT_DOUBLE_EQ(back, 1.0);
}

TEST(Callisto, TerminatorActsOnDiffuseAndSpecularAlike) {
  const Pair pair = testing_support::pair_at(40 * kDegree, 40 * kDegree, 0.0);
  double ratios[2];
  for (const int metallic : {0, 1}) {
    Material material = callisto(Effects().with(Effect::kSmoothTerminator));
    material.set("metallic", metallic);
    const double without = eval(material, pair.wi, pair.wo)[0];
    material.set("smooth_terminator", 0.8);
    ratios[metallic] = eval(material, pair.wi, pair.wo)[0] / without;
  }
  EXPECT_LT(ratios[0], 0.9);
  EXPECT_NEAR(ratios[0], ratios[1], 1e-14);
}

TEST(Callisto, TerminatorHardensWithANegativeValue) {
  const Pair pair = testing_support::pair_at(40 * kDegree, 40 * kDegree, 0.0);
  Material material = callisto(Effects().with(Effect::kSmoothTerminator));
  const double without = eval(material, pair.wi, pair.wo)[0];
  material.set("smooth_terminator", -0.5);
  EXPECT_GT(eval(material, pair.wi, pair.wo)[0], without);
}

TEST(Callisto, TerminatorOfLengthZeroChangesNothing) {
  Material material = callisto(Effects().with(Effect::kSmoothTerminator));
  material.set("smooth_terminator", 1.0);
  material.set("smooth_terminator_length", 0.0);
  expect_same(material, as_lambert_ggx(material), 1e-14);
}

TEST(Callisto, SpecularFalloffOfOneHalfIsSchlick) {
  Material material = callisto(Effects().with(Effect::kSpecularFresnelFalloff));
  material.set("specular_fresnel_falloff", 0.5);
  expect_same(material, as_lambert_ggx(material), 1e-13);
}

TEST(Callisto, SpecularFalloffOfZeroRemovesFresnel) {
  Material material = callisto(Effects().with(Effect::kSpecularFresnelFalloff));
  material.set("base_color", 0.0);
  material.set("specular_fresnel_falloff", 0.0);
  const Pair pair = testing_support::pair_at(0.1, 1.4, 0.7);
  const reference::Geometry g = reference::geometry(pair.wi, pair.wo);
  const auto lobe = static_cast<double>(reference::ggx_lobe(0.25L, g, Masking::kSeparable));
  EXPECT_NEAR(eval(material, pair.wi, pair.wo)[0], 0.04 * lobe, 1e-14);
}

TEST(Callisto, DualSpecularBlendsFromTheFirstLobeToTheSecond) {
  Material material = callisto(Effects().with(Effect::kDualSpecular));
  material.set("metallic", 1.0);
  material.set("roughness", 0.2);
  material.set("dual_specular_roughness_scale", 3.0);
  Material narrow = as_lambert_ggx(material);
  Material wide = narrow;
  wide.set("roughness", 0.6);
  const Pair pair = testing_support::pair_at(0.2, 0.5, 1.0);
  const double first = eval(narrow, pair.wi, pair.wo)[1];
  const double second = eval(wide, pair.wi, pair.wo)[1];
  for (const double opacity : {0.0, 0.3, 1.0}) {
    material.set("dual_specular_opacity", opacity);
    EXPECT_NEAR(eval(material, pair.wi, pair.wo)[1], (1 - opacity) * first + opacity * second, 1e-13);
  }
}

TEST(Callisto, SecondRoughnessStopsAtOne) {
  Material material = callisto(Effects().with(Effect::kDualSpecular));
  material.set("roughness", 0.3);
  material.set("dual_specular_opacity", 1.0);
  material.set("dual_specular_roughness_scale", 16.0);
  const Pair pair = testing_support::pair_at(0.2, 0.5, 1.0);
  const Rgb f = eval(material, pair.wi, pair.wo);
  material.set("dual_specular_roughness_scale", 1 / 0.3);
  const Rgb at_one = eval(material, pair.wi, pair.wo);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(f[c], at_one[c], 1e-14);
}

TEST(Callisto, DiffuseFresnelScalesTheDiffuseAtGrazingDifferenceAngles) {
  Material material = callisto(Effects().with(Effect::kDiffuseFresnel));
  material.set("diffuse_fresnel", 10.0);
  material.set("diffuse_fresnel_tint", Rgb{1.0, 0.5, 0.1});
  const Pair grazing = testing_support::pair_at(0.0, 89.9 * kDegree, 1.0);
  const Pair normal = testing_support::pair_at(0.0, 0.0, 1.0);
  const Material plain = callisto({});
  const Rgb base = material.colour("base_color");
  const Rgb gain = {10.0, 5.0, 1.0};
  for (std::size_t c = 0; c < 3; ++c) {
    const double added = eval(material, grazing.wi, grazing.wo)[c] - eval(plain, grazing.wi, grazing.wo)[c];
    EXPECT_NEAR(added, base[c] / std::numbers::pi * (gain[c] - 1.0), 0.02 * gain[c] * base[c]);
    EXPECT_EQ(eval(material, normal.wi, normal.wo)[c], eval(plain, normal.wi, normal.wo)[c]);
  }
}

TEST(Callisto, RetroreflectionScalesTheDiffuseAtGrazingHalfAngles) {
  Material material = callisto(Effects().with(Effect::kRetroreflection));
  material.set("retroreflection", 10.0);
  const Pair grazing = testing_support::pair_at(89.9 * kDegree, 0.0, 1.0);
  const Pair normal = testing_support::pair_at(0.0, 0.0, 1.0);
  const Material plain = callisto({});
  const Rgb base = material.colour("base_color");
  for (std::size_t c = 0; c < 3; ++c) {
    const double added = eval(material, grazing.wi, grazing.wo)[c] - eval(plain, grazing.wi, grazing.wo)[c];
    EXPECT_NEAR(added, base[c] / std::numbers::pi * 9.0, 0.2 * base[c]);
    EXPECT_EQ(eval(material, normal.wi, normal.wo)[c], eval(plain, normal.wi, normal.wo)[c]);
  }
}

TEST(Callisto, FalloffOfOneActsAtEveryAngle) {
  Material material = callisto(Effects().with(Effect::kRetroreflection));
  material.set("retroreflection", 3.0);
  material.set("retroreflection_falloff", 1.0);
  material.set("retroreflection_tangent_falloff", 1.0);
  Random random(15);
  const Material plain = callisto({});
  const Rgb base = material.colour("base_color");
  for (const Pair& pair : testing_support::test_pairs(50, random)) {
    const double added = eval(material, pair.wi, pair.wo)[2] - eval(plain, pair.wi, pair.wo)[2];
    EXPECT_NEAR(added, base[2] / std::numbers::pi * 2.0, 1e-12 * (1.0 + eval(plain, pair.wi, pair.wo)[2]));
  }
}

TEST(Callisto, StaysFiniteAtTheSmallestCosines) {
  Random random(16);
  for (int k = 0; k < 100; ++k) {
    Material material = testing_support::random_material(Model::kCallisto, kAllEffects, random);
    material.options() = k % 2 == 0 ? kSeparable : kCorrelated;
    for (const double z : {1e-20, 1e-160, 1e-310, 5e-324}) {
      for (const Pair& pair :
           {Pair{{1, 0, z}, {-1, 0, z}}, Pair{{1, 0, z}, {0, 0, 1}}, Pair{{1, 0, z}, {1, 0, z}}}) {
        for (const double x : eval_cos(material, pair.wi, pair.wo)) {
          ASSERT_TRUE(std::isfinite(x)) << testing_support::describe(material, pair);
        }
      }
    }
  }
}

}  // namespace
}  // namespace brdfit
