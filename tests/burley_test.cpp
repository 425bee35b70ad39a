// Burley's model against the published formulas, its symmetries and its effects one by one.
#include "tests/model_matchers.h"

namespace brdfit {
namespace {

using testing_support::Pair;
using testing_support::Random;

constexpr MaterialOptions k2012 = {.burley_g = BurleyG::k2012};
constexpr MaterialOptions k2017 = {.burley_g = BurleyG::k2017};

Material with_effect(Effect effect) {
  Material material(Model::kBurley);
  material.set("base_color", Rgb{0.1, 0.3, 0.6});
  material.set_effects(Effects().with(effect));
  return material;
}

TEST(Burley, EqualsThePublishedFormulasWithTheMaskingOf2012) {
  testing_support::expect_equals_reference(Model::kBurley, k2012, 1e-12);
}

TEST(Burley, EqualsThePublishedFormulasWithTheMaskingOf2017) {
  testing_support::expect_equals_reference(Model::kBurley, k2017, 1e-12);
}

TEST(Burley, IsReciprocal) {
  for (const MaterialOptions& options : {k2012, k2017}) {
    testing_support::expect_reciprocal(Model::kBurley, options, effects_of(Model::kBurley));
    testing_support::expect_reciprocal(Model::kBurley, options, {});
  }
}

TEST(Burley, IsDarkBelowTheHorizon) {
  testing_support::expect_dark_below_horizon(Model::kBurley, k2012);
  testing_support::expect_dark_below_horizon(Model::kBurley, k2017);
}

TEST(Burley, EffectsAtTheirDefaultsChangeNothing) {
  Random random(4);
  for (const MaterialOptions& options : {k2012, k2017}) {
    Material plain(Model::kBurley);
    plain.options() = options;
    for (const Effect effect : all_effects()) {
      if ((effects_of(Model::kBurley).bits() & static_cast<std::uint32_t>(effect)) == 0) continue;
      Material material = plain;
      material.set_effects(Effects().with(effect));
      for (const Pair& pair : testing_support::test_pairs(50, random)) {
        const Rgb expected = eval_cos(plain, pair.wi, pair.wo);
        const Rgb actual = eval_cos(material, pair.wi, pair.wo);
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_NEAR(actual[c], expected[c], 1e-14 * expected[c]) << effect_name(effect);
        }
      }
    }
  }
}

TEST(Burley, ParametersOfEffectsThatAreOffDoNotMatter) {
  Random random(5);
  for (unsigned index = 0; index < 32; ++index) {
    const Effects effects = testing_support::effect_subset(Model::kBurley, index);
    const Material one = testing_support::random_material(Model::kBurley, effects, random);
    Material other = one;
    for (const ParameterInfo& info : parameters_of(Model::kBurley)) {
      if (!effects.has(info.effect)) other.set(info.name, info.upper);
    }
    for (const Pair& pair : testing_support::random_pairs(20, random)) {
      EXPECT_EQ(eval_cos(one, pair.wi, pair.wo), eval_cos(other, pair.wi, pair.wo));
    }
  }
}

TEST(Burley, SheenIsNotDividedByPi) {
  Material sheen = with_effect(Effect::kSheen);
  sheen.set("sheen", 1.0);
  sheen.set("sheen_tint", 0.0);
  const Pair pair = testing_support::pair_at(0.0, 1.3, 0.0);
  const double difference =
      eval(sheen, pair.wi, pair.wo)[1] - eval(with_effect(Effect::kNone), pair.wi, pair.wo)[1];
  EXPECT_NEAR(difference, std::pow(1.0 - std::cos(1.3), 5), 1e-12);
}

TEST(Burley, TintsAreWhiteOnBlack) {
  Material material = with_effect(Effect::kSpecularTint);
  material.set("base_color", 0.0);
  const Pair pair = testing_support::pair_at(0.1, 0.3, 1.0);
  const Rgb untinted = eval(material, pair.wi, pair.wo);
  material.set("specular_tint", 1.0);
  EXPECT_EQ(eval(material, pair.wi, pair.wo), untinted);
}

TEST(Burley, TintKeepsHueAndDropsLuminance) {
  Material sheen = with_effect(Effect::kSheen);
  sheen.set("sheen", 1.0);
  sheen.set("sheen_tint", 1.0);
  const Pair pair = testing_support::pair_at(0.0, 1.3, 0.0);
  const Rgb with = eval(sheen, pair.wi, pair.wo);
  const Rgb without = eval(with_effect(Effect::kNone), pair.wi, pair.wo);
  const double fh = std::pow(1.0 - std::cos(1.3), 5);
  const double luminance = 0.3 * 0.1 + 0.6 * 0.3 + 0.1 * 0.6;
  EXPECT_NEAR(with[0] - without[0], fh * 0.1 / luminance, 1e-12);
  EXPECT_NEAR(with[2] - without[2], fh * 0.6 / luminance, 1e-12);
}

TEST(Burley, ClearcoatDoesNotDependOnMetallic) {
  const Pair pair = testing_support::pair_at(0.02, 0.3, 0.0);
  Rgb added[2];
  for (const int metallic : {0, 1}) {
    Material material = with_effect(Effect::kClearcoat);
    material.set("metallic", metallic);
    const Rgb without = eval(material, pair.wi, pair.wo);
    material.set("clearcoat", 3.0);
    const Rgb with = eval(material, pair.wi, pair.wo);
    for (std::size_t c = 0; c < 3; ++c) added[metallic][c] = with[c] - without[c];
  }
  EXPECT_GT(added[0][0], 0.01);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(added[0][c], added[1][c], 1e-12 * added[0][c]);
}

TEST(Burley, AnisotropyStretchesTheHighlightAlongX) {
  for (const MaterialOptions& options : {k2012, k2017}) {
    Material material = with_effect(Effect::kAnisotropic);
    material.options() = options;
    material.set("anisotropic", 0.8);
    const Vec3 wi = {0, 0, 1};
    const double along_x = eval(material, wi, testing_support::direction(0.8, 0.0))[0];
    const double along_y = eval(material, wi, testing_support::direction(0.8, std::numbers::pi / 2))[0];
    EXPECT_GT(along_x, 1.2 * along_y);
  }
}

TEST(Burley, AnisotropyIsSymmetricAboutItsAxes) {
  Random random(6);
  Material material = with_effect(Effect::kAnisotropic);
  material.options() = k2017;
  material.set("anisotropic", 0.8);
  for (const Pair& pair : testing_support::random_pairs(100, random)) {
    const Rgb f = eval(material, pair.wi, pair.wo);
    const Rgb mirrored =
        eval(material, {-pair.wi.x, pair.wi.y, pair.wi.z}, {-pair.wo.x, pair.wo.y, pair.wo.z});
    EXPECT_EQ(f, mirrored);
  }
}

TEST(Burley, StaysFiniteAtTheSmallestCosines) {
  Random random(9);
  for (int k = 0; k < 50; ++k) {
    Material material = testing_support::random_material(Model::kBurley, effects_of(Model::kBurley), random);
    material.options() = k % 2 == 0 ? k2012 : k2017;
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
