// Amplitudes: the closed forms against their definitions, vector code against double precision, and inputs
// that leave little to solve for.
#include "bake/solve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>

#include "tests/lobe_data.h"
#include "tests/texel_solution.h"

namespace brdfit::bake {
namespace {

using bake_data::add_lobes;
using bake_data::add_noise;
using bake_data::cap_of_lights;
using bake_data::dome;
using bake_data::lit_texels;

struct Columns {
  Eigen::VectorXd residual;
  Eigen::VectorXd modulation;
  Eigen::VectorXd weight;
};

Columns columns_of(const TexelProblem& problem, std::size_t texel) {
  const auto lights = static_cast<Eigen::Index>(problem.lights);
  Columns c = {Eigen::VectorXd(lights), Eigen::VectorXd(lights), Eigen::VectorXd(lights)};
  for (std::size_t l = 0; l < problem.lights; ++l) {
    const auto row = static_cast<Eigen::Index>(l);
    c.residual[row] = problem.residual[problem.at(l, texel)];
    c.modulation[row] = problem.modulation[problem.at(l, texel)];
    c.weight[row] = problem.weight_of(l, texel);
  }
  return c;
}

void add_random_weights(TexelProblem& problem, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  problem.weight.resize(problem.residual.size());
  for (float& w : problem.weight) w = uniform(random) < 0.2F ? 0.0F : uniform(random);
}

LobeSystem system_of(const LobeSet& lobes, const std::vector<Vec3>& directions, const TexelProblem& problem,
                     double ridge) {
  return {lobes, directions, mean_squared_modulation(problem), ridge};
}

void expect_sound(const SolveResult& result, const TexelProblem& problem) {
  const std::size_t lobes = result.amplitudes.size() / problem.texels;
  for (const float a : result.amplitudes) ASSERT_TRUE(std::isfinite(a));
  for (std::size_t i = 0; i < problem.texels; ++i) {
    ASSERT_TRUE(std::isfinite(result.error_with[i]));
    ASSERT_TRUE(std::isfinite(result.error_without[i]));
    ASSERT_GE(result.confidence[i], 0.0F);
    ASSERT_LE(result.confidence[i], 1.0F);
    if (result.error_with[i] < result.error_without[i]) continue;
    EXPECT_EQ(result.confidence[i], 0.0F);
    for (std::size_t k = 0; k < lobes; ++k) EXPECT_EQ(result.amplitudes[k * problem.texels + i], 0.0F);
  }
}

class BakeSolve : public testing::Test {
 protected:
  std::vector<Vec3> directions = dome(50);
  LobeSet lobes = uniform_lobes(8, cap_of(directions));

