// Cosines and angles that the kernels take from a pair of directions.
#include "brdf/kernel/geometry.h"

#include <gtest/gtest.h>

#include "tests/direction_pairs.h"

namespace brdfit::kernel {
namespace {

using testing_support::Pair;
using testing_support::pair_at;

Geometry<double> geometry(const Pair& pair) {
  return geometry_from_directions(pair.wi.x, pair.wi.y, pair.wi.z, pair.wo.x, pair.wo.y, pair.wo.z);
}

TEST(KernelGeometry, FollowsTheHalfAndDifferenceAngles) {
  for (const double theta_h : {0.1, 0.7, 1.3}) {
    for (const double theta_d : {0.05, 0.6, 1.4}) {
      for (const double phi_d : {0.0, 0.9, 2.0, 4.0}) {
        const auto g = geometry(pair_at(theta_h, theta_d, phi_d));
        const double along = std::sin(theta_d) * std::cos(phi_d) * std::sin(theta_h);
        EXPECT_NEAR(g.cos_h, std::cos(theta_h), 1e-15);
        EXPECT_NEAR(g.cos_d, std::cos(theta_d), 1e-15);
        EXPECT_NEAR(g.h_x, std::sin(theta_h), 1e-15);
        EXPECT_NEAR(g.h_y, 0.0, 1e-15);
        EXPECT_NEAR(g.cos_i, std::cos(theta_d) * std::cos(theta_h) - along, 1e-15);
        EXPECT_NEAR(g.cos_o, std::cos(theta_d) * std::cos(theta_h) + along, 1e-15);
      }
    }
  }
}

TEST(KernelGeometry, KeepsTheDigitsOfOneMinusCosineAtSmallAngles) {
  for (const double angle : {1e-7, 1e-5, 1e-3}) {
    const double expected = 2.0 * std::pow(std::sin(angle / 2), 2);
    EXPECT_NEAR(geometry(pair_at(angle, 0.0, 0.0)).one_minus_cos_h, expected, 1e-12 * expected);
    EXPECT_NEAR(geometry(pair_at(0.0, angle, 0.0)).one_minus_cos_d, expected, 1e-12 * expected);
  }
}

TEST(KernelGeometry, OfTheNormalTwiceIsExact) {
  const auto g = geometry({{0, 0, 1}, {0, 0, 1}});
  EXPECT_EQ(g.cos_h, 1.0);
  EXPECT_EQ(g.cos_d, 1.0);
  EXPECT_EQ(g.one_minus_cos_h, 0.0);
  EXPECT_EQ(g.one_minus_cos_d, 0.0);
}

TEST(KernelGeometry, HasTheNormalAsHalfVectorOfNearlyOppositeDirections) {
  // cos(pi/2) in double is 6e-17.
  for (const double z : {1e-9, 6e-17, 1e-100, 5e-324, 0.0}) {
    const auto g = geometry({{1, 0, z}, {-1, 0, z}});
    EXPECT_EQ(g.h_x, 0.0) << z;
    EXPECT_EQ(g.h_y, 0.0) << z;
    EXPECT_DOUBLE_EQ(g.cos_h, 1.0) << z;
    EXPECT_EQ(g.one_minus_cos_h, 0.0) << z;
    EXPECT_NEAR(g.cos_d, z, 1e-16 * z + 1e-160) << z;
    EXPECT_NEAR(g.one_minus_cos_d, 1.0, 1.1 * z) << z;
  }
}

TEST(KernelGeometry, OfOppositeDirectionsIsFinite) {
  const auto g = geometry({{0.6, 0, 0.8}, {-0.6, 0, -0.8}});
  for (const double x : {g.h_x, g.h_y, g.cos_h, g.cos_d, g.one_minus_cos_h, g.one_minus_cos_d}) {
    EXPECT_TRUE(std::isfinite(x));
  }
  EXPECT_EQ(g.one_minus_cos_d, 1.0);
}

TEST(KernelGeometry, KeepsBasesOfPowersWithinZeroAndOne) {
  for (const Pair& pair : testing_support::adversarial_pairs()) {
    const auto g = geometry(pair);
    for (const double x : {g.cos_h, g.cos_d, g.one_minus_cos_h, g.one_minus_cos_d}) {
      EXPECT_GE(x, 0.0);
      EXPECT_LE(x, 1.0);
    }
  }
}

TEST(KernelGeometry, LogsAreNaturalAndZeroForABaseOfZero) {
  const auto g = geometry(pair_at(0.7, 0.4, 1.0));
  const auto logs = geometry_logs(g);
  EXPECT_DOUBLE_EQ(logs.cos_h, std::log(g.cos_h));
  EXPECT_DOUBLE_EQ(logs.cos_d, std::log(g.cos_d));
  EXPECT_DOUBLE_EQ(logs.one_minus_cos_h, std::log(g.one_minus_cos_h));
  EXPECT_DOUBLE_EQ(logs.one_minus_cos_d, std::log(g.one_minus_cos_d));
  const auto at_normal = geometry_logs(geometry({{0, 0, 1}, {0, 0, 1}}));
  EXPECT_EQ(at_normal.one_minus_cos_h, 0.0);
  EXPECT_EQ(at_normal.one_minus_cos_d, 0.0);
}

TEST(AboveHorizon, KeepsAValueOnlyWhereBothDirectionsAreAbove) {
  EXPECT_EQ(above_horizon(2.0, 0.1, 0.1), 2.0);
  EXPECT_EQ(above_horizon(2.0, 0.0, 0.1), 0.0);
  EXPECT_EQ(above_horizon(2.0, 0.1, 0.0), 0.0);
  EXPECT_EQ(above_horizon(2.0, -0.1, -0.1), 0.0);
}

}  // namespace
}  // namespace brdfit::kernel
