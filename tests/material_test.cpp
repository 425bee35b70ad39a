// The parameter tables as documented, and the material that they describe.
#include "brdf/material.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace brdfit {
namespace {

using testing::HasSubstr;

// One row of the documented tables.
struct Row {
  std::string_view name;
  int components;
  double lower;
  double upper;
  double default_value;
  Tier tier;
  std::string_view effect;
};

constexpr Row kShared[] = {
    {"base_color", 3, 0, 1, 0.18, Tier::kBase, "none"},
    {"metallic", 1, 0, 1, 0, Tier::kBase, "none"},
    {"specular", 1, 0, 1, 0.5, Tier::kBase, "none"},
    {"roughness", 1, 0.01, 1, 0.5, Tier::kBase, "none"},
};

constexpr Row kBurley[] = {
    {"subsurface", 1, 0, 1, 0, Tier::kBase, "subsurface"},
    {"specular_tint", 1, 0, 1, 0, Tier::kBase, "specular_tint"},
    {"anisotropic", 1, 0, 1, 0, Tier::kBase, "anisotropic"},
    {"sheen", 1, 0, 1, 0, Tier::kBase, "sheen"},
    {"sheen_tint", 1, 0, 1, 0.5, Tier::kBase, "sheen"},
    {"clearcoat", 1, 0, 4, 0, Tier::kBase, "clearcoat"},
    {"clearcoat_gloss", 1, 0, 1, 1, Tier::kBase, "clearcoat"},
};

constexpr Row kCallisto[] = {
    {"diffuse_fresnel", 1, 0, 256, 1, Tier::kBase, "diffuse_fresnel"},
    {"diffuse_fresnel_falloff", 1, 0, 1, 0.75, Tier::kBase, "diffuse_fresnel"},
    {"diffuse_fresnel_tint", 3, 0, 1, 1, Tier::kAdvanced, "diffuse_fresnel"},
    {"diffuse_fresnel_tangent_falloff", 1, 0, 1, 0.75, Tier::kFull, "diffuse_fresnel"},
    {"retroreflection", 1, 0, 256, 1, Tier::kBase, "retroreflection"},
    {"retroreflection_falloff", 1, 0, 1, 0.75, Tier::kBase, "retroreflection"},
    {"retroreflection_tint", 3, 0, 1, 1, Tier::kAdvanced, "retroreflection"},
    {"retroreflection_tangent_falloff", 1, 0, 1, 0.75, Tier::kFull, "retroreflection"},
    {"smooth_terminator", 1, -1, 1, 0, Tier::kBase, "smooth_terminator"},
    {"smooth_terminator_tint", 3, 0, 1, 1, Tier::kAdvanced, "smooth_terminator"},
    {"smooth_terminator_length", 1, 0, 1, 0.5, Tier::kFull, "smooth_terminator"},
    {"specular_fresnel_falloff", 1, 0, 1, 0.5, Tier::kAdvanced, "specular_fresnel_falloff"},
    {"dual_specular_roughness_scale", 1, 1, 16, 2, Tier::kAdvanced, "dual_specular"},
    {"dual_specular_opacity", 1, 0, 1, 0, Tier::kAdvanced, "dual_specular"},
};

void expect_rows(Model model, std::span<const Row> own) {
  std::vector<Row> rows(std::begin(kShared), std::end(kShared));
  rows.insert(rows.end(), own.begin(), own.end());
  ASSERT_EQ(parameters_of(model).size(), rows.size());
  for (const Row& row : rows) {
    const ParameterInfo* info = find_parameter(model, row.name);
    ASSERT_NE(info, nullptr) << row.name;
    EXPECT_EQ(info->components, row.components) << row.name;
    EXPECT_EQ(info->lower, row.lower) << row.name;
    EXPECT_EQ(info->upper, row.upper) << row.name;
    EXPECT_EQ(info->default_value, row.default_value) << row.name;
    EXPECT_EQ(info->tier, row.tier) << row.name;
    EXPECT_EQ(effect_name(info->effect), row.effect) << row.name;
    EXPECT_FALSE(info->help.empty()) << row.name;
  }
}

TEST(ParameterTable, OfLambertGgxEqualsTheDocumentedOne) {
  expect_rows(Model::kLambertGgx, {});
}

TEST(ParameterTable, OfBurleyEqualsTheDocumentedOne) {
  expect_rows(Model::kBurley, kBurley);
}

TEST(ParameterTable, OfCallistoEqualsTheDocumentedOne) {
  expect_rows(Model::kCallisto, kCallisto);
}

TEST(ParameterTable, DefaultsAreInRange) {
  for (const Model model : all_models()) EXPECT_TRUE(Material(model).is_valid(nullptr)) << name_of(model);
}

TEST(ParameterTable, TintsAndIntensitiesNameEachOther) {
  for (const Model model : all_models()) {
    for (const ParameterInfo& info : parameters_of(model)) {
      const bool paired = info.kind == Kind::kTint || info.kind == Kind::kIntensity;
      ASSERT_EQ(info.partner.empty(), !paired) << info.name;
      if (!paired) continue;
      const ParameterInfo* partner = find_parameter(model, info.partner);
      ASSERT_NE(partner, nullptr) << info.name;
      EXPECT_EQ(partner->partner, info.name);
      EXPECT_EQ(partner->effect, info.effect) << info.name;
      EXPECT_EQ(partner->kind, info.kind == Kind::kTint ? Kind::kIntensity : Kind::kTint) << info.name;
    }
  }
}

TEST(ParameterTable, KindsFollowTheNumberOfComponents) {
  for (const Model model : all_models()) {
    for (const ParameterInfo& info : parameters_of(model)) {
      const bool colour = info.kind == Kind::kColour || info.kind == Kind::kTint;
      EXPECT_EQ(info.components, colour ? 3 : 1) << info.name;
    }
  }
}

TEST(ParameterTable, HasNoUnknownNames) {
  EXPECT_EQ(find_parameter(Model::kCallisto, "sheen"), nullptr);
  EXPECT_EQ(find_parameter(Model::kBurley, "diffuse_fresnel"), nullptr);
  EXPECT_EQ(find_parameter(Model::kLambertGgx, ""), nullptr);
  EXPECT_EQ(find_parameter(Model::kLambertGgx, "Roughness"), nullptr);
}

TEST(Names, AreThoseOfTheFiles) {
  EXPECT_EQ(name_of(Model::kLambertGgx), "lambert-ggx");
  EXPECT_EQ(name_of(Model::kBurley), "burley");
  EXPECT_EQ(name_of(Model::kCallisto), "callisto");
  EXPECT_EQ(name_of(Tier::kBase), "base");
  EXPECT_EQ(name_of(Tier::kAdvanced), "advanced");
  EXPECT_EQ(name_of(Tier::kFull), "full");
  EXPECT_EQ(name_of(Masking::kSeparable), "separable");
  EXPECT_EQ(name_of(Masking::kCorrelated), "correlated");
  EXPECT_EQ(name_of(BurleyG::k2012), "2012");
  EXPECT_EQ(name_of(BurleyG::k2017), "2017");
  EXPECT_EQ(name_of(Diffuse::kLambert), "lambert");
  EXPECT_EQ(name_of(Diffuse::kProxima), "proxima");
}

TEST(Names, FindWhatTheyName) {
  for (const Model model : all_models()) EXPECT_EQ(model_by_name(name_of(model)), model);
  for (const Tier tier : {Tier::kBase, Tier::kAdvanced, Tier::kFull}) {
    EXPECT_EQ(tier_by_name(name_of(tier)), tier);
  }
  EXPECT_EQ(masking_by_name("separable"), Masking::kSeparable);
  EXPECT_EQ(masking_by_name("correlated"), Masking::kCorrelated);
  EXPECT_EQ(burley_g_by_name("2012"), BurleyG::k2012);
  EXPECT_EQ(burley_g_by_name("2017"), BurleyG::k2017);
  EXPECT_EQ(diffuse_by_name("lambert"), Diffuse::kLambert);
  EXPECT_EQ(diffuse_by_name("proxima"), Diffuse::kProxima);
}

TEST(Names, UnknownOnesAreNotFound) {
  for (const char* name : {"", "disney", "Callisto", "lambert_ggx", "2013", "smith", "oren-nayar", "all"}) {
    EXPECT_FALSE(model_by_name(name).has_value()) << name;
    EXPECT_FALSE(tier_by_name(name).has_value()) << name;
    EXPECT_FALSE(masking_by_name(name).has_value()) << name;
    EXPECT_FALSE(burley_g_by_name(name).has_value()) << name;
    EXPECT_FALSE(diffuse_by_name(name).has_value()) << name;
  }
}

TEST(Options, DefaultToSeparableMaskingTheFormOf2012AndLambert) {
  const MaterialOptions options;
  EXPECT_EQ(options.masking, Masking::kSeparable);
  EXPECT_EQ(options.burley_g, BurleyG::k2012);
  EXPECT_EQ(options.diffuse, Diffuse::kLambert);
}

TEST(Material, StartsAtTheDefaultsWithoutEffects) {
  const Material material(Model::kCallisto);
  EXPECT_EQ(material.effects(), Effects());
  for (const ParameterInfo& info : parameters_of(Model::kCallisto)) {
    EXPECT_EQ(material.colour(info.name), (Rgb{info.default_value, info.default_value, info.default_value}));
  }
}

TEST(Material, KeepsWhatIsSetAndNothingElse) {
  Material material(Model::kCallisto);
  material.set("retroreflection_tint", Rgb{0.1, 0.2, 1.0});
  material.set("retroreflection", 12.0);
  EXPECT_EQ(material.colour("retroreflection_tint"), (Rgb{0.1, 0.2, 1.0}));
  EXPECT_EQ(material.number("retroreflection"), 12.0);
  Material restored = material;
  restored.set("retroreflection_tint", 1.0);
  restored.set("retroreflection", 1.0);
  EXPECT_EQ(restored, Material(Model::kCallisto));
}

TEST(Material, RefusesParametersThatTheModelLacks) {
  Material material(Model::kBurley);
  EXPECT_THROW(material.number("retroreflection"), std::invalid_argument);
  EXPECT_THROW(material.colour(""), std::invalid_argument);
  EXPECT_THROW(material.set("alpha", 0.1), std::invalid_argument);
  EXPECT_THROW(material.set("alpha", Rgb{1, 1, 1}), std::invalid_argument);
}

TEST(Material, SaysWhichParameterTheModelLacks) {
  try {
    Material(Model::kLambertGgx).set("sheen", 1.0);
    FAIL() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("sheen"), HasSubstr("Lambert + GGX")));
  }
}

