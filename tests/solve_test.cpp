// The Ceres solve: bounds, held parameters, pinning, and convergence as data.
#include "fit/solve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fit_data.h"

namespace brdfit::fit {
namespace {

using testing_support::OwnedProblem;

class Solve : public testing::Test {
 protected:
  static void SetUpTestSuite() { silence_solver_logging(); }
};

Material plastic() {
  Material material;
  material.set("base_color", Rgb{0.6, 0.3, 0.1});
  material.set("roughness", 0.4);
  material.set("metallic", 0.2);
  material.set("specular", 0.7);
  return material;
}

OwnedProblem plastic_problem(const FixedValues& fixed = {}, Loss loss = Loss::kLogRatio) {
  return {testing_support::table_of(plastic()), Material(), {Tier::kFull, {}, fixed}, loss};
}

// Gradient of the cost by each number.
std::vector<double> gradient(const Problem& problem, const std::vector<double>& x) {
  const Eigen::MatrixXd gram = problem.gram(x);
  std::vector<double> result;
  for (Eigen::Index k = 0; k + 1 < gram.rows(); ++k) result.push_back(gram(k, gram.cols() - 1));
  return result;
}

TEST_F(Solve, FindsTheMaterialOfAnExactTableUnderEveryLoss) {
  for (const Loss loss : all_losses()) {
    const OwnedProblem owned = plastic_problem({}, loss);
    const std::vector<double> truth = owned.parametrisation.from_material(plastic());
    const std::vector<double> start = {0.5, 0.5, 0.5, 0.3, 0.5, 0.5};
    SolveOptions options;
    options.function_tolerance = 1e-12;
    const Solution solution = solve(owned.problem, start, full_box(owned.parametrisation), options);
    EXPECT_TRUE(solution.converged) << name_of(loss) << ": " << solution.termination;
    EXPECT_LT(solution.cost, 1e-3 * owned.problem.cost(start)) << name_of(loss);
    for (std::size_t k = 0; k < truth.size(); ++k) {
      EXPECT_NEAR(solution.x[k], truth[k], 1e-4)
          << name_of(loss) << ", " << owned.parametrisation.free[k].name;
    }
  }
}

TEST_F(Solve, ReportsTheCostAtItsPoint) {
  const OwnedProblem owned = plastic_problem();
  const Solution solution =
      solve(owned.problem, {0.5, 0.5, 0.5, 0.3, 0.5, 0.5}, full_box(owned.parametrisation), {5, 1e-8});
  EXPECT_NEAR(solution.cost, owned.problem.cost(solution.x), 1e-9 * solution.cost);
  EXPECT_GT(solution.evaluations, 0);
}

TEST_F(Solve, SaysWhenItDidNotConverge) {
  const OwnedProblem owned = plastic_problem();
  SolveOptions options;
  options.max_iterations = 1;
  const Solution solution =
      solve(owned.problem, {0.1, 0.9, 0.9, 0.9, 0.1, 0.9}, full_box(owned.parametrisation), options);
  EXPECT_FALSE(solution.converged);
  EXPECT_EQ(solution.termination, "NO_CONVERGENCE");
}

TEST_F(Solve, NeverRaisesTheCost) {
  const OwnedProblem owned = plastic_problem();
  for (const double start : {0.05, 0.5, 0.95}) {
    const std::vector<double> x(6, start);
    for (const int iterations : {1, 3, 10}) {
      SolveOptions options;
      options.max_iterations = iterations;
      const Box box = full_box(owned.parametrisation);
      EXPECT_LE(solve(owned.problem, x, box, options).cost, owned.problem.cost(x));
      EXPECT_LE(solve_pinning(owned.problem, x, box, options).cost, owned.problem.cost(x));
    }
  }
}

// The truth lies outside the box in every number.
TEST_F(Solve, StaysInItsBox) {
  const OwnedProblem owned = plastic_problem();
  Box box = full_box(owned.parametrisation);
  box.lower = {0.1, 0.4, 0.2, 0.3, 0.1, 0.5};
  box.upper = {0.5, 0.8, 0.9, 0.9, 0.6, 0.9};
  for (const bool pinning : {false, true}) {
    // Outside the box: moved to it.
    const std::vector<double> x = {0.0, 0.0, 0.0, 0.0, 0.0, 1.0};
    const Solution solution =
        pinning ? solve_pinning(owned.problem, x, box, {}) : solve(owned.problem, x, box, {});
    for (std::size_t k = 0; k < x.size(); ++k) {
      EXPECT_GE(solution.x[k], box.lower[k]) << owned.parametrisation.free[k].name;
      EXPECT_LE(solution.x[k], box.upper[k]) << owned.parametrisation.free[k].name;
    }
  }
}

TEST_F(Solve, HoldsWhatMayNotMove) {
  const OwnedProblem owned = plastic_problem();
  Box box = full_box(owned.parametrisation);
  box.moves = {true, false, true, false, true, false};
  const std::vector<double> x = {0.5, 0.123, 0.5, 0.321, 0.5, 0.456};
  for (const bool pinning : {false, true}) {
    const Solution solution =
        pinning ? solve_pinning(owned.problem, x, box, {}) : solve(owned.problem, x, box, {});
    for (const std::size_t k : {1U, 3U, 5U}) EXPECT_EQ(solution.x[k], x[k]);
    for (const std::size_t k : {0U, 2U}) EXPECT_NE(solution.x[k], x[k]);
  }
}

TEST_F(Solve, OfNothingFreeIsTheCostWhereItStands) {
  const OwnedProblem owned =
      plastic_problem({{"base_color", {0.5}}, {"metallic", {0}}, {"specular", {0.5}}, {"roughness", {0.5}}});
  ASSERT_EQ(owned.parametrisation.size(), 0U);
  for (const bool pinning : {false, true}) {
    const Box box = full_box(owned.parametrisation);
    const Solution solution =
        pinning ? solve_pinning(owned.problem, {}, box, {}) : solve(owned.problem, {}, box, {});
    EXPECT_TRUE(solution.converged);
    EXPECT_GT(solution.cost, 0.0);
    EXPECT_EQ(solution.cost, owned.problem.cost({}));
    EXPECT_EQ(solution.termination, "nothing to fit");
  }
}

// Tables that the model cannot make push parameters against their bounds. In the end every number is at a
// minimum of its own range: inside with no slope, or at a bound that the cost falls towards.
TEST_F(Solve, PinningEndsAtAMinimumOfTheBox) {
  std::size_t at_bounds = 0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    const Material other =
        testing_support::random_full_material(Model::kCallisto, effects_of(Model::kCallisto), seed);
    const OwnedProblem owned(testing_support::table_of(other), Material(Model::kBurley),
                             {Tier::kFull, effects_of(Model::kBurley).without(Effect::kAnisotropic), {}});
    const Solution solution =
        solve_pinning(owned.problem, std::vector<double>(owned.parametrisation.size(), 0.5),
                      full_box(owned.parametrisation), {});
    EXPECT_TRUE(solution.converged) << solution.termination;
    const std::vector<double> slope = gradient(owned.problem, solution.x);
    const Eigen::MatrixXd gram = owned.problem.gram(solution.x);
    for (std::size_t k = 0; k < slope.size(); ++k) {
      const FreeParameter& parameter = owned.parametrisation.free[k];
      const double margin = 1e-9 * (parameter.upper - parameter.lower);
      // What a whole range's worth of this slope is, as a share of what the residuals could give.
      const auto at = static_cast<Eigen::Index>(k);
      const double steepest = std::sqrt(gram(at, at) * 2.0 * solution.cost);
      const double share = steepest > 0.0 ? slope[k] / steepest : 0.0;
      if (solution.x[k] <= parameter.lower + margin) {
        EXPECT_GE(share, -1e-3) << parameter.name << ", seed " << seed;
        ++at_bounds;
      } else if (solution.x[k] >= parameter.upper - margin) {
        EXPECT_LE(share, 1e-3) << parameter.name << ", seed " << seed;
        ++at_bounds;
      } else {
        EXPECT_NEAR(share, 0.0, 1e-2) << parameter.name << " = " << solution.x[k] << ", seed " << seed;
      }
    }
  }
  EXPECT_GT(at_bounds, 6U);
}

// A number that starts at the wrong bound leaves it.
TEST_F(Solve, PinningLetsGoOfTheWrongBound) {
  const OwnedProblem owned = plastic_problem();
  const std::vector<double> truth = owned.parametrisation.from_material(plastic());
  for (const std::vector<double>& x : {std::vector<double>{0.6, 0.3, 0.1, 0.0, 0.0, 0.4},
                                       std::vector<double>{1.0, 1.0, 1.0, 0.2, 1.0, 1.0}}) {
    const Solution solution = solve_pinning(owned.problem, x, full_box(owned.parametrisation), {});
    for (std::size_t k = 0; k < truth.size(); ++k) {
      EXPECT_NEAR(solution.x[k], truth[k], 1e-3) << owned.parametrisation.free[k].name;
    }
  }
}

TEST_F(Solve, PinningCountsTheIterationsOfAllItsRuns) {
  const OwnedProblem owned = plastic_problem();
  SolveOptions options;
  options.max_iterations = 3;
  const Solution solution =
      solve_pinning(owned.problem, {0.1, 0.9, 0.9, 0.9, 0.1, 0.9}, full_box(owned.parametrisation), options);
  EXPECT_FALSE(solution.converged);
  // Ceres counts the evaluation at the start as iteration 0.
  EXPECT_LE(solution.iterations, 4);
}

}  // namespace
}  // namespace brdfit::fit
