// Which numbers a fit may move, and the way from them to materials and back.
#include "fit/parameters.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>
#include <string>

#include "brdf/coefficients.h"
#include "tests/random_parameters.h"

namespace brdfit::fit {
namespace {

using testing::UnorderedElementsAre;
using testing_support::Random;

Effects fitted_effects(Model model) {
  return effects_of(model).without(Effect::kAnisotropic);
}

// Interior parameters, tints with a largest channel of 1: what a fit's result looks like.
Material canonical_material(Model model, Effects effects, Random& random) {
  Material material = testing_support::interior_material(model, effects, random);
  for (const ParameterInfo& info : parameters_of(model)) {
    if (info.kind == Kind::kTint) {
      material.values()[static_cast<std::size_t>(info.offset) + random() % 3] = 1.0;
    }
  }
  return material;
}

// The public parameters that free numbers belong to, tints of products included.
std::set<std::string> free_parameters(const Parametrisation& parametrisation) {
  std::set<std::string> names;
  for (const FreeParameter& parameter : parametrisation.free) {
    names.insert(parameter.parameter);
    if (!parameter.tint.empty()) names.insert(parameter.tint);
  }
  return names;
}

TEST(FreeParameters, AreThoseOfTheTierWithEffectsThatAreOn) {
  for (const Model model : all_models()) {
    for (const Tier tier : {Tier::kBase, Tier::kAdvanced, Tier::kFull}) {
      for (unsigned index = 0; index < 32; ++index) {
        const Effects effects = testing_support::effect_subset(model, index);
        std::set<std::string> expected;
        for (const ParameterInfo& info : parameters_of(model)) {
          if (info.tier <= tier && effects.has(info.effect) && info.name != "anisotropic") {
            expected.insert(std::string(info.name));
          }
        }
        EXPECT_EQ(free_parameters(make_parametrisation(Material(model), {tier, effects, {}})), expected);
      }
    }
  }
}

TEST(FreeParameters, NeverHoldAnisotropy) {
  const Parametrisation p =
      make_parametrisation(Material(Model::kBurley), {Tier::kFull, effects_of(Model::kBurley), {}});
  EXPECT_FALSE(free_parameters(p).contains("anisotropic"));
}

TEST(FreeParameters, OfTheFullModelsAreAsManyAsTheirProductForms) {
  const auto size = [](Model model) {
    return make_parametrisation(Material(model), {Tier::kFull, fitted_effects(model), {}}).size();
  };
  EXPECT_EQ(size(Model::kLambertGgx), 6U);
  EXPECT_EQ(size(Model::kBurley), 12U);
  EXPECT_EQ(size(Model::kCallisto), 23U);
}

TEST(FreeParameters, HaveTheRangesOfTheTable) {
  for (const Model model : all_models()) {
    const Parametrisation p = make_parametrisation(Material(model), {Tier::kFull, fitted_effects(model), {}});
    for (const FreeParameter& parameter : p.free) {
      const ParameterInfo& info = *find_parameter(model, parameter.parameter);
      EXPECT_EQ(parameter.lower, info.lower) << parameter.name;
      EXPECT_EQ(parameter.upper, info.upper) << parameter.name;
      EXPECT_EQ(parameter.relative, info.upper == 256.0) << parameter.name;
    }
  }
}

TEST(FreeParameters, AreNamedByParameterAndChannel) {
  const Parametrisation p =
      make_parametrisation(Material(), {Tier::kFull, {}, {{"metallic", {0.0}}, {"specular", {0.5}}}});
  std::vector<std::string> names;
  for (const FreeParameter& parameter : p.free) names.push_back(parameter.name);
  EXPECT_THAT(names, UnorderedElementsAre("base_color.r", "base_color.g", "base_color.b", "roughness"));
}

// Names of products end in a channel; so do not all names that end in one of its letters.
TEST(FreeParameters, RoundTripThroughMaterials) {
  Random random(81);
  for (const Model model : all_models()) {
    for (unsigned index = 0; index < 32; ++index) {
      const Effects effects = testing_support::effect_subset(model, index).without(Effect::kAnisotropic);
      const Material material = canonical_material(model, effects, random);
      const Parametrisation p = make_parametrisation(material, {Tier::kFull, effects, {}});
      const std::vector<double> x = p.from_material(material);
      const Material back = p.to_material(x);
      for (const ParameterInfo& info : parameters_of(model)) {
        if (!effects.has(info.effect)) continue;
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_NEAR(back.colour(info.name)[c], material.colour(info.name)[c], 1e-15 * info.upper)
              << info.name;
        }
      }
      EXPECT_EQ(p.from_material(back).size(), x.size());
      for (std::size_t k = 0; k < x.size(); ++k)
        EXPECT_NEAR(p.from_material(back)[k], x[k], 1e-15 * (1 + x[k]));
    }
  }
}

// The optimiser's product form is that of the material that is published.
TEST(FreeParameters, MakeTheProductFormOfTheirMaterial) {
  Random random(82);
  for (const Model model : all_models()) {
    for (const FixedValues& fixed :
         {FixedValues{}, FixedValues{{"roughness", {0.3}}}, FixedValues{{"base_color", {0.2, 0.4, 0.6}}}}) {
      const Material start = testing_support::interior_material(model, fitted_effects(model), random);
      const Parametrisation p = make_parametrisation(start, {Tier::kFull, fitted_effects(model), fixed});
      std::vector<double> x;
      for (const FreeParameter& parameter : p.free) {
        x.push_back(testing_support::uniform(random, parameter.lower, parameter.upper));
      }
      // A material has one sign for all three channels.
      for (const std::size_t k : p.one_signed) x[k] = -std::abs(x[k]);
      const std::vector<double> q = p.product(x);
      const std::vector<double> published = product_form(p.to_material(x));
      ASSERT_EQ(q.size(), published.size());
      for (std::size_t k = 0; k < q.size(); ++k)
        EXPECT_NEAR(q[k], published[k], 1e-13 * (1 + std::abs(q[k])));
    }
  }
}

TEST(Products, HaveATintWhoseLargestChannelIsOne) {
  const Effects effects = effects_of(Model::kCallisto);
  const Parametrisation p = make_parametrisation(Material(Model::kCallisto), {Tier::kFull, effects, {}});
  std::vector<double> x = p.from_material(Material(Model::kCallisto));
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (p.free[k].name == "retroreflection.r") x[k] = 2.0;
    if (p.free[k].name == "retroreflection.g") x[k] = 8.0;
    if (p.free[k].name == "retroreflection.b") x[k] = 0.0;
  }
  for (std::size_t c = 0; c < 3; ++c) x[p.one_signed[c]] = std::array{-0.1, -0.2, -0.4}[c];
  const Material material = p.to_material(x);
  EXPECT_EQ(material.number("retroreflection"), 8.0);
  EXPECT_EQ(material.colour("retroreflection_tint"), (Rgb{0.25, 1.0, 0.0}));
  EXPECT_EQ(material.number("smooth_terminator"), -0.4);
  EXPECT_EQ(material.colour("smooth_terminator_tint"), (Rgb{0.25, 0.5, 1.0}));
  EXPECT_TRUE(material.is_valid(nullptr));
}

