// What a fit can switch, and how lists of names are read.
#include "fit/groups.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "fit/parameters.h"

namespace brdfit::fit {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

Groups named(Model model, const std::vector<std::string>& names) {
  return groups_by_names(model, names);
}

std::vector<std::string> names(Model model, Groups groups) {
  return names_of_groups(model, groups);
}

TEST(Groups, TakeEveryParameterOfAnEffectOnce) {
  for (const Model model : all_models()) {
    for (const ParameterInfo& info : parameters_of(model)) {
      const auto group = group_of_parameter(model, info.name);
      const bool switched = info.effect != Effect::kNone && info.effect != Effect::kAnisotropic;
      ASSERT_EQ(group.has_value(), switched) << info.name;
      if (!switched) continue;
      EXPECT_EQ(groups_of(model)[*group].effect, info.effect) << info.name;
    }
    for (std::size_t k = 0; k < groups_of(model).size(); ++k) {
      EXPECT_EQ(group_by_name(model, groups_of(model)[k].name), k);
    }
  }
}

TEST(Groups, OfEachModelAreItsEffectsAndTheirRefinements) {
  EXPECT_THAT(groups_of(Model::kLambertGgx), IsEmpty());
  for (const Model model : {Model::kBurley, Model::kCallisto}) {
    const Groups all = groups_of_effects(model, effects_of(model));
    EXPECT_EQ(static_cast<std::size_t>(all.size()), groups_of(model).size());
    EXPECT_EQ(effects_of_groups(model, all), effects_of(model).without(Effect::kAnisotropic));
  }
  EXPECT_EQ(group_of_parameter(Model::kBurley, "clearcoat_gloss"),
            group_by_name(Model::kBurley, "clearcoat"));
  EXPECT_EQ(group_of_parameter(Model::kCallisto, "retroreflection_falloff"),
            group_by_name(Model::kCallisto, "retroreflection"));
  EXPECT_THAT(names(Model::kCallisto, family_of(Model::kCallisto, 1)),
              ElementsAre("diffuse_fresnel", "diffuse_fresnel_tint", "diffuse_fresnel_tangent_falloff"));
}

TEST(Groups, OfATierAreThoseWithAParameterInIt) {
  const Effects all = effects_of(Model::kCallisto);
  EXPECT_THAT(names(Model::kCallisto, usable_groups(Model::kCallisto, Tier::kBase, all)),
              UnorderedElementsAre("diffuse_fresnel", "retroreflection", "smooth_terminator"));
  EXPECT_THAT(names(Model::kCallisto, usable_groups(Model::kCallisto, Tier::kAdvanced, all)),
              UnorderedElementsAre("diffuse_fresnel", "retroreflection", "smooth_terminator", "dual_specular",
                                   "specular_fresnel_falloff", "diffuse_fresnel_tint", "retroreflection_tint",
                                   "smooth_terminator_tint"));
  EXPECT_EQ(usable_groups(Model::kCallisto, Tier::kFull, all), groups_of_effects(Model::kCallisto, all));
  EXPECT_THAT(
      names(Model::kCallisto,
            usable_groups(Model::kCallisto, Tier::kFull, Effects().with(Effect::kSmoothTerminator))),
      UnorderedElementsAre("smooth_terminator", "smooth_terminator_tint", "smooth_terminator_length"));
}

TEST(Groups, AnEffectInAListBringsItsRefinementsUnlessSomeAreNamed) {
  const Model model = Model::kCallisto;
  EXPECT_EQ(named(model, {"retroreflection"}),
            groups_of_effects(model, Effects().with(Effect::kRetroreflection)));
  EXPECT_THAT(names(model, named(model, {"retroreflection", "retroreflection_tint"})),
              UnorderedElementsAre("retroreflection", "retroreflection_tint"));
}

TEST(Groups, ARefinementInAListBringsItsEffect) {
  EXPECT_THAT(names(Model::kCallisto, named(Model::kCallisto, {"smooth_terminator_length", "dual_specular"})),
              UnorderedElementsAre("smooth_terminator", "smooth_terminator_length", "dual_specular"));
  EXPECT_THAT(names(Model::kBurley, named(Model::kBurley, {"sheen_tint", "dual_specular"})),
              UnorderedElementsAre("sheen", "sheen_tint"));
}

TEST(GroupsThatAreOff, LeaveTheirParametersAtTheirDefaults) {
  for (const Model model : {Model::kBurley, Model::kCallisto}) {
    const Groups all = groups_of_effects(model, effects_of(model));
    for (std::uint32_t bits = 0; bits <= all.bits(); ++bits) {
      const Groups groups(bits);
      Material start(model);
      for (const ParameterInfo& info : parameters_of(model)) {
        start.set(info.name, 0.5 * (info.lower + info.upper) + 0.01);
      }
      const Parametrisation parametrisation =
          make_parametrisation(start, {Tier::kFull, effects_of(model), {}, groups});
      const std::vector<double> x(parametrisation.size(), 0.3);
      const Material material = parametrisation.to_material(x);
      const Effects effects = effects_of_groups(model, groups);
      ASSERT_EQ(material.effects(), effects);
      for (const ParameterInfo& info : parameters_of(model)) {
        const auto group = group_of_parameter(model, info.name);
        if (!group) continue;
        if (!groups.has(*group)) {
          EXPECT_EQ(material.number(info.name), info.default_value) << info.name << " " << bits;
        }
      }
      for (const FreeParameter& parameter : parametrisation.free) {
        const auto group = group_of_parameter(model, parameter.parameter);
        EXPECT_TRUE(!group || groups.has(*group)) << parameter.name << " " << bits;
      }
    }
  }
}

TEST(GroupsThatAreOff, RefuseAFixedParameter) {
  const Groups groups = named(Model::kCallisto, {"retroreflection", "retroreflection_tint"});
  const FreedomOptions options = {
      Tier::kFull, effects_of(Model::kCallisto), {{"retroreflection_tangent_falloff", {0.5}}}, groups};
  EXPECT_THROW(make_parametrisation(Material(Model::kCallisto), options), std::invalid_argument);
}

// The count of a tinted triple, of one number for it, and of nothing.
TEST(GroupsThatAreOn, FreeTheirNumbersAlone) {
  const auto size = [](const std::vector<std::string>& list) {
    return make_parametrisation(
               Material(Model::kCallisto),
               {Tier::kFull, effects_of(Model::kCallisto), {}, groups_by_names(Model::kCallisto, list)})
        .size();
  };
  EXPECT_EQ(size({}), 6U);
  EXPECT_EQ(size({"diffuse_fresnel", "diffuse_fresnel_tint"}), 6U + 4U);
  EXPECT_EQ(size({"diffuse_fresnel", "diffuse_fresnel_tangent_falloff"}), 6U + 3U);
  EXPECT_EQ(size({"diffuse_fresnel"}), 6U + 5U);
  EXPECT_EQ(size({"dual_specular", "specular_fresnel_falloff"}), 6U + 3U);
}

}  // namespace
}  // namespace brdfit::fit
