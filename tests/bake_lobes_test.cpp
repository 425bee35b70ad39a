// Uniform sets of lobes, and what they are compared with.
#include "bake/lobes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bake/baselines.h"
#include "bake/k_means.h"
#include "tests/lobe_data.h"

namespace brdfit::bake {
namespace {

double cosine(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

TEST(UniformLobes, LieOnTheCapOfTheLightsWhereverItPoints) {
  for (const Vec3 axis :
       {Vec3{0.0, 0.0, 1.0}, Vec3{0.0, 0.0, -1.0}, Vec3{0.6, 0.0, 0.8}, Vec3{0.0, -1.0, 0.0}}) {
    const Cap cap = {axis, 0.7};
    for (int count = 1; count <= kMaxLobes; ++count) {
      const LobeSet lobes = uniform_lobes(count, cap);
      ASSERT_EQ(lobes.size(), static_cast<std::size_t>(count));
      for (const Lobe& lobe : lobes) {
        EXPECT_NEAR(cosine(lobe.axis, lobe.axis), 1.0, 1e-12);
        EXPECT_GE(cosine(lobe.axis, axis), std::cos(0.7) - 1e-12);
      }
    }
  }
}

TEST(UniformLobes, KeepTheirDistance) {
  const Cap cap = {{0.0, 0.0, 1.0}, 1.4};
  for (int count = 2; count <= kMaxLobes; ++count) {
    const LobeSet lobes = uniform_lobes(count, cap);
    const double typical = spacing(cap, lobes.size());
    for (std::size_t i = 0; i < lobes.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_LT(cosine(lobes[i].axis, lobes[j].axis), std::cos(0.45 * typical));
      }
    }
  }
}

TEST(UniformLobes, FallToTheirOverlapAtANeighboursDistance) {
  const Cap cap = {{0.0, 0.0, 1.0}, 1.0};
  for (const double overlap : {0.2, 0.6, 0.9}) {
    const Lobe lobe = uniform_lobes(8, cap, overlap)[3];
    EXPECT_NEAR(std::exp(lobe.sharpness * (std::cos(spacing(cap, 8)) - 1.0)), overlap, 1e-12);
  }
}

TEST(UniformLobes, RefuseWhatCannotBe) {
  const Cap cap = {{0.0, 0.0, 1.0}, 1.0};
  EXPECT_THROW(uniform_lobes(0, cap), std::invalid_argument);
  EXPECT_THROW(uniform_lobes(17, cap), std::invalid_argument);
  EXPECT_THROW(uniform_lobes(4, cap, 0.0), std::invalid_argument);
  EXPECT_THROW(uniform_lobes(4, cap, 1.0), std::invalid_argument);
}

TEST(UniformLobes, AreFiniteForOneLightAndForOppositeOnes) {
  for (const std::vector<Vec3>& lights :
       {std::vector<Vec3>{{0.0, 0.0, 1.0}}, std::vector<Vec3>{{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}}}) {
    for (const Lobe& lobe : uniform_lobes(8, cap_of(lights))) {
      EXPECT_TRUE(std::isfinite(lobe.sharpness));
      EXPECT_NEAR(cosine(lobe.axis, lobe.axis), 1.0, 1e-12);
    }
  }
}

TEST(CapOf, HoldsAllLights) {
  const std::vector<Vec3> lights = bake_data::cap_of_lights(30, 0.8);
  const Cap cap = cap_of(lights);
  for (const Vec3& d : lights) EXPECT_GE(cosine(cap.axis, d), std::cos(cap.angle) - 1e-12);
  EXPECT_NEAR(cap.angle, 0.8, 0.06);
}

// Baselines reproduce what lies in their span, under lights they never saw.
template <class Basis>
void expect_reproduction(const Basis& basis_of, Eigen::Index terms) {
  const std::vector<Vec3> seen = bake_data::dome(30);
  const std::vector<Vec3> unseen = bake_data::cap_of_lights(7, 1.1);
  const Eigen::MatrixXd basis = basis_of(seen);
  const Eigen::MatrixXd target = basis_of(unseen);
  ASSERT_EQ(basis.cols(), terms);
  const Eigen::MatrixXd coefficients = Eigen::MatrixXd::Random(terms, 5);
  const Eigen::MatrixXd values = basis * coefficients;
  const Eigen::MatrixXd expected = target * coefficients;
  std::vector<float> planes;
  for (Eigen::Index l = 0; l < values.rows(); ++l) {
    for (Eigen::Index i = 0; i < 5; ++i) planes.push_back(static_cast<float>(values(l, i)));
  }
  const std::vector<float> predicted = fit_and_predict(basis, planes, 5, target);
  for (Eigen::Index l = 0; l < expected.rows(); ++l) {
    for (Eigen::Index i = 0; i < 5; ++i) {
      EXPECT_NEAR(predicted[static_cast<std::size_t>(l * 5 + i)], expected(l, i), 1e-5);
    }
  }
}

TEST(Baselines, ReproduceWhatTheySpan) {
  expect_reproduction([](const std::vector<Vec3>& d) { return ptm_basis(d); }, 6);
  expect_reproduction([](const std::vector<Vec3>& d) { return harmonics_basis(d); }, 9);
}

TEST(Baselines, HarmonicsAreOrthonormalOverTheSphere) {
  const std::vector<Vec3> sphere = bake_data::cap_of_lights(20000, std::numbers::pi);
  const Eigen::MatrixXd basis = harmonics_basis(sphere);
  const Eigen::MatrixXd gram = basis.transpose() * basis * (4.0 * std::numbers::pi / 20000.0);
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(9, 9)).cwiseAbs().maxCoeff(), 2e-3);
}