TEST(Material, RefusesAColourForANumber) {
  Material material(Model::kBurley);
  EXPECT_THROW(material.set("roughness", Rgb{0.1, 0.2, 0.3}), std::invalid_argument);
  EXPECT_EQ(material, Material(Model::kBurley));
}

TEST(Material, RefusesEffectsOfOtherModels) {
  Material material(Model::kBurley);
  EXPECT_THROW(material.set_effects(Effects().with(Effect::kDualSpecular)), std::invalid_argument);
  EXPECT_EQ(material.effects(), Effects());
  material.set_effects(effects_of(Model::kBurley));
  EXPECT_EQ(material.effects(), effects_of(Model::kBurley));
}

TEST(Validity, AcceptsBothEndsOfEveryRange) {
  for (const Model model : all_models()) {
    for (const ParameterInfo& info : parameters_of(model)) {
      for (const double value : {info.lower, info.upper}) {
        Material material(model);
        material.set(info.name, value);
        std::string why = "untouched";
        EXPECT_TRUE(material.is_valid(&why)) << info.name << ": " << why;
        EXPECT_EQ(why, "untouched");
      }
    }
  }
}

TEST(Validity, RefusesWhatIsOutsideOrNotANumberAndNamesIt) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const Model model : all_models()) {
    for (const ParameterInfo& info : parameters_of(model)) {
      for (const double value :
           {std::nextafter(info.lower, -kInfinity), std::nextafter(info.upper, kInfinity),
            std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity}) {
        for (int component = 0; component < info.components; ++component) {
          Material material(model);
          material.values()[static_cast<std::size_t>(info.offset + component)] = value;
          std::string why;
          EXPECT_FALSE(material.is_valid(&why)) << info.name << " " << value;
          EXPECT_THAT(why, HasSubstr(std::string(info.name)));
          EXPECT_FALSE(material.is_valid(nullptr));
        }
      }
    }
  }
}

TEST(Validity, SaysTheValueAndTheRange) {
  Material material(Model::kCallisto);
  material.set("roughness", 0.0);
  std::string why;
  EXPECT_FALSE(material.is_valid(&why));
  EXPECT_EQ(why, "roughness is 0, not in [0.01, 1]");
}

TEST(Validity, NeverShowsAWrongValueAsIfItWereInRange) {
  Material material(Model::kCallisto);
  material.set("retroreflection", std::nextafter(256.0, 300.0));
  std::string why;
  EXPECT_FALSE(material.is_valid(&why));
  EXPECT_THAT(why, testing::Not(HasSubstr("is 256,")));
}

}  // namespace
}  // namespace brdfit
