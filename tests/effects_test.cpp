// The set of effects and their names.
#include "brdf/effects.h"

#include <gmock/gmock.h>

#include <set>
#include <string>

#include "brdf/material.h"

namespace brdfit {
namespace {

TEST(Effects, StartEmptyAndKeepWhatIsAdded) {
  Effects effects;
  EXPECT_EQ(effects.bits(), 0U);
  effects = effects.with(Effect::kDualSpecular).with(Effect::kSheen);
  EXPECT_TRUE(effects.has(Effect::kDualSpecular));
  EXPECT_TRUE(effects.has(Effect::kSheen));
  EXPECT_FALSE(effects.has(Effect::kClearcoat));
  EXPECT_EQ(effects.without(Effect::kSheen), Effects().with(Effect::kDualSpecular));
  EXPECT_EQ(effects.without(Effect::kClearcoat), effects);
}

TEST(Effects, NoneIsAlwaysPresentAndAddsNothing) {
  EXPECT_TRUE(Effects().has(Effect::kNone));
  EXPECT_EQ(Effects().with(Effect::kNone), Effects());
}

TEST(Effects, HaveOneBitEach) {
  std::uint32_t seen = 0;
  for (const Effect effect : all_effects()) {
    const auto bits = static_cast<std::uint32_t>(effect);
    EXPECT_EQ(bits & (bits - 1), 0U) << effect_name(effect);
    EXPECT_EQ(seen & bits, 0U) << effect_name(effect);
    seen |= bits;
  }
}

TEST(Effects, HaveTheirPublicNames) {
  std::set<std::string_view> names;
  for (const Effect effect : all_effects()) names.insert(effect_name(effect));
  EXPECT_THAT(names, testing::UnorderedElementsAre("diffuse_fresnel", "retroreflection", "smooth_terminator",
                                                   "specular_fresnel_falloff", "dual_specular", "subsurface",
                                                   "specular_tint", "anisotropic", "sheen", "clearcoat"));
}

TEST(Effects, AreFoundByTheirNames) {
  for (const Effect effect : all_effects()) EXPECT_EQ(effect_by_name(effect_name(effect)), effect);
}

TEST(Effects, UnknownNamesAreNotFound) {
  for (const char* name : {"", "none", "Sheen", "sheen ", "glitter"}) {
    EXPECT_FALSE(effect_by_name(name).has_value()) << name;
  }
}

TEST(EffectsOf, AreThoseOfTheModelsParameters) {
  EXPECT_EQ(effects_of(Model::kLambertGgx), Effects());
  EXPECT_EQ(effects_of(Model::kBurley), Effects()
                                            .with(Effect::kSubsurface)
                                            .with(Effect::kSpecularTint)
                                            .with(Effect::kAnisotropic)
                                            .with(Effect::kSheen)
                                            .with(Effect::kClearcoat));
  EXPECT_EQ(effects_of(Model::kCallisto), Effects()
                                              .with(Effect::kDiffuseFresnel)
                                              .with(Effect::kRetroreflection)
                                              .with(Effect::kSmoothTerminator)
                                              .with(Effect::kSpecularFresnelFalloff)
                                              .with(Effect::kDualSpecular));
}

TEST(EffectsInUse, OfDefaultsAreNone) {
  for (const Model model : all_models()) EXPECT_EQ(effects_in_use(Material(model)), Effects());
}

struct Switch {
  Model model;
  const char* parameter;
  double value;
  Effect effect;
};

// Setting the parameter alone makes the effect visible.
const Switch kSwitches[] = {
    {Model::kCallisto, "diffuse_fresnel", 2.0, Effect::kDiffuseFresnel},
    {Model::kCallisto, "diffuse_fresnel", 0.0, Effect::kDiffuseFresnel},
    {Model::kCallisto, "diffuse_fresnel_tint", 0.5, Effect::kDiffuseFresnel},
    {Model::kCallisto, "retroreflection", 0.5, Effect::kRetroreflection},
    {Model::kCallisto, "retroreflection_tint", 0.5, Effect::kRetroreflection},
    {Model::kCallisto, "smooth_terminator", -0.1, Effect::kSmoothTerminator},
    {Model::kCallisto, "specular_fresnel_falloff", 0.0, Effect::kSpecularFresnelFalloff},
    {Model::kCallisto, "dual_specular_opacity", 0.1, Effect::kDualSpecular},
    {Model::kBurley, "subsurface", 0.1, Effect::kSubsurface},
    {Model::kBurley, "specular_tint", 0.1, Effect::kSpecularTint},
    {Model::kBurley, "anisotropic", 0.1, Effect::kAnisotropic},
    {Model::kBurley, "sheen", 0.1, Effect::kSheen},
    {Model::kBurley, "clearcoat", 0.1, Effect::kClearcoat},
};

TEST(EffectsInUse, FollowTheParameterThatSwitchesEach) {
  for (const Switch& s : kSwitches) {
    Material material(s.model);
    material.set(s.parameter, s.value);
    EXPECT_EQ(effects_in_use(material), Effects().with(s.effect)) << s.parameter;
  }
}

TEST(EffectsInUse, LeaveOutParametersThatChangeNothingByThemselves) {
  Material callisto(Model::kCallisto);
  for (const char* name :
       {"diffuse_fresnel_falloff", "diffuse_fresnel_tangent_falloff", "retroreflection_falloff",
        "retroreflection_tangent_falloff", "smooth_terminator_length", "smooth_terminator_tint"}) {
    callisto.set(name, 0.25);
  }
  callisto.set("dual_specular_roughness_scale", 8.0);
  callisto.set("roughness", 0.1);
  EXPECT_EQ(effects_in_use(callisto), Effects());
  Material burley(Model::kBurley);
  burley.set("sheen_tint", 0.1);
  burley.set("clearcoat_gloss", 0.1);
  EXPECT_EQ(effects_in_use(burley), Effects());
}

TEST(EffectsInUse, DoNotDependOnTheEffectsThatAreSet) {
  Material material(Model::kCallisto);
  material.set_effects(effects_of(Model::kCallisto));
  EXPECT_EQ(effects_in_use(material), Effects());
}

}  // namespace
}  // namespace brdfit
