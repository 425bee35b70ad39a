// The search's own descent: downhill, inside its box, to the minimum that Ceres finds.
#include "fit/descend.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fit/starts.h"
#include "tests/fit_data.h"

namespace brdfit::fit {
namespace {

using testing_support::OwnedProblem;
using testing_support::random_full_material;
using testing_support::table_of;

Effects all_effects_of(Model model) {
  return effects_of(model).without(Effect::kAnisotropic);
}

// A problem that no material of the model solves exactly: the table is of another model.
OwnedProblem foreign_problem(Model model) {
  const Model other = model == Model::kCallisto ? Model::kBurley : Model::kCallisto;
  return {table_of(random_full_material(other, all_effects_of(other), 5)),
          Material(model),
          {Tier::kFull, all_effects_of(model), {}}};
}

TEST(Descend, NeverRaisesTheCostAndStaysInItsBox) {
  for (const Model model : all_models()) {
    const OwnedProblem owned = foreign_problem(model);
    const Box box = full_box(owned.parametrisation);
    for (const std::vector<double>& x : make_starts(owned.parametrisation, owned.samples, 12, 1)) {
      double before = 0.0;
      owned.problem.gram(x, &before);
      for (const int iterations : {1, 2, 5, 50}) {
        const Solution solution = descend(owned.problem, x, box, {iterations, 1e-9, 1e-4});
        EXPECT_LE(solution.cost, before);
        EXPECT_LE(solution.iterations, iterations);
        EXPECT_NEAR(solution.cost, owned.problem.cost(solution.x), 1e-12 * solution.cost);
        for (std::size_t k = 0; k < x.size(); ++k) {
          EXPECT_GE(solution.x[k], box.lower[k]) << owned.parametrisation.free[k].name;
          EXPECT_LE(solution.x[k], box.upper[k]) << owned.parametrisation.free[k].name;
        }
        before = solution.cost;  // more iterations go on from where fewer stopped
      }
    }
  }
}

TEST(Descend, GivesUpAGoalThatIsOutOfReachAndGoesOnTowardsOneThatIsNot) {
  const OwnedProblem owned = foreign_problem(Model::kCallisto);
  const Box box = full_box(owned.parametrisation);
  int evaluations = 0;
  int given_up = 0;
  for (const std::vector<double>& x : make_starts(owned.parametrisation, owned.samples, 12, 1)) {
    DescentOptions options = {30, 1e-9, 1e-4};
    const Solution without = descend(owned.problem, x, box, options);
    options.goal = owned.problem.cost(x);  // met by whatever goes down
    EXPECT_EQ(descend(owned.problem, x, box, options).x, without.x);
    options.goal = 0.5 * without.cost;
    const Solution hopeless = descend(owned.problem, x, box, options);
    EXPECT_GE(hopeless.cost, without.cost);
    evaluations += without.evaluations;
    given_up += hopeless.evaluations;
  }
  EXPECT_LT(given_up, evaluations);
}

TEST(Descend, HoldsWhatMayNotMove) {
  const OwnedProblem owned = foreign_problem(Model::kCallisto);
  Box box = full_box(owned.parametrisation);
  for (std::size_t k = 0; k < box.moves.size(); k += 2) box.moves[k] = false;
  const std::vector<double> x = make_starts(owned.parametrisation, owned.samples, 1, 1).front();
  const Solution solution = descend(owned.problem, x, box, {});
  EXPECT_LT(solution.cost, owned.problem.cost(x));
  for (std::size_t k = 0; k < x.size(); k += 2) EXPECT_EQ(solution.x[k], x[k]);
}

TEST(Descend, MovesAStartOutsideItsBoxIntoIt) {
  const OwnedProblem owned = foreign_problem(Model::kLambertGgx);
  Box box = full_box(owned.parametrisation);
  std::ranges::fill(box.lower, 0.3);
  std::ranges::fill(box.upper, 0.6);
  for (const double outside : {0.0, 1.0}) {
    const Solution solution =
        descend(owned.problem, std::vector<double>(box.moves.size(), outside), box, {1, 1e-5, 1e-2});
    for (const double value : solution.x) {
      EXPECT_GE(value, 0.3);
      EXPECT_LE(value, 0.6);
    }
  }
}

// From where the descent stopped, Ceres gains nearly nothing.
TEST(Descend, EndsAtAMinimum) {
  silence_solver_logging();
  for (const Model model : all_models()) {
    const OwnedProblem owned = foreign_problem(model);
    const Box box = full_box(owned.parametrisation);
    for (const std::vector<double>& x : make_starts(owned.parametrisation, owned.samples, 3, 2)) {
      const Solution solution = descend(owned.problem, x, box, {300, 1e-9, 1e-2});
      EXPECT_TRUE(solution.converged);
      const Solution further = solve_pinning(owned.problem, solution.x, box, {});
      EXPECT_GT(further.cost, 0.99 * solution.cost) << title_of(model);
    }
  }
}

TEST(Descend, WithNothingToMoveStaysWhereItIs) {
  const OwnedProblem owned = foreign_problem(Model::kBurley);
  Box box = full_box(owned.parametrisation);
  box.moves.assign(box.moves.size(), false);
  const std::vector<double> x = make_starts(owned.parametrisation, owned.samples, 1, 1).front();
  EXPECT_EQ(descend(owned.problem, x, box, {}).x, x);
}

}  // namespace
}  // namespace brdfit::fit