TEST(Products, OfZeroHaveAWhiteTint) {
  const Parametrisation p =
      make_parametrisation(Material(Model::kCallisto), {Tier::kFull, effects_of(Model::kCallisto), {}});
  const Material material = p.to_material(std::vector<double>(p.size(), 0.0));
  EXPECT_EQ(material.number("diffuse_fresnel"), 0.0);
  EXPECT_EQ(material.colour("diffuse_fresnel_tint"), (Rgb{1.0, 1.0, 1.0}));
}

TEST(Products, WithBothSignsAreListed) {
  const Effects effects = effects_of(Model::kCallisto);
  const Parametrisation p = make_parametrisation(Material(Model::kCallisto), {Tier::kFull, effects, {}});
  ASSERT_EQ(p.one_signed.size(), 3U);
  for (const std::size_t k : p.one_signed) EXPECT_EQ(p.free[k].parameter, "smooth_terminator");
  const Parametrisation without = make_parametrisation(
      Material(Model::kCallisto), {Tier::kFull, effects.without(Effect::kSmoothTerminator), {}});
  EXPECT_TRUE(without.one_signed.empty());
}

// Below the tier of tints an intensity is one number, whose tint is that of the start.
TEST(Products, WithoutAFreeTintAreOneNumberTimesIt) {
  Material start(Model::kCallisto);
  start.set_effects(effects_of(Model::kCallisto));
  start.set("retroreflection_tint", Rgb{1.0, 0.5, 0.25});
  const auto check = [&](const FreedomOptions& options) {
    const Parametrisation p = make_parametrisation(start, options);
    std::vector<double> x = p.from_material(start);
    const auto at = std::ranges::find(p.free, "retroreflection", &FreeParameter::name) - p.free.begin();
    ASSERT_LT(at, std::ssize(x));
    x[static_cast<std::size_t>(at)] = 6.0;
    const Material material = p.to_material(x);
    EXPECT_EQ(material.number("retroreflection"), 6.0);
    EXPECT_EQ(material.colour("retroreflection_tint"), (Rgb{1.0, 0.5, 0.25}));
    EXPECT_EQ(p.product(x), product_form(material));
  };
  check({Tier::kBase, effects_of(Model::kCallisto), {}});
  check({Tier::kFull, effects_of(Model::kCallisto), {{"retroreflection_tint", {1.0, 0.5, 0.25}}}});
}

