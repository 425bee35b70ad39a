// Ridge, lobes and their number: chosen by what lights that took no part say.
#include "bake/choose_lobes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "bake/ridge.h"
#include "bake/solve.h"
#include "tests/lobe_data.h"

namespace brdfit::bake {
namespace {

using bake_data::add_noise;
using bake_data::cap_of_lights;
using bake_data::dome;
using bake_data::lit_texels;
using bake_data::made_of;
using bake_data::odd_lobes;

TEST(ChooseRidge, IsSmallForLobesAndLeavesNoiseAlone) {
  const std::vector<Vec3> directions = dome(30);
  const LobeSet lobes = odd_lobes();
  EXPECT_LE(choose_ridge(lobes, directions, made_of(lobes, directions, 200, 0.0)).ridge, 1e-4);
  TexelProblem noise = lit_texels(directions, 200, 0.5, 1);
  add_noise(noise, 0.1, 4);
  const RidgeChoice choice = choose_ridge(lobes, directions, noise);
  EXPECT_GT(choice.ridge, 1.0);
  EXPECT_GT(choice.error, 0.99 * choice.error_without);
}

TEST(ChooseRidge, IsTheLeastOfLeaveOneOutErrors) {
  const std::vector<Vec3> directions = dome(20);
  const LobeSet lobes = odd_lobes();
  const TexelProblem problem = made_of(lobes, directions, 200, 0.3);
  const RidgeChoice choice = choose_ridge(lobes, directions, problem);
  EXPECT_TRUE(choice.helps());
  for (const double ridge : {1e-5, 1e-3, 1e-2, 1e-1, 1.0, 10.0}) {
    const LobeSystem system(lobes, directions, mean_squared_modulation(problem), ridge);
    double error = 0.0;
    for (const float e : solve(system, problem).error_with) error += e;
    EXPECT_LE(choice.error, error * (1.0 + 1e-12));
  }
}

TEST(LightFolds, HoldEachLightOnceInWhateverOrder) {
  const std::vector<Vec3> directions = dome(31);
  std::vector<Vec3> reversed(directions.rbegin(), directions.rend());
  const auto folds = light_folds(directions, 5);
  const auto mirrored = light_folds(reversed, 5);
  ASSERT_EQ(folds.size(), 5U);
  std::vector<int> seen(31, 0);
  for (std::size_t f = 0; f < 5; ++f) {
    EXPECT_GE(folds[f].size(), 6U);
    for (std::size_t k = 0; k < folds[f].size(); ++k) {
      ++seen[folds[f][k]];
      EXPECT_EQ(30 - mirrored[f][mirrored[f].size() - 1 - k], folds[f][k]);
    }
  }
  EXPECT_EQ(seen, std::vector<int>(31, 1));
  EXPECT_EQ(light_folds(dome(12), 6).size(), 12U);
}

ProblemOf fixed(const TexelProblem& problem) {
  return [&problem](std::span<const std::size_t>) { return problem; };
}

// Noise of 0.05 and four amplitudes of 50 lights: no fit can be expected to hold out less than
// 0.05 sqrt(1 + 4/50 or so).
TEST(ChooseLobes, ReachesTheNoiseFloorOfKnownLobes) {
  const std::vector<Vec3> directions = dome(60);
  const TexelProblem problem = made_of(odd_lobes(), directions, 400, 0.05);
  ChoiceOptions options;
  options.counts = {4};
  const LobeChoice choice = choose_lobes(fixed(problem), directions, options);
  EXPECT_TRUE(choice.optimised);
  ASSERT_EQ(choice.lobes.size(), 4U);
  const double values = static_cast<double>(problem.residual.size());
  double held_out = 0.0;
  for (const Candidate& c : choice.candidates) {
    if (c.optimised) held_out = std::sqrt(c.error() / values);
  }
  EXPECT_LT(held_out, 0.05 * 1.1);
  EXPECT_GT(held_out, 0.05 * 0.98);
  EXPECT_GT(std::sqrt(choice.error_without() / values), 0.2);
}

TEST(ChooseLobes, TakesNoMoreLobesThanBringSomething) {
  const std::vector<Vec3> directions = dome(40);
  const TexelProblem problem = made_of({odd_lobes()[3]}, directions, 200, 0.1);
  ChoiceOptions options;
  options.counts = {1, 2, 4};
  const LobeChoice choice = choose_lobes(fixed(problem), directions, options);
  EXPECT_EQ(choice.lobes.size(), 1U);
}

TEST(ChooseLobes, GivesNoneForNoise) {
  for (const auto& directions : {dome(40), cap_of_lights(12, 0.1745), dome(5)}) {
    TexelProblem problem = lit_texels(directions, 200, 0.5, 1);
    add_noise(problem, 0.1, 5);
    ChoiceOptions options;
    options.counts = {1, 8};
    EXPECT_TRUE(choose_lobes(fixed(problem), directions, options).lobes.empty());
  }
}

TEST(ChooseLobes, AsksForAModelWithoutTheLightsHeldOut) {
  const std::vector<Vec3> directions = dome(7);
  const TexelProblem problem = made_of(odd_lobes(), directions, 20, 0.1);
  ChoiceOptions options;
  options.optimise = false;
  options.counts = {2};
  std::atomic<int> partial = 0;
  std::atomic<int> whole = 0;
  choose_lobes(
      [&](std::span<const std::size_t> training) {
        ++(training.size() == 7 ? whole : partial);
        return problem;
      },
      directions, options);
  EXPECT_EQ(partial, 7);
  EXPECT_EQ(whole, 1);
}

TEST(ChooseLobes, LivesWithNoResidualAndRefusesOneLight) {
  const std::vector<Vec3> directions = dome(8);
  const TexelProblem black = lit_texels(directions, 20, 0.5, 1);
  EXPECT_TRUE(choose_lobes(fixed(black), directions).lobes.empty());
  ChoiceOptions options;
  EXPECT_THROW(choose_lobes(fixed(black), dome(1), options), std::invalid_argument);
  options.counts = {17};
  EXPECT_THROW(choose_lobes(fixed(black), directions, options), std::invalid_argument);
  options.counts = {};
  EXPECT_THROW(choose_lobes(fixed(black), directions, options), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::bake
