// Unidentifiable parameters: at their defaults where that costs nothing, and with a reason.
#include "fit/settle.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "fit/fit.h"
#include "fit/reasons.h"
#include "tests/fit_data.h"

namespace brdfit::fit {
namespace {

using testing::HasSubstr;
using testing_support::OwnedProblem;

Material with_effect(Effect effect) {
  Material material(Model::kCallisto);
  material.set_effects(Effects().with(effect));
  material.set("base_color", Rgb{0.6, 0.4, 0.2});
  material.set("metallic", 0.2);
  material.set("roughness", 0.4);
  return material;
}

MeasuredTable noisy_table(const Material& material) {
  synthetic::Recipe recipe = testing_support::recipe_of(material);
  recipe.noise.multiplicative = 0.02;
  return synthetic::generate_table(recipe);
}

// A solve that began where unidentifiable parameters have drifted to.
struct Drifted {
  OwnedProblem owned;
  Solution solution;
  Settled settled;

  Drifted(const Material& truth, const Material& begin)
      : owned(noisy_table(truth), begin, {Tier::kFull, begin.effects(), {}}),
        solution(solve_pinning(owned.problem, owned.parametrisation.from_material(begin),
                               full_box(owned.parametrisation), {})),
        settled(settle_unidentifiable(owned.problem, solution, full_box(owned.parametrisation))) {}

