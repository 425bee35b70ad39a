// Random materials: in the interior of their ranges, the same for a seed, within tier and effects.
#include "data/synthetic/random_material.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace brdfit::synthetic {
namespace {

constexpr std::uint64_t kSeeds = 300;
constexpr Tier kTiers[] = {Tier::kBase, Tier::kAdvanced, Tier::kFull};

Material full(Model model, std::uint64_t seed) {
  return random_material(model, Tier::kFull, effects_of(model), {}, seed);
}

bool is_default(const Material& material, const ParameterInfo& info) {
  const auto first = material.values().subspan(static_cast<std::size_t>(info.offset));
  return std::ranges::all_of(first.first(static_cast<std::size_t>(info.components)),
                             [&](double value) { return value == info.default_value; });
}

bool within(double value, double lower, double upper) {
  return value >= lower && value <= upper;
}

// Whether a number of that parameter may be drawn.
bool allowed(const ParameterInfo& info, double value) {
  if (info.kind == Kind::kColour) return within(value, 0.05, 0.95);
  if (info.kind == Kind::kTint) return value == 1.0 || within(value, 0.2, 0.95);
  if (info.name == "smooth_terminator") return within(std::abs(value), 0.1, 0.9);
  if (info.kind == Kind::kIntensity) return within(value, 0.2, 20.0) && std::abs(value - 1.0) > 0.2;
  if (info.name == "specular_fresnel_falloff") return within(value, 0.1, 0.45) || within(value, 0.55, 0.9);
  if (info.name == "dual_specular_roughness_scale") return within(value, 1.5, 4.0);
  if (info.name == "clearcoat") return within(value, 0.2, 2.0);
  if (info.name == "anisotropic") return value == 0.0;
  return within(value, 0.1, 0.9);
}

TEST(RandomMaterial, EveryParameterIsDrawnInTheInteriorOfItsRange) {
  for (const Model model : all_models()) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const Material material = full(model, seed);
      std::string why;
      ASSERT_TRUE(material.is_valid(&why)) << name_of(model) << " " << seed << ": " << why;
      for (const ParameterInfo& info : parameters_of(model)) {
        for (const double value : material.colour(info.name)) {
          EXPECT_TRUE(allowed(info, value))
              << name_of(model) << " " << seed << " " << info.name << " " << value;
        }
      }
    }
  }
}

TEST(RandomMaterial, EveryTintHasALargestChannelOfOne) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Material material = full(Model::kCallisto, seed);
    for (const ParameterInfo& info : parameters_of(Model::kCallisto)) {
      if (info.kind != Kind::kTint) continue;
      const Rgb tint = material.colour(info.name);
      EXPECT_EQ(std::ranges::count(tint, 1.0), 1) << seed << " " << info.name;
    }
  }
}

TEST(RandomMaterial, SecondLobeStaysBelowRoughnessOne) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Material material = full(Model::kCallisto, seed);
    EXPECT_LT(material.number("roughness") * material.number("dual_specular_roughness_scale"), 0.95) << seed;
  }
}

TEST(RandomMaterial, IntensitiesSpreadOverTheirDecades) {
  int below_1 = 0;
  int above_4 = 0;
  int negative = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Material material = full(Model::kCallisto, seed);
    below_1 += material.number("retroreflection") < 1.0 ? 1 : 0;
    above_4 += material.number("retroreflection") > 4.0 ? 1 : 0;
    negative += material.number("smooth_terminator") < 0.0 ? 1 : 0;
  }
  // Of ln 100 = 4.61 less the gap's ln 1.5: ln 4 below 1, ln 5 above 4. Five standard deviations of a
  // binomial.
  const double n = kSeeds;
  const double whole = std::log(100.0) - std::log(1.5);
  const auto expect_share = [&](int count, double share) {
    EXPECT_NEAR(count, n * share, 5.0 * std::sqrt(n * share * (1.0 - share)));
  };
  expect_share(below_1, std::log(4.0) / whole);
  expect_share(above_4, std::log(5.0) / whole);
  expect_share(negative, 0.5);
}

TEST(RandomMaterial, ParametersBeyondTheTierStayAtTheirDefaults) {
  for (const Model model : all_models()) {
    for (const Tier tier : kTiers) {
      const Material material = random_material(model, tier, effects_of(model), {}, 3);
      for (const ParameterInfo& info : parameters_of(model)) {
        const bool drawn = info.tier <= tier && info.effect != Effect::kAnisotropic;
        EXPECT_EQ(is_default(material, info), !drawn)
            << name_of(model) << " " << name_of(tier) << " " << info.name;
      }
    }
  }
}

TEST(RandomMaterial, ParametersOfEffectsThatAreOffStayAtTheirDefaults) {
  for (const Model model : all_models()) {
    for (const Effect off : all_effects()) {
      const Effects effects = effects_of(model).without(off);
      const Material material = random_material(model, Tier::kFull, effects, {}, 4);
      EXPECT_EQ(material.effects(), effects.without(Effect::kAnisotropic));
      for (const ParameterInfo& info : parameters_of(model)) {
        const bool drawn = info.effect != off && info.effect != Effect::kAnisotropic;
        EXPECT_EQ(is_default(material, info), !drawn) << name_of(model) << " " << info.name;
      }
    }
  }
}

TEST(RandomMaterial, EffectsAreThoseInUse) {
  for (const Model model : all_models()) {
    for (const Tier tier : kTiers) {
      for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const Material material = random_material(model, tier, effects_of(model), {}, seed);
        EXPECT_EQ(material.effects(), effects_in_use(material)) << name_of(model) << " " << name_of(tier);
      }
    }
  }
}

TEST(RandomMaterial, OptionsAreKept) {
  MaterialOptions options;
  options.masking = Masking::kCorrelated;
  options.burley_g = BurleyG::k2017;
  options.diffuse = Diffuse::kProxima;
  for (const Model model : all_models()) {
    EXPECT_EQ(random_material(model, Tier::kFull, effects_of(model), options, 1).options(), options);
  }
}

TEST(RandomMaterial, SameSeedSameMaterialAndOtherSeedsOthers) {
  for (const Model model : all_models()) {
    std::set<double> reds;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      EXPECT_EQ(full(model, seed), full(model, seed));
      reds.insert(full(model, seed).colour("base_color")[0]);
    }
    EXPECT_EQ(reds.size(), kSeeds);
  }
}

TEST(RandomMaterial, SeedGivesTheseBitsOnEveryMachine) {
  const Material material = full(Model::kCallisto, 2023);
  EXPECT_EQ(material.number("roughness"), 0x1.1e118d5f26efbp-1);
  EXPECT_EQ(material.number("diffuse_fresnel"), 0x1.dbb5aa99ebd66p+0);
  EXPECT_EQ(material.number("dual_specular_opacity"), 0x1.231b5a3ec69ebp-1);
}

TEST(RandomMaterial, EffectsOfAnotherModelAreRefused) {
  EXPECT_THROW(random_material(Model::kBurley, Tier::kFull, effects_of(Model::kCallisto), {}, 1),
               std::invalid_argument);
  EXPECT_THROW(random_material(Model::kLambertGgx, Tier::kFull, effects_of(Model::kBurley), {}, 1),
               std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::synthetic