  TexelProblem noisy(std::size_t texels) const {
    TexelProblem problem = lit_texels(directions, texels, 0.9, 1);
    add_lobes(problem, directions, lobes, 0.5, 2);
    add_noise(problem, 0.1, 3);
    return problem;
  }
};

TEST_F(BakeSolve, LeavesAResidualOrthogonalToEveryLobe) {
  TexelProblem problem = noisy(20);
  add_random_weights(problem, 4);
  const Eigen::MatrixXd basis = lobe_values(lobes, directions);
  for (const double penalty : {0.0, 0.3}) {
    for (std::size_t i = 0; i < problem.texels; ++i) {
      const Columns c = columns_of(problem, i);
      const test_data::TexelSolution solution =
          test_data::solve_texel(basis, c.residual, c.modulation, c.weight, penalty);
      const Eigen::VectorXd gradient =
          basis.transpose() * (c.weight.array() * c.modulation.array() * solution.left.array()).matrix() -
          penalty * solution.amplitudes;
      EXPECT_LT(gradient.cwiseAbs().maxCoeff(), 1e-11);
    }
  }
}

TEST_F(BakeSolve, KnowsWhatRefitsWithoutEachLightWouldLeave) {
  TexelProblem problem = noisy(10);
  add_random_weights(problem, 5);
  const Eigen::MatrixXd basis = lobe_values(lobes, directions);
  for (std::size_t i = 0; i < problem.texels; ++i) {
    const Columns c = columns_of(problem, i);
    const test_data::TexelSolution solution =
        test_data::solve_texel(basis, c.residual, c.modulation, c.weight, 0.05);
    for (Eigen::Index l = 0; l < basis.rows(); ++l) {
      Eigen::VectorXd weight = c.weight;
      weight[l] = 0.0;
      const test_data::TexelSolution refit =
          test_data::solve_texel(basis, c.residual, c.modulation, weight, 0.05);
      EXPECT_NEAR(solution.left_out[l], refit.left[l], 1e-10);
    }
  }
}

TEST_F(BakeSolve, AgreesWithDoublePrecisionOnEveryInstructionSet) {
  for (const int count : {1, 4, 7, 8, 11, 16}) {
    const LobeSet set = uniform_lobes(count, cap_of(directions));
    TexelProblem problem = noisy(77);  // not a multiple of any vector
    add_random_weights(problem, 6);
    const LobeSystem system = system_of(set, directions, problem, 0.01);
    for (const simd::Isa isa : simd::available_isas()) {
      SolveOptions options;
      options.select = false;
      options.isa = isa;
      const SolveResult result = solve(system, problem, options);
      for (std::size_t i = 0; i < problem.texels; ++i) {
        const Columns c = columns_of(problem, i);
        const test_data::TexelSolution exact =
            test_data::solve_texel(system.basis(), c.residual, c.modulation, c.weight, system.penalty());
        for (std::size_t k = 0; k < set.size(); ++k) {
          EXPECT_NEAR(result.amplitudes[k * problem.texels + i],
                      exact.amplitudes[static_cast<Eigen::Index>(k)], 2e-6);
        }
        const double error = (c.weight.array() * exact.left_out.array().square()).sum();
        EXPECT_NEAR(result.error_with[i], error, 2e-5 * error);
        EXPECT_NEAR(result.error_without[i], (c.weight.array() * c.residual.array().square()).sum(),
                    1e-5 * result.error_without[i]);
      }
    }
  }
}

TEST_F(BakeSolve, RecoversKnownAmplitudesWithTheTrueLobes) {
  for (const int count : {4, 8, 12}) {
    const LobeSet set = uniform_lobes(count, cap_of(directions), 0.4);
    TexelProblem problem = lit_texels(directions, 500, 0.6, 7);
    const std::vector<float> known = add_lobes(problem, directions, set, 1.0, 8);
    const SolveResult result = solve(system_of(set, directions, problem, 0.0), problem);
    for (std::size_t k = 0; k < known.size(); ++k) EXPECT_NEAR(result.amplitudes[k], known[k], 1e-5);
  }
}

TEST_F(BakeSolve, RecoversKnownAmplitudesUnderNearLights) {
  TexelProblem problem = lit_texels(directions, 40, 0.6, 9);
  problem.directions.resize(3 * problem.residual.size());
  for (std::size_t l = 0; l < problem.lights; ++l) {
    for (std::size_t i = 0; i < problem.texels; ++i) {
      // Each texel sees the lights turned a little.
      const double turn = 0.01 * static_cast<double>(i);
      const Vec3 d = directions[l];
      float* plane = problem.directions.data() + l * 3 * problem.texels + i;
      plane[0] = static_cast<float>(d.x * std::cos(turn) - d.y * std::sin(turn));
      plane[problem.texels] = static_cast<float>(d.x * std::sin(turn) + d.y * std::cos(turn));
      plane[2 * problem.texels] = static_cast<float>(d.z);
    }
  }
  const std::vector<float> known = add_lobes(problem, directions, lobes, 1.0, 10);
  const LobeSystem system = system_of(lobes, directions, problem, 0.0);
  const SolveResult result = solve(system, problem);
  for (std::size_t k = 0; k < known.size(); ++k) EXPECT_NEAR(result.amplitudes[k], known[k], 1e-5);
  const std::vector<float> sums =
      lobe_sums(lobes, directions, problem.directions, result.amplitudes, problem.texels);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    EXPECT_NEAR(problem.modulation[k] * sums[k], problem.residual[k], 1e-5);
  }
}

TEST_F(BakeSolve, NearLightsThatAreAlikeForAllTexelsAreDirectionalLights) {
  const TexelProblem far = noisy(30);
  TexelProblem near = far;
  near.directions.resize(3 * near.residual.size());
  for (std::size_t l = 0; l < near.lights; ++l) {
    for (std::size_t i = 0; i < near.texels; ++i) {
      float* plane = near.directions.data() + l * 3 * near.texels + i;
      plane[0] = static_cast<float>(directions[l].x);
      plane[near.texels] = static_cast<float>(directions[l].y);
      plane[2 * near.texels] = static_cast<float>(directions[l].z);
    }
  }
  const LobeSystem system = system_of(lobes, directions, far, 0.01);
  const SolveResult a = solve(system, far);
  const SolveResult b = solve(system, near);
  for (std::size_t k = 0; k < a.amplitudes.size(); ++k) {
    EXPECT_NEAR(a.amplitudes[k], b.amplitudes[k], 1e-5);
  }
}

TEST_F(BakeSolve, CutsOfAnAssetGiveTheSameAmplitudes) {
  const TexelProblem whole = noisy(100);
  const LobeSystem system = system_of(lobes, directions, whole, 0.01);
  const SolveResult together = solve(system, whole);
  std::vector<std::size_t> some;
  for (std::size_t i = 13; i < 80; i += 2) some.push_back(i);
  const SolveResult apart = solve(system, with_texels(whole, some));
  for (std::size_t k = 0; k < lobes.size(); ++k) {
    for (std::size_t i = 0; i < some.size(); ++i) {
      EXPECT_EQ(apart.amplitudes[k * some.size() + i], together.amplitudes[k * whole.texels + some[i]]);
    }
  }
}

TEST_F(BakeSolve, ThreadsChangeNothing) {
  const TexelProblem problem = noisy(3000);
  const LobeSystem system = system_of(lobes, directions, problem, 0.01);
  const SolveResult many = solve(system, problem);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(solve(system, problem).amplitudes, many.amplitudes);
}

TEST_F(BakeSolve, KeepsLobesOnlyWhereTheyHelp) {
  TexelProblem problem = lit_texels(directions, 400, 0.9, 11);
  add_noise(problem, 0.1, 12);  // which lobes cannot predict
  const SolveResult noise = solve(system_of(lobes, directions, problem, 0.01), problem);
  expect_sound(noise, problem);
  EXPECT_GT(std::count(noise.confidence.begin(), noise.confidence.end(), 0.0F), 300);
  add_lobes(problem, directions, lobes, 1.0, 13);
  const SolveResult helped = solve(system_of(lobes, directions, problem, 0.01), problem);
  expect_sound(helped, problem);
  EXPECT_LT(std::count(helped.confidence.begin(), helped.confidence.end(), 0.0F), 20);
}

TEST_F(BakeSolve, WithoutLeavingOutItsErrorsAreThoseOfTraining) {
  const TexelProblem problem = noisy(40);
  const LobeSystem system = system_of(lobes, directions, problem, 0.01);
  SolveOptions options;
  options.leave_one_out = false;
  const SolveResult result = solve(system, problem, options);
  const std::vector<float> sums = lobe_sums(lobes, directions, {}, result.amplitudes, problem.texels);
  for (std::size_t i = 0; i < problem.texels; ++i) {
    double error = 0.0;
    for (std::size_t l = 0; l < problem.lights; ++l) {
      const std::size_t at = problem.at(l, i);
      error += std::pow(problem.residual[at] - problem.modulation[at] * sums[at], 2.0);
    }
    EXPECT_NEAR(result.error_with[i], error, 1e-5 * error);
  }
}

TEST_F(BakeSolve, AVeryLargeRidgeLeavesNoLobes) {
  const TexelProblem problem = noisy(40);
  SolveOptions options;
  options.select = false;
  const SolveResult result = solve(system_of(lobes, directions, problem, 1e9), problem, options);
  for (const float a : result.amplitudes) EXPECT_NEAR(a, 0.0F, 1e-7);
}

// What is hard, for every number of lobes and with and without a ridge.
class HardBakeSolve : public testing::Test {
 protected:
  static void expect_sound_solutions(const std::vector<Vec3>& directions, const TexelProblem& problem) {
    for (const int count : {1, 4, 8, 16}) {
      expect_sound_with(uniform_lobes(count, cap_of(directions)), directions, problem);
    }
  }

