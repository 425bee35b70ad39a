// Standard errors against plain linear least squares, and where there are none.
#include "fit/uncertainty.h"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tests/fit_data.h"

namespace brdfit::fit {
namespace {

using testing_support::OwnedProblem;

Material coloured() {
  Material material;
  material.set("base_color", Rgb{0.7, 0.4, 0.1});
  material.set("metallic", 0.3);
  material.set("specular", 0.6);
  material.set("roughness", 0.35);
  return material;
}

MeasuredTable noisy_table(const Material& material, double noise, std::uint64_t seed = 1) {
  synthetic::Recipe recipe = testing_support::recipe_of(material);
  recipe.noise.multiplicative = noise;
  recipe.seed = seed;
  return synthetic::generate_table(recipe);
}

// A noisy problem at its minimum, and what is said of it.
struct Solved {
  OwnedProblem owned;
  Box box;
  std::vector<double> x;
  Identifiability identifiability;
  Uncertainty uncertainty;

  explicit Solved(const Material& material, double noise = 0.02, Loss loss = Loss::kLogRatio,
                  std::uint64_t seed = 1, const FixedValues& fixed = {})
      : owned(noisy_table(material, noise, seed), material, {Tier::kFull, material.effects(), fixed}, loss),
        box(full_box(owned.parametrisation)),
        x(solve_pinning(owned.problem, owned.parametrisation.from_material(material), box, {}).x),
        identifiability(identify(owned.parametrisation, x, owned.problem.curvature(x))),
        uncertainty(estimate_uncertainty(owned.problem, x, box, identifiability)) {}