  Material material() const { return owned.parametrisation.to_material(settled.solution.x); }
  Status status(std::string_view name) const { return settled.identifiability.status[owned.index_of(name)]; }
  std::string reason(std::string_view name) const { return settled.reasons[owned.index_of(name)]; }
  ParameterState state(std::string_view name) const {
    std::vector<ParameterState> states =
        public_states(owned.parametrisation, settled.solution.x, settled.identifiability);
    add_reasons(owned.parametrisation, settled.solution.x, settled.reasons, states);
    const auto found = std::ranges::find(states, name, &ParameterState::name);
    if (found == states.end()) throw std::logic_error("no such state");
    return *found;
  }
};

class Settle : public testing::Test {
 protected:
  static void SetUpTestSuite() { silence_solver_logging(); }
};

TEST_F(Settle, LeavesWhatIsIdentifiableAlone) {
  const Material truth = testing_support::random_full_material(Model::kLambertGgx, {}, 3);
  const Drifted drifted(truth, truth);
  EXPECT_EQ(drifted.settled.solution.x, drifted.solution.x);
  EXPECT_THAT(drifted.settled.reasons, testing::Each(""));
  EXPECT_THAT(drifted.settled.at_default, testing::Each(false));
}

TEST_F(Settle, BringsTheScaleOfNoSecondLobeToItsDefault) {
  const Material truth = with_effect(Effect::kDualSpecular);
  for (const double scale : {5.0, 16.0}) {
    Material begin = truth;
    begin.set("dual_specular_roughness_scale", scale);
    OwnedProblem owned(noisy_table(truth), begin, {Tier::kFull, begin.effects(), {}});
    Box box = full_box(owned.parametrisation);
    box.moves[owned.index_of("dual_specular_opacity")] = false;
    const Solution solution = solve(owned.problem, owned.parametrisation.from_material(begin), box, {});
    const Settled settled = settle_unidentifiable(owned.problem, solution, box);
    const std::size_t at = owned.index_of("dual_specular_roughness_scale");
    EXPECT_EQ(settled.solution.x[at], 2.0);
    EXPECT_EQ(settled.identifiability.status[at], Status::kUnidentifiable);
    EXPECT_EQ(settled.reasons[at], "dual specular opacity is 0: its scale does not matter");
    EXPECT_TRUE(settled.at_default[at]);
    EXPECT_LE(settled.solution.cost, solution.cost * (1.0 + kSettlingShare));
  }
}

TEST_F(Settle, GivesReasonsForWhatAVanishedTerminatorHides) {
  Material begin = with_effect(Effect::kSmoothTerminator);
  begin.set("smooth_terminator_length", 0.9);
  OwnedProblem owned(noisy_table(begin), begin, {Tier::kFull, begin.effects(), {}});
  Box box = full_box(owned.parametrisation);
  for (const char* name : {"smooth_terminator.r", "smooth_terminator.g", "smooth_terminator.b"}) {
    box.moves[owned.index_of(name)] = false;
  }
  const Solution solution = solve(owned.problem, owned.parametrisation.from_material(begin), box, {});
  const Settled settled = settle_unidentifiable(owned.problem, solution, box);
  std::vector<ParameterState> states =
      public_states(owned.parametrisation, settled.solution.x, settled.identifiability);
  add_reasons(owned.parametrisation, settled.solution.x, settled.reasons, states);
  for (const ParameterState& state : states) {
    if (state.name == "smooth_terminator_length") {
      EXPECT_EQ(state.reason, "smooth terminator is 0: its length does not matter");
    }
    if (state.name == "smooth_terminator_tint") {
      EXPECT_EQ(state.reason, "smooth terminator is 0: its tint does not matter");
    }
    EXPECT_EQ(state.reason.empty(), state.status != Status::kUnidentifiable) << state.name;
  }
  EXPECT_EQ(owned.parametrisation.to_material(settled.solution.x).number("smooth_terminator_length"), 0.5);
}

// On a dark grey, metallic and specular do the same: metallic goes to 0, and specular makes up for it.
TEST_F(Settle, SolvesTheOthersAnewWhereOneOfTheTiedGoes) {
  Material truth;
  truth.set("base_color", 0.1);
  truth.set("specular", 0.5);
  truth.set("roughness", 0.4);
  Material begin = truth;
  begin.set("metallic", 0.3);
  begin.set("specular", 0.2);
  const Drifted drifted(truth, begin);
  ASSERT_GT(drifted.solution.x[drifted.owned.index_of("metallic")], 0.01);
  EXPECT_EQ(drifted.material().number("metallic"), 0.0);
  EXPECT_NEAR(drifted.material().number("specular"), 0.5, 0.05);
  EXPECT_EQ(drifted.status("metallic"), Status::kUnidentifiable);
  EXPECT_EQ(drifted.status("specular"), Status::kUnidentifiable);
  EXPECT_THAT(drifted.reason("metallic"), HasSubstr("tied to "));
  EXPECT_THAT(drifted.reason("metallic"), HasSubstr("specular"));
  EXPECT_THAT(drifted.reason("specular"), HasSubstr("metallic"));
  EXPECT_TRUE(drifted.settled.solution.converged);
  EXPECT_LE(drifted.settled.solution.cost, drifted.solution.cost * (1.0 + kSettlingShare));
}

// Where no default of the tied fits, they keep their values, and say what they are tied to.
TEST_F(Settle, KeepsValuesWhereADefaultCosts) {
  Material truth;
  truth.set("base_color", 0.2);
  truth.set("metallic", 0.9);
  truth.set("specular", 1.0);
  truth.set("roughness", 0.4);
  Material begin = truth;
  begin.set("specular", 0.9);
  const Drifted drifted(truth, begin);
  EXPECT_GT(drifted.material().number("metallic"), 0.5);
  EXPECT_LE(drifted.settled.solution.cost, drifted.solution.cost * (1.0 + kSettlingShare));
  EXPECT_EQ(drifted.state("metallic").status == Status::kUnidentifiable,
            !drifted.state("metallic").reason.empty());
}

// Every unidentifiable parameter of a whole fit has a reason, and none of the others.
TEST_F(Settle, GivesEveryUnidentifiableParameterOfAFitAReason) {
  for (const Model model : all_models()) {
    FitOptions options;
    options.model = model;
    options.samples = 1000;
    options.starts = 4;
    const FitResult result = fit(noisy_table(Material()), options);
    for (const ParameterState& state : result.parameters) {
      EXPECT_EQ(!state.reason.empty(), state.status == Status::kUnidentifiable) << state.name;
      for (const std::optional<double>& error : state.standard_error) {
        EXPECT_TRUE(std::isfinite(error.value_or(0.0))) << state.name;
        if (state.status == Status::kUnidentifiable && state.components.size() == 1) {
          EXPECT_FALSE(error.has_value()) << state.name;
        }
      }
    }
  }
}

TEST(InWords, ListsNames) {
  EXPECT_EQ(in_words({}), "");
  EXPECT_EQ(in_words({"metallic"}), "metallic");
  EXPECT_EQ(in_words({"base_color", "metallic"}), "base color and metallic");
  EXPECT_EQ(in_words({"base_color", "metallic", "specular_tint"}), "base color, metallic and specular tint");
}

}  // namespace
}  // namespace brdfit::fit