TEST(Baselines, GoThroughAllValuesOfFewerLightsThanTerms) {
  const std::vector<Vec3> seen = bake_data::dome(4);
  const std::vector<float> values = {0.1F, 0.5F, 0.9F, 0.2F};
  const Eigen::MatrixXd basis = harmonics_basis(seen);
  const std::vector<float> predicted = fit_and_predict(basis, values, 1, basis);
  for (std::size_t l = 0; l < 4; ++l) EXPECT_NEAR(predicted[l], values[l], 1e-5);
}

TEST(Baselines, StayFiniteForLightsInOnePlace) {
  const std::vector<Vec3> seen(5, Vec3{0.0, 0.0, 1.0});
  const std::vector<float> values = {0.1F, 0.3F, 0.2F, 0.2F, 0.2F};
  const std::vector<Vec3> unseen = bake_data::dome(6);
  for (const float p : fit_and_predict(ptm_basis(seen), values, 1, ptm_basis(unseen))) {
    EXPECT_TRUE(std::isfinite(p));
    EXPECT_LT(std::abs(p), 1.0F);
  }
}

TEST(KMeans, FindsClustersThatAreFarApart) {
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int k = 0; k < 30; ++k) {
    const double at = 10.0 * (k % 3);
    points.push_back({at + 0.01 * k, -at, 0.02 * k});
    weights.push_back(1.0 + k);
  }
  const Clusters clusters = k_means(points, weights, 3, 1);
  ASSERT_EQ(clusters.centres.size(), 3U);
  for (std::size_t k = 3; k < points.size(); ++k) EXPECT_EQ(clusters.of[k], clusters.of[k % 3]);
}

TEST(KMeans, PointsWithoutWeightDoNotMoveCentres) {
  const std::vector<Vec3> points = {{1.0, 0.0, 0.0}, {3.0, 0.0, 0.0}, {100.0, 0.0, 0.0}};
  const Clusters clusters = k_means(points, std::vector<double>{1.0, 3.0, 0.0}, 1, 1);
  ASSERT_EQ(clusters.centres.size(), 1U);
  EXPECT_NEAR(clusters.centres[0].x, 2.5, 1e-12);
}

TEST(KMeans, GivesNoMoreCentresThanPointsThatDiffer) {
  const std::vector<Vec3> points(10, Vec3{1.0, 2.0, 3.0});
  EXPECT_EQ(k_means(points, std::vector<double>(10, 1.0), 4, 1).centres.size(), 1U);
  EXPECT_TRUE(k_means(points, std::vector<double>(10, 0.0), 4, 1).centres.empty());
}

}  // namespace
}  // namespace brdfit::bake
