// The search for lobes: what it minimises, how it descends, and where it ends.
#include "bake/lobe_search.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "bake/lobe_objective.h"
#include "bake/solve.h"
#include "tests/lobe_data.h"
#include "tests/texel_solution.h"

namespace brdfit::bake {
namespace {

using bake_data::add_noise;
using bake_data::dome;
using bake_data::lit_texels;
using bake_data::made_of;
using bake_data::odd_lobes;

TEST(ResidualClasses, HoldTheWholeEnergyOfAFullRank) {
  const std::vector<Vec3> directions = dome(20);
  TexelProblem problem = lit_texels(directions, 300, 0.8, 1);
  add_noise(problem, 0.3, 2);
  ClassOptions options;
  options.classes = 5;
  options.rank = 20;
  double energy = 0.0;
  std::size_t texels = 0;
  for (const ResidualClass& c : residual_classes(problem, directions, options)) {
    EXPECT_NEAR(c.factor.squaredNorm(), c.energy, 1e-9 * c.energy);
    energy += c.energy;
    texels += c.texels;
  }
  double expected = 0.0;
  for (const float e : problem.residual) expected += static_cast<double>(e) * e;
  EXPECT_NEAR(energy, expected, 1e-9 * expected);
  EXPECT_EQ(texels, 300U);
}

TEST(ResidualClasses, AreNoneWithoutResidual) {
  const std::vector<Vec3> directions = dome(20);
  EXPECT_TRUE(residual_classes(lit_texels(directions, 30, 0.8, 1), directions).empty());
}

// With one modulation for all texels the objective is no approximation.
TEST(LobeObjective, IsTheLeaveOneOutErrorOfTexels) {
  const std::vector<Vec3> directions = dome(25);
  TexelProblem problem = lit_texels(directions, 40, 0.0, 1);
  add_noise(problem, 0.3, 2);
  ClassOptions options;
  options.rank = 25;
  const std::vector<ResidualClass> classes = residual_classes(problem, directions, options);
  ASSERT_EQ(classes.size(), 1U);
  const LobeSet lobes = odd_lobes();
  const LobeObjective objective(classes, 4, LobeBounds());
  // The objective's unit of the ridge is that of modulations, without lobes.
  double unit = 0.0;
  for (std::size_t l = 0; l < directions.size(); ++l) {
    unit += std::pow(static_cast<double>(problem.modulation[problem.at(l, 0)]), 2.0);
  }
  unit /= 4.0;
  double error = 0.0;
  double energy = 0.0;
  const Eigen::MatrixXd basis = lobe_values(lobes, directions);
  for (std::size_t i = 0; i < problem.texels; ++i) {
    Eigen::VectorXd residual(25);
    Eigen::VectorXd modulation(25);
    for (std::size_t l = 0; l < 25; ++l) {
      residual[static_cast<Eigen::Index>(l)] = problem.residual[problem.at(l, i)];
      modulation[static_cast<Eigen::Index>(l)] = problem.modulation[problem.at(l, i)];
    }
    error += test_data::solve_texel(basis, residual, modulation, Eigen::VectorXd::Ones(25), 0.05 * unit)
                 .left_out.squaredNorm();
    energy += residual.squaredNorm();
  }
  EXPECT_NEAR(objective.evaluate(lobes, 0.05), error / energy, 1e-9);
}

TEST(LobeObjective, HasTheDerivativesOfItsDifferences) {
  const std::vector<Vec3> directions = dome(25);
  const TexelProblem problem = made_of(odd_lobes(), directions, 200, 0.1);
  const std::vector<ResidualClass> classes = residual_classes(problem, directions);
  const LobeObjective objective(classes, 3, bounds_of(directions));
  LobeSet lobes = odd_lobes();
  lobes.resize(3);
  for (Lobe& lobe : lobes) lobe.axis = {lobe.axis.x + 0.1, lobe.axis.y - 0.05, lobe.axis.z};
  const std::vector<double> at = objective.pack(lobes, 0.03);
  std::vector<double> gradient(at.size());
  objective.evaluate(at, gradient.data());
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double step = 1e-5;
    std::vector<double> above = at;
    std::vector<double> below = at;
    above[k] += step;
    below[k] -= step;
    const double difference =
        (objective.evaluate(above, nullptr) - objective.evaluate(below, nullptr)) / (2.0 * step);
    EXPECT_NEAR(gradient[k], difference, 1e-7) << "parameter " << k;
  }
}

TEST(LobeObjective, KeepsLobesWithinTheirBounds) {
  const std::vector<Vec3> directions = dome(25);
  const TexelProblem problem = made_of(odd_lobes(), directions, 50, 0.1);
  const std::vector<ResidualClass> classes = residual_classes(problem, directions);
  const LobeBounds bounds = bounds_of(directions);
  const LobeObjective objective(classes, 1, bounds);
  for (const double far : {-50.0, 0.0, 50.0}) {
    const std::vector<double> parameters = {0.3, 0.4, 3.0, far, far, far};
    const Lobe lobe = objective.lobes(parameters)[0];
    EXPECT_GE(lobe.sharpness, bounds.sharpness_low);
    EXPECT_LE(lobe.sharpness, bounds.sharpness_high * (1.0 + 1e-12));
    EXPECT_GE(lobe.cos_cut_off, -1.0);
    EXPECT_LE(lobe.cos_cut_off, std::cos(bounds.least_cut_off) + 1e-12);
    EXPECT_TRUE(std::isfinite(objective.evaluate(parameters, nullptr)));
  }
}

TEST(LobeSearch, LeavesLessThanTheBestUniformSet) {
  const std::vector<Vec3> directions = dome(60);
  const TexelProblem problem = made_of(odd_lobes(), directions, 400, 0.05);
  const LobeSearchResult found = search_lobes(residual_classes(problem, directions), directions, 4);
  EXPECT_LT(found.objective, 0.5 * found.start_objective);
}

TEST(LobeSearch, ThreadsChangeNothing) {
  const std::vector<Vec3> directions = dome(30);
  const TexelProblem problem = made_of(odd_lobes(), directions, 100, 0.05);
  const std::vector<ResidualClass> classes = residual_classes(problem, directions);
  const LobeSearchResult many = search_lobes(classes, directions, 4);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(search_lobes(classes, directions, 4).lobes, many.lobes);
}

TEST(LobeSearch, OfNoResidualIsUniform) {
  const std::vector<Vec3> directions = dome(30);
  EXPECT_EQ(search_lobes({}, directions, 4).lobes, uniform_lobes(4, cap_of(directions)));
}

}  // namespace
}  // namespace brdfit::bake
