// Whether intervals hold the truth as often as they say: many noisy fits with the right effects given.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "fit/fit.h"
#include "fit/solve.h"
#include "tests/fit_data.h"

namespace brdfit::fit {
namespace {

constexpr std::uint64_t kFits = 200;
constexpr double kNoise = 0.02;
// Of a normal distribution, 95% lie within this many standard deviations.
constexpr double kInterval = 1.96;

// How many intervals there were, and how many held the truth.
struct Coverage {
  int held = 0;
  int intervals = 0;

  void add(bool holds) {
    held += holds ? 1 : 0;
    ++intervals;
  }
  double share() const { return static_cast<double>(held) / intervals; }
};

Effects given_effects(Model model) {
  return effects_of(model).without(Effect::kAnisotropic);
}

FitResult noisy_fit(Model model, std::uint64_t seed, Loss loss, Material* truth) {
  synthetic::Recipe recipe =
      testing_support::recipe_of(testing_support::random_full_material(model, given_effects(model), seed),
                                 {45, 30, 60, CellAnchor::kLowerEdge});
  recipe.noise.multiplicative = kNoise;
  recipe.seed = seed;
  FitOptions options;
  options.model = model;
  options.effects = given_effects(model);
  options.samples = 4000;
  options.loss = loss;
  // What is looked at is what noise does to a minimum, not which minimum is found.
  options.starts = 1;
  options.init = recipe.material;
  *truth = recipe.material;
  return fit(synthetic::generate_table(recipe), options);
}

void add_intervals(const FitResult& result, const Material& truth, Coverage& coverage,
                   std::map<std::string, Coverage>& by_parameter) {
  for (const ParameterState& state : result.parameters) {
    for (std::size_t c = 0; c < state.standard_error.size(); ++c) {
      if (!state.standard_error[c]) continue;
      const double error = result.material.colour(state.name)[c] - truth.colour(state.name)[c];
      const bool holds = std::abs(error) <= kInterval * *state.standard_error[c];
      coverage.add(holds);
      by_parameter[state.name].add(holds);
    }
  }
}

Coverage coverage_of(Model model, std::uint64_t fits, Loss loss) {
  Coverage coverage;
  std::map<std::string, Coverage> by_parameter;
  for (std::uint64_t seed = 1; seed <= fits; ++seed) {
    Material truth;
    const FitResult result = noisy_fit(model, 1000 + seed, loss, &truth);
    add_intervals(result, truth, coverage, by_parameter);
  }
  std::printf("%s, %s: %d of %d intervals hold the truth (%.1f%%)\n", std::string(name_of(model)).c_str(),
              std::string(name_of(loss)).c_str(), coverage.held, coverage.intervals,
              100.0 * coverage.share());
  for (const auto& [name, of] : by_parameter) {
    std::printf("  %-32s %4d of %4d (%.1f%%)\n", name.c_str(), of.held, of.intervals, 100.0 * of.share());
  }
  return coverage;
}

class CoverageOf : public testing::TestWithParam<Model> {
 protected:
  static void SetUpTestSuite() { silence_solver_logging(); }
};

TEST_P(CoverageOf, NinetyFivePercentIntervalsIsNinetyToNinetyNinePercent) {
  const Coverage coverage = coverage_of(GetParam(), kFits, Loss::kLogRatio);
  ASSERT_GT(coverage.intervals, 3 * static_cast<int>(kFits));
  EXPECT_GE(coverage.share(), 0.90);
  EXPECT_LE(coverage.share(), 0.99);
}

std::string model_name(const testing::TestParamInfo<Model>& parameter) {
  constexpr const char* kNames[] = {"LambertGgx", "Burley", "Callisto"};
  return kNames[static_cast<std::size_t>(parameter.param)];
}

INSTANTIATE_TEST_SUITE_P(Models, CoverageOf,
                         testing::Values(Model::kLambertGgx, Model::kBurley, Model::kCallisto), model_name);

}  // namespace
}  // namespace brdfit::fit
