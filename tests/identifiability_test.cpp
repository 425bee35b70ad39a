// What a fit says of its parameters: tied, unseen, at a bound.
#include "fit/identifiability.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "tests/fit_data.h"

namespace brdfit::fit {
namespace {

using testing_support::OwnedProblem;

constexpr Tier kFull = Tier::kFull;

Material grey_dielectric() {
  Material material;
  material.set("base_color", 0.5);
  material.set("metallic", 0.3);
  material.set("specular", 0.5);
  material.set("roughness", 0.4);
  return material;
}

Material with_effect(Effect effect) {
  Material material(Model::kCallisto);
  material.set_effects(Effects().with(effect));
  material.set("base_color", Rgb{0.6, 0.4, 0.2});
  material.set("metallic", 0.2);
  material.set("roughness", 0.4);
  return material;
}

// The evidence at a material's own, exact table.
struct Evidence {
  OwnedProblem owned;
  std::vector<double> x;
  Identifiability result;

  explicit Evidence(const Material& material, const FixedValues& fixed = {})
      : owned(testing_support::table_of(material), material, {kFull, material.effects(), fixed}),
        x(owned.parametrisation.from_material(material)),
        result(identify(owned.parametrisation, x, owned.problem.gram(x))) {}

  Status status(std::string_view name) const { return result.status[owned.index_of(name)]; }
  ParameterState state(std::string_view name) const {
    const auto states = public_states(owned.parametrisation, x, result);
    const auto found = std::ranges::find(states, name, &ParameterState::name);
    if (found == states.end()) throw std::logic_error("no such state");
    return *found;
  }
};

// Rows of a Jacobian by hand, in the unit ranges of Lambert + GGX with two free numbers.
Eigen::MatrixXd gram_of(const Eigen::MatrixXd& jacobian) {
  Eigen::MatrixXd with_residual(jacobian.rows(), jacobian.cols() + 1);
  with_residual << jacobian, Eigen::VectorXd::Ones(jacobian.rows());
  return with_residual.transpose() * with_residual;
}

Parametrisation two_numbers() {
  return make_parametrisation(Material(), {kFull, {}, {{"base_color", {0.5}}, {"roughness", {0.5}}}});
}

TEST(Identify, GivesTheRelativeSingularValuesOfTheScaledJacobian) {
  Eigen::MatrixXd jacobian(3, 2);
  jacobian << 3.0, 0.0, 0.0, 0.5, 0.0, 0.0;
  const Identifiability result = identify(two_numbers(), std::vector{0.5, 0.5}, gram_of(jacobian));
  ASSERT_EQ(result.relative_singular_values.size(), 2U);
  EXPECT_DOUBLE_EQ(result.relative_singular_values[0], 1.0);
  EXPECT_NEAR(result.relative_singular_values[1], 0.5 / 3.0, 1e-14);
  EXPECT_THAT(result.status, testing::Each(Status::kOk));
  EXPECT_TRUE(result.correlated.empty());
}

// On both sides of the threshold.
TEST(Identify, CallsADirectionUnseenBelowTheThreshold) {
  for (const auto& [small, expected] : {std::pair{2.0 * kSingularThreshold, Status::kOk},
                                        std::pair{0.5 * kSingularThreshold, Status::kUnidentifiable}}) {
    Eigen::MatrixXd jacobian(2, 2);
    jacobian << 1.0, 0.0, 0.0, small;
    const Identifiability result = identify(two_numbers(), std::vector{0.5, 0.5}, gram_of(jacobian));
    EXPECT_EQ(result.status[0], Status::kOk);
    EXPECT_EQ(result.status[1], expected);
  }
}

TEST(Identify, NamesPairsThatMoveTogether) {
  for (const double sign : {1.0, -1.0}) {
    Eigen::MatrixXd jacobian(2, 2);
    jacobian << 1.0, sign, 0.1, -0.1 * sign;
    const Identifiability result = identify(two_numbers(), std::vector{0.5, 0.5}, gram_of(jacobian));
    ASSERT_EQ(result.correlated.size(), 1U);
    EXPECT_EQ(result.correlated[0].first, "metallic");
    EXPECT_EQ(result.correlated[0].second, "specular");
    // (J^T J)^-1 of columns (1, .1) and (s, -.1 s): off-diagonal over diagonal is -s 0.99 / 1.01.
    EXPECT_NEAR(result.correlated[0].correlation, -sign * 0.99 / 1.01, 1e-10);
  }
}

TEST(Identify, LeavesNumbersAtBoundsOutOfTheJacobian) {
  Eigen::MatrixXd jacobian(2, 2);
  jacobian << 1.0, 1.0, 1.0, 1.0;
  for (const auto& [value, expected] :
       {std::pair{0.0, Status::kAtLowerBound}, std::pair{1.0, Status::kAtUpperBound},
        std::pair{1e-9, Status::kAtLowerBound}}) {
    const Identifiability result = identify(two_numbers(), std::vector{value, 0.5}, gram_of(jacobian));
    EXPECT_EQ(result.status[0], expected);
    EXPECT_EQ(result.status[1], Status::kOk);
    EXPECT_EQ(result.relative_singular_values.size(), 1U);
  }
}

TEST(Identify, CopesWithEverythingAtBoundsOrUnseen) {
  const Identifiability bounds =
      identify(two_numbers(), std::vector{0.0, 1.0}, gram_of(Eigen::MatrixXd::Ones(2, 2)));
  EXPECT_THAT(bounds.status, testing::ElementsAre(Status::kAtLowerBound, Status::kAtUpperBound));
  EXPECT_TRUE(bounds.relative_singular_values.empty());
  const Identifiability unseen =
      identify(two_numbers(), std::vector{0.5, 0.5}, gram_of(Eigen::MatrixXd::Zero(2, 2)));
  EXPECT_THAT(unseen.status, testing::Each(Status::kUnidentifiable));
  for (const double value : unseen.relative_singular_values) EXPECT_EQ(value, 0.0);
}

bool lists_pair(const Identifiability& result, std::string_view a, std::string_view b) {
  return std::ranges::any_of(result.correlated, [&](const CorrelatedPair& pair) {
    return (pair.first == a && pair.second == b) || (pair.first == b && pair.second == a);
  });
}

// Grey: diffuse albedo and f0 are two numbers, made of base colour, metallic and specular.
TEST(Identify, OfAGreyDielectricTiesMetallicSpecularAndBaseColour) {
  for (const double base : {0.1, 0.5}) {
    Material material = grey_dielectric();
    material.set("base_color", base);
    const Evidence evidence(material);
    EXPECT_LT(evidence.result.relative_singular_values.back(), kSingularThreshold);
    EXPECT_TRUE(lists_pair(evidence.result, "metallic", "specular")) << base;
    EXPECT_TRUE(lists_pair(evidence.result, "metallic", "base_color.g")) << base;
    EXPECT_EQ(evidence.status("specular"), Status::kUnidentifiable);
    EXPECT_EQ(evidence.status("roughness"), Status::kOk);
  }
}

// On a dark base both move a good part of their ranges along the tie. (On a bright one specular moves twelve
// times as far as metallic, which its own range then holds.)
TEST(Identify, OfADarkGreyDielectricCannotSeeMetallic) {
  Material material = grey_dielectric();
  material.set("base_color", 0.1);
  EXPECT_EQ(Evidence(material).state("metallic").status, Status::kUnidentifiable);
  EXPECT_EQ(Evidence(material).state("specular").status, Status::kUnidentifiable);
}

TEST(Identify, OfAColouredMaterialTiesNothing) {
  Material material = grey_dielectric();
  material.set("base_color", Rgb{0.8, 0.4, 0.1});
  const Evidence evidence(material);
  EXPECT_THAT(evidence.result.status, testing::Each(Status::kOk));
}

TEST(Identify, OfAGreyDielectricWithMetallicFixedTiesNothing) {
  const Evidence evidence(grey_dielectric(), {{"metallic", {0.3}}});
  EXPECT_THAT(evidence.result.status, testing::Each(Status::kOk));
  EXPECT_EQ(evidence.state("metallic").status, Status::kFixed);
}

// Burley's tinted specular does what metallic does, in any colour: one exact direction.
TEST(Identify, OfBurleyTiesMetallicSpecularAndSpecularTint) {
  Material material(Model::kBurley);
  material.set_effects(Effects().with(Effect::kSpecularTint));
  material.set("base_color", Rgb{0.8, 0.4, 0.1});
  material.set("metallic", 0.3);
  material.set("specular_tint", 0.5);
  const Evidence evidence(material);
  EXPECT_LT(evidence.result.relative_singular_values.back(), 1e-6);
  EXPECT_EQ(evidence.status("specular"), Status::kUnidentifiable);
  EXPECT_EQ(evidence.status("specular_tint"), Status::kUnidentifiable);
}

TEST(Identify, WithoutASecondLobeCannotSeeItsWidth) {
  Material material = with_effect(Effect::kDualSpecular);
  material.set("dual_specular_roughness_scale", 2.0);
  // Just off the bound, and at it.
  for (const double opacity : {1e-6, 0.0}) {
    material.set("dual_specular_opacity", opacity);
    EXPECT_EQ(Evidence(material).status("dual_specular_roughness_scale"), Status::kUnidentifiable) << opacity;
  }
  EXPECT_EQ(Evidence(material).status("dual_specular_opacity"), Status::kAtLowerBound);
  material.set("dual_specular_opacity", 0.5);
  EXPECT_EQ(Evidence(material).status("dual_specular_roughness_scale"), Status::kOk);
}

TEST(Identify, OfANeutralIntensityCannotSeeItsFalloff) {
  Material material = with_effect(Effect::kRetroreflection);
  material.set("retroreflection", 1.0);
  const Evidence neutral(material);
  EXPECT_EQ(neutral.status("retroreflection_falloff"), Status::kUnidentifiable);
  EXPECT_EQ(neutral.status("retroreflection_tangent_falloff"), Status::kUnidentifiable);
  EXPECT_EQ(neutral.status("retroreflection.g"), Status::kOk);
  material.set("retroreflection", 6.0);
  EXPECT_EQ(Evidence(material).status("retroreflection_falloff"), Status::kOk);
}

TEST(PublicStates, ListEveryParameterWhoseEffectIsOnInOrder) {
  const Evidence evidence(with_effect(Effect::kRetroreflection), {{"roughness", {0.4}}});
  std::vector<std::string> names;
  for (const ParameterState& state :
       public_states(evidence.owned.parametrisation, evidence.x, evidence.result)) {
    names.push_back(state.name);
    if (state.name == "roughness") {
      EXPECT_EQ(state.status, Status::kFixed);
      EXPECT_TRUE(state.components.empty());
    }
  }
  EXPECT_THAT(names, testing::ElementsAre("base_color", "metallic", "specular", "roughness",
                                          "retroreflection", "retroreflection_falloff",
                                          "retroreflection_tint", "retroreflection_tangent_falloff"));
}

TEST(PublicStates, OfSeveralComponentsShowTheMostTelling) {
  Material material = grey_dielectric();
  material.set("base_color", Rgb{0.8, 0.4, 0.0});
  const ParameterState state = Evidence(material).state("base_color");
  EXPECT_EQ(state.status, Status::kAtLowerBound);
  EXPECT_THAT(state.components, testing::ElementsAre(Status::kOk, Status::kOk, Status::kAtLowerBound));
}

// A tint's largest channel is always 1: that is no bound that the data pushed it to.
TEST(PublicStates, OfTintsDoNotCallTheirLargestChannelABound) {
  Material material = with_effect(Effect::kRetroreflection);
  material.set("retroreflection", 6.0);
  material.set("retroreflection_tint", Rgb{1.0, 0.6, 0.4});
  const Evidence evidence(material);
  EXPECT_EQ(evidence.state("retroreflection_tint").status, Status::kOk);
  EXPECT_EQ(evidence.state("retroreflection").status, Status::kOk);
}

TEST(PublicStates, OfAProductThatVanishesCallTheTintUnidentifiable) {
  Material material = with_effect(Effect::kSmoothTerminator);
  material.set("smooth_terminator", 0.0);
  EXPECT_EQ(Evidence(material).state("smooth_terminator_tint").status, Status::kUnidentifiable);
  material.set("smooth_terminator", 0.5);
  EXPECT_EQ(Evidence(material).state("smooth_terminator_tint").status, Status::kOk);
}

TEST(Status, NamesAreThoseOfTheResultFile) {
  EXPECT_EQ(name_of(Status::kOk), "ok");
  EXPECT_EQ(name_of(Status::kAtLowerBound), "at lower bound");
  EXPECT_EQ(name_of(Status::kAtUpperBound), "at upper bound");
  EXPECT_EQ(name_of(Status::kUnidentifiable), "unidentifiable");
  EXPECT_EQ(name_of(Status::kFixed), "fixed");
}

}  // namespace
}  // namespace brdfit::fit