  double deviation(std::size_t k) const {
    const auto at = static_cast<Eigen::Index>(k);
    return std::sqrt(uncertainty.covariance(at, at));
  }
  std::vector<ParameterState> states() const {
    std::vector<ParameterState> result = public_states(owned.parametrisation, x, identifiability);
    add_standard_errors(owned.parametrisation, x, uncertainty, result);
    return result;
  }
  ParameterState state(std::string_view name) const {
    const std::vector<ParameterState> all = states();
    const auto found = std::ranges::find(all, name, &ParameterState::name);
    if (found == all.end()) throw std::logic_error("no such state");
    return *found;
  }
};

class Uncertain : public testing::Test {
 protected:
  static void SetUpTestSuite() { silence_solver_logging(); }
};

TEST_F(Uncertain, InverseIsThatOfTheScaledMatrix) {
  Eigen::MatrixXd jacobian(4, 3);
  jacobian << 1.0, 2.0, -1.0, 0.5, 0.3, 2.0, -1.0, 1.0, 0.2, 0.7, -0.4, 1.1;
  const Eigen::MatrixXd gram = jacobian.transpose() * jacobian;
  const Eigen::Vector3d scale(1.0, 2.0, 0.5);
  const Eigen::MatrixXd expected = (scale.asDiagonal() * gram * scale.asDiagonal()).inverse();
  EXPECT_TRUE(inverse_of_gram(gram, scale).isApprox(expected, 1e-9));
}

// Of a matrix without full rank: the pseudo-inverse, which is finite.
TEST_F(Uncertain, InverseLeavesOutWhatIsUnseen) {
  Eigen::MatrixXd jacobian(2, 2);
  jacobian << 1.0, 1.0, 2.0, 2.0;
  const Eigen::MatrixXd gram = jacobian.transpose() * jacobian;
  // All of 10 along (1, 1) / sqrt(2): 1/10 of its projector.
  const Eigen::MatrixXd inverse = inverse_of_gram(gram, Eigen::Vector2d::Ones());
  EXPECT_TRUE(inverse.isApprox(Eigen::Matrix2d::Constant(0.05), 1e-9)) << inverse;
  EXPECT_TRUE(inverse_of_gram(Eigen::Matrix2d::Zero(), Eigen::Vector2d::Ones()).isZero(0.0));
}

// With squares of log-ratios, and cells so bright that their noise is of one size, the jackknife must give
// the textbook's s^2 (J^T J)^-1, to 1 / sqrt(2 groups) = 6%, of which the bound is three times.
TEST_F(Uncertain, DeviationsAreThoseOfLinearLeastSquares) {
  Material material;
  material.set("base_color", Rgb{0.9, 0.8, 0.7});
  material.set("roughness", 0.35);
  OwnedProblem owned(noisy_table(material, 0.02), material,
                     {Tier::kFull, {}, {{"metallic", {0.0}}, {"specular", {0.5}}}});
  owned.targets.robust_width = 0.0;
  std::ranges::fill(owned.targets.clipped_share, 0.0);
  const Box box = full_box(owned.parametrisation);
  const std::vector<double> x =
      solve_pinning(owned.problem, owned.parametrisation.from_material(material), box, {}).x;
  ASSERT_EQ(x.size(), 4U);
  double cost = 0.0;
  const Eigen::MatrixXd gram = owned.problem.gram(x, &cost);
  // Weights sum to 1 over cells, and the cost is half of the squares of three channels.
  const auto cells = static_cast<double>(owned.samples.size());
  const double variance = 2.0 * cost * cells / (3.0 * cells - 4.0);
  const Eigen::MatrixXd expected = variance / cells * gram.topLeftCorner(4, 4).inverse();
  const Uncertainty uncertainty =
      estimate_uncertainty(owned.problem, x, box, identify(owned.parametrisation, x, gram));
  for (Eigen::Index k = 0; k < 4; ++k) {
    EXPECT_NEAR(std::sqrt(uncertainty.covariance(k, k) / expected(k, k)), 1.0, 0.18) << k;
  }
}

// Four times the noise, four times the errors; the loss is square, so that the two problems are alike.
TEST_F(Uncertain, DeviationsGrowWithTheNoise) {
  const Solved little(coloured(), 0.002, Loss::kCubeRoot);
  const Solved much(coloured(), 0.008, Loss::kCubeRoot);
  for (std::size_t k = 0; k < little.x.size(); ++k) {
    EXPECT_NEAR(much.deviation(k) / little.deviation(k), 4.0, 0.2) << k;
  }
}

// What the errors claim is how far fits of other noise lie apart.
TEST_F(Uncertain, DeviationsAreTheScatterOverRepeats) {
  constexpr std::size_t kRepeats = 60;
  const std::size_t n = 6;
  std::vector<double> squares(n, 0.0);
  std::vector<double> claimed(n, 0.0);
  const std::vector<double> truth = Solved(coloured()).owned.parametrisation.from_material(coloured());
  for (std::uint64_t seed = 1; seed <= kRepeats; ++seed) {
    const Solved solved(coloured(), 0.02, Loss::kLogRatio, seed);
    ASSERT_EQ(solved.x.size(), n);
    for (std::size_t k = 0; k < n; ++k) {
      squares[k] += std::pow(solved.x[k] - truth[k], 2) / kRepeats;
      claimed[k] += std::pow(solved.deviation(k), 2) / kRepeats;
    }
  }
  // The root mean square of 60 has a relative error of 1 / sqrt(120) = 9%; three of them.
  for (std::size_t k = 0; k < n; ++k) EXPECT_NEAR(std::sqrt(squares[k] / claimed[k]), 1.0, 0.28) << k;
}

TEST_F(Uncertain, GroupsSumToTheWhole) {
  const Solved solved(coloured());
  const Eigen::MatrixXd whole = solved.owned.problem.curvature(solved.x);
  for (const std::size_t most : {1U, 7U, 256U, 100000U}) {
    const std::vector<Eigen::MatrixXd> groups = solved.owned.problem.curvature_by_group(solved.x, most);
    EXPECT_LE(groups.size(), most);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(whole.rows(), whole.cols());
    for (const Eigen::MatrixXd& group : groups) sum += group;
    EXPECT_LT((sum - whole).norm(), 1e-12 * whole.norm()) << most;
  }
}

TEST_F(Uncertain, NumbersAtBoundsHaveNoErrorAndAreHeld) {
  Material material = coloured();
  material.set("metallic", 0.0);
  material.set("specular", 0.0);
  Solved solved(material, 1e-6);
  const std::size_t specular = solved.owned.index_of("specular");
  solved.x[specular] = 0.0;
  solved.x[solved.owned.index_of("metallic")] = 0.0;
  solved.identifiability =
      identify(solved.owned.parametrisation, solved.x, solved.owned.problem.curvature(solved.x));
  solved.uncertainty =
      estimate_uncertainty(solved.owned.problem, solved.x, solved.box, solved.identifiability);
  EXPECT_THAT(solved.state("specular").standard_error, testing::ElementsAre(std::nullopt));
  EXPECT_TRUE(solved.uncertainty.covariance.row(static_cast<Eigen::Index>(specular)).isZero(0.0));
  EXPECT_TRUE(solved.state("roughness").standard_error[0].has_value());
}

TEST_F(Uncertain, WhatDoesNotMoveHasNoError) {
  Solved solved(coloured());
  const std::size_t metallic = solved.owned.index_of("metallic");
  const double with_all = solved.deviation(solved.owned.index_of("specular"));
  solved.box.moves[metallic] = false;
  solved.uncertainty =
      estimate_uncertainty(solved.owned.problem, solved.x, solved.box, solved.identifiability);
  EXPECT_EQ(solved.deviation(metallic), 0.0);
  EXPECT_FALSE(solved.state("metallic").standard_error[0].has_value());
  EXPECT_LT(solved.deviation(solved.owned.index_of("specular")), with_all);
}

// Grey: metallic and specular do the same. The tied have none; the others have; nothing is NaN.
TEST_F(Uncertain, TiedParametersHaveNoError) {
  Material material = coloured();
  material.set("base_color", 0.1);
  const Solved solved(material);
  EXPECT_TRUE(solved.uncertainty.covariance.allFinite());
  EXPECT_THAT(solved.state("metallic").standard_error, testing::ElementsAre(std::nullopt));
  EXPECT_THAT(solved.state("specular").standard_error, testing::ElementsAre(std::nullopt));
  ASSERT_TRUE(solved.state("roughness").standard_error[0].has_value());
  EXPECT_GT(*solved.state("roughness").standard_error[0], 0.0);
}

TEST_F(Uncertain, OfNothingThatMovesThereIsNothing) {
  const Solved solved(
      coloured(), 0.02, Loss::kLogRatio, 1,
      {{"base_color", {0.7, 0.4, 0.1}}, {"metallic", {0.3}}, {"specular", {0.6}}, {"roughness", {0.35}}});
  for (const ParameterState& state : solved.states()) EXPECT_TRUE(state.standard_error.empty());
}

// An intensity and its tint against differences of what they are made of.
TEST_F(Uncertain, OfProductsAreThoseOfIntensityAndTint) {
  Material material(Model::kCallisto);
  material.set_effects(Effects().with(Effect::kRetroreflection));
  material.set("base_color", Rgb{0.6, 0.4, 0.2});
  material.set("roughness", 0.4);
  material.set("retroreflection", 6.0);
  material.set("retroreflection_tint", Rgb{0.6, 1.0, 0.4});
  const Solved solved(material);
  const Eigen::MatrixXd& covariance = solved.uncertainty.covariance;
  const std::size_t first = solved.owned.index_of("retroreflection.r");
  const auto value = [&](std::vector<double> x, std::size_t c) {
    return solved.owned.parametrisation.to_material(x).colour("retroreflection_tint")[c];
  };
  const auto errors = solved.state("retroreflection_tint").standard_error;
  ASSERT_EQ(errors.size(), 3U);
  EXPECT_FALSE(errors[1].has_value());  // the largest: 1 by definition
  for (const std::size_t c : {0U, 2U}) {
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(covariance.rows());
    for (std::size_t k = first; k < first + 3; ++k) {
      std::vector<double> above = solved.x;
      std::vector<double> below = solved.x;
      above[k] += 1e-5;
      below[k] -= 1e-5;
      slope[static_cast<Eigen::Index>(k)] = (value(above, c) - value(below, c)) / 2e-5;
    }
    ASSERT_TRUE(errors[c].has_value());
    EXPECT_NEAR(*errors[c], std::sqrt(slope.dot(covariance * slope)), 1e-6 * *errors[c]) << c;
  }
  const auto intensity = solved.state("retroreflection").standard_error;
  ASSERT_EQ(intensity.size(), 1U);
  EXPECT_EQ(intensity[0], solved.deviation(solved.owned.index_of("retroreflection.g")));
}

TEST_F(Uncertain, GivesTheSameBitsOnAnyNumberOfThreads) {
  const auto with_threads = [&](std::size_t count) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, count);
    return Solved(coloured()).uncertainty.covariance;
  };
  EXPECT_EQ(with_threads(1), with_threads(2));
}

}  // namespace
}  // namespace brdfit::fit