  static void expect_sound_with(const LobeSet& lobes, const std::vector<Vec3>& directions,
                                const TexelProblem& problem) {
    for (const double ridge : {0.0, 1e-5, 0.1}) {
      for (const simd::Isa isa : simd::available_isas()) {
        SolveOptions options;
        options.isa = isa;
        expect_sound(solve(system_of(lobes, directions, problem, ridge), problem, options), problem);
      }
    }
  }
};

TEST_F(HardBakeSolve, FewerLightsThanLobes) {
  for (const std::size_t lights : {1U, 2U, 3U, 5U}) {
    const std::vector<Vec3> directions = dome(lights);
    TexelProblem problem = lit_texels(directions, 50, 0.9, 21);
    add_noise(problem, 0.2, 22);
    expect_sound_solutions(directions, problem);
  }
}

TEST_F(HardBakeSolve, AllLightsWithinTenDegrees) {
  const std::vector<Vec3> directions = cap_of_lights(12, 0.1745);
  TexelProblem problem = lit_texels(directions, 50, 0.9, 23);
  add_noise(problem, 0.2, 24);
  expect_sound_solutions(directions, problem);
}

TEST_F(HardBakeSolve, LightsOnTheHorizonWithNoise) {
  std::vector<Vec3> directions;
  for (int l = 0; l < 20; ++l) directions.push_back({std::cos(0.3 * l), std::sin(0.3 * l), 1e-4 * l});
  TexelProblem problem = lit_texels(directions, 50, 1e-3, 25);
  add_noise(problem, 0.2, 26);
  expect_sound_solutions(directions, problem);
}

TEST_F(HardBakeSolve, LobesThatNearlyCoincide) {
  const std::vector<Vec3> directions = dome(50);
  LobeSet lobes = uniform_lobes(4, cap_of(directions));
  for (const double apart : {1e-3, 1e-6, 0.0}) {
    LobeSet twins = lobes;
    for (Lobe lobe : lobes) {
      lobe.sharpness *= 1.0 + apart;
      twins.push_back(lobe);
    }
    TexelProblem problem = lit_texels(directions, 50, 0.9, 27);
    add_noise(problem, 0.2, 28);
    expect_sound_with(twins, directions, problem);
    EXPECT_GT(system_of(twins, directions, problem, 0.0).condition(), 1e5);
  }
}

TEST_F(HardBakeSolve, TexelsLitByFewerLightsThanLobes) {
  const std::vector<Vec3> directions = dome(50);
  TexelProblem problem = lit_texels(directions, 50, 0.9, 29);
  for (std::size_t i = 0; i < problem.texels; ++i) {
    for (std::size_t l = i % 7; l < problem.lights; ++l) problem.modulation[problem.at(l, i)] = 0.0F;
  }
  add_noise(problem, 0.2, 30);
  expect_sound_solutions(directions, problem);
}

TEST_F(HardBakeSolve, ValuesFarAboveOne) {
  const std::vector<Vec3> directions = dome(50);
  TexelProblem problem = lit_texels(directions, 50, 0.9, 31);
  add_noise(problem, 1.0, 32);
  for (std::size_t k = 0; k < problem.residual.size(); k += 3) problem.residual[k] *= 65504.0F;
  for (std::size_t k = 0; k < problem.residual.size(); k += 5) problem.modulation[k] *= 1e5F;
  expect_sound_solutions(directions, problem);
}

TEST_F(HardBakeSolve, ALightListedTwice) {
  std::vector<Vec3> directions = dome(9);
  directions.push_back(directions[0]);
  TexelProblem problem = lit_texels(directions, 50, 0.9, 33);
  add_noise(problem, 0.2, 34);
  expect_sound_solutions(directions, problem);
}

TEST_F(HardBakeSolve, BlackTexelsAndTexelsWithoutWeight) {
  const std::vector<Vec3> directions = dome(50);
  TexelProblem problem = lit_texels(directions, 50, 0.9, 35);
  problem.weight.assign(problem.residual.size(), 1.0F);
  for (std::size_t l = 0; l < problem.lights; ++l) {
    for (std::size_t i = 0; i < 25; ++i) problem.weight[problem.at(l, i)] = 0.0F;
  }
  expect_sound_solutions(directions, problem);
  std::fill(problem.modulation.begin(), problem.modulation.end(), 0.0F);  // no light at all
  add_noise(problem, 0.2, 36);
  expect_sound_solutions(directions, problem);
}

TEST(LobeSystem, RefusesWhatDoesNotFit) {
  const std::vector<Vec3> directions = dome(5);
  const LobeSet lobes = uniform_lobes(2, cap_of(directions));
  const std::vector<double> squared(5, 1.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(LobeSystem({}, directions, squared, 0.1), std::invalid_argument);
  EXPECT_THROW(LobeSystem(LobeSet(17), directions, squared, 0.1), std::invalid_argument);
  EXPECT_THROW(LobeSystem(lobes, directions, std::vector<double>(4, 1.0), 0.1), std::invalid_argument);
  EXPECT_THROW(LobeSystem(lobes, directions, std::vector<double>(5, nan), 0.1), std::invalid_argument);
  EXPECT_THROW(LobeSystem(lobes, directions, squared, -1.0), std::invalid_argument);
  EXPECT_THROW(LobeSystem(lobes, directions, squared, nan), std::invalid_argument);
  TexelProblem problem = lit_texels(dome(6), 3, 0.5, 1);
  EXPECT_THROW(solve(LobeSystem(lobes, directions, squared, 0.1), problem), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::bake