TEST(Products, WithAFixedIntensityHaveAFreeTint) {
  const Parametrisation p = make_parametrisation(
      Material(Model::kCallisto), {Tier::kFull, effects_of(Model::kCallisto), {{"retroreflection", {5.0}}}});
  std::vector<double> x = p.from_material(p.start);
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (p.free[k].name == "retroreflection_tint.g") x[k] = 0.5;
    if (p.free[k].name == "retroreflection_tint.b") x[k] = 0.2;
  }
  const Material material = p.to_material(x);
  EXPECT_EQ(material.number("retroreflection"), 5.0);
  EXPECT_EQ(material.colour("retroreflection_tint"), (Rgb{1.0, 0.5, 0.2}));
  EXPECT_EQ(p.product(x), product_form(material));
}

TEST(FixedParameters, HoldTheirValueAndAreNotFree) {
  const FixedValues fixed = {{"roughness", {0.25}}, {"base_color", {0.1, 0.2, 0.3}}};
  const Parametrisation p = make_parametrisation(Material(), {Tier::kFull, {}, fixed});
  EXPECT_EQ(free_parameters(p), (std::set<std::string>{"metallic", "specular"}));
  const Material material = p.to_material(std::vector<double>{0.9, 0.8});
  EXPECT_EQ(material.number("roughness"), 0.25);
  EXPECT_EQ(material.colour("base_color"), (Rgb{0.1, 0.2, 0.3}));
}

TEST(FixedParameters, TakeOneNumberForAllChannels) {
  const Parametrisation p = make_parametrisation(Material(), {Tier::kFull, {}, {{"base_color", {0.3}}}});
  EXPECT_EQ(p.start.colour("base_color"), (Rgb{0.3, 0.3, 0.3}));
}

TEST(FixedParameters, MayLeaveNothingFree) {
  const FixedValues fixed = {
      {"base_color", {0.3}}, {"metallic", {0.0}}, {"specular", {0.5}}, {"roughness", {0.4}}};
  const Parametrisation p = make_parametrisation(Material(), {Tier::kFull, {}, fixed});
  EXPECT_EQ(p.size(), 0U);
  EXPECT_EQ(p.product({}), product_form(p.start));
}

TEST(FixedParameters, OutsideTheTierAreAllowed) {
  const Parametrisation p = make_parametrisation(
      Material(Model::kCallisto),
      {Tier::kBase, effects_of(Model::kCallisto), {{"smooth_terminator_length", {0.9}}}});
  EXPECT_EQ(p.start.number("smooth_terminator_length"), 0.9);
}

TEST(FromMaterial, MovesValuesOutsideToTheNearestBound) {
  Material material;
  material.values()[0] = 1.5;
  material.set("roughness", 0.0);
  const Parametrisation p = make_parametrisation(Material(), {Tier::kFull, {}, {}});
  const std::vector<double> x = p.from_material(material);
  EXPECT_EQ(x.front(), 1.0);
  EXPECT_EQ(x[5], 0.01);
}

TEST(Scale, IsTheRangeOrForIntensitiesTheirOwnSize) {
  const Parametrisation p =
      make_parametrisation(Material(Model::kCallisto), {Tier::kFull, effects_of(Model::kCallisto), {}});
  for (std::size_t k = 0; k < p.size(); ++k) {
    const FreeParameter& parameter = p.free[k];
    if (parameter.parameter == "diffuse_fresnel") {
      EXPECT_EQ(p.scale(k, 20.0), 20.0);
      EXPECT_EQ(p.scale(k, 0.01), 1.0);
    } else if (!parameter.relative) {
      EXPECT_EQ(p.scale(k, 0.3), parameter.upper - parameter.lower) << parameter.name;
    }
  }
}

// What a user sees of a wrong --fix.
void expect_refused(Model model, Effects effects, const FixedValues& fixed, const std::string& part) {
  try {
    make_parametrisation(Material(model), {Tier::kFull, effects, fixed});
    ADD_FAILURE() << "accepted; expected: " << part;
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(part));
  }
}

TEST(FixedParameters, AreRefusedWithAReason) {
  expect_refused(Model::kBurley, {}, {{"retroreflection", {1.0}}},
                 "Burley has no parameter \"retroreflection\"");
  expect_refused(Model::kCallisto, {}, {{"retroreflection", {1.0}}}, "its effect retroreflection is off");
  expect_refused(Model::kLambertGgx, {}, {{"roughness", {0.001}}}, "roughness");
  expect_refused(Model::kLambertGgx, {}, {{"roughness", {std::nan("")}}}, "roughness");
  expect_refused(Model::kLambertGgx, {}, {{"roughness", {0.1, 0.2, 0.3}}}, "takes 1 number");
  expect_refused(Model::kLambertGgx, {}, {{"base_color", {0.1, 0.2}}}, "takes 1 or 3 numbers");
  expect_refused(Model::kLambertGgx, {}, {{"base_color", {}}}, "takes 1 or 3 numbers");
}

TEST(Parametrisation, RefusesEffectsThatTheModelDoesNotHave) {
  EXPECT_THROW(
      make_parametrisation(Material(Model::kLambertGgx), {Tier::kFull, effects_of(Model::kCallisto), {}}),
      std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::fit
