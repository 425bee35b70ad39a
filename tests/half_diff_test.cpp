// Half/difference angles: round trips, and the cosines of the published formulas.
#include "brdf/half_diff.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace brdfit {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTolerance = 1e-14;

double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

HalfDiff random_angles(std::mt19937& random) {
  std::uniform_real_distribution<double> inside(1e-3, 0.5 * kPi - 1e-3);
  std::uniform_real_distribution<double> turn(0.0, 2.0 * kPi);
  return {inside(random), inside(random), turn(random)};
}

TEST(HalfDiff, DirectionsAreUnitAndMeetTheCosinesOfThePublishedFormulas) {
  std::mt19937 random(1);
  for (int k = 0; k < 1000; ++k) {
    const HalfDiff angles = random_angles(random);
    const auto [wi, wo] = directions_from_half_diff(angles);
    const double cos_h = std::cos(angles.theta_h_rad);
    const double sin_h = std::sin(angles.theta_h_rad);
    const double cos_d = std::cos(angles.theta_d_rad);
    const double sin_d = std::sin(angles.theta_d_rad);
    EXPECT_NEAR(dot(wi, wi), 1.0, kTolerance);
    EXPECT_NEAR(dot(wo, wo), 1.0, kTolerance);
    EXPECT_NEAR(wi.z, cos_d * cos_h - sin_d * std::cos(angles.phi_d_rad) * sin_h, kTolerance);
    EXPECT_NEAR(wo.z, cos_d * cos_h + sin_d * std::cos(angles.phi_d_rad) * sin_h, kTolerance);
    EXPECT_NEAR(dot(wi, wo), std::cos(2.0 * angles.theta_d_rad), kTolerance);
  }
}

TEST(HalfDiff, TheHalfVectorLiesInTheXzPlaneAtThetaH) {
  std::mt19937 random(2);
  for (int k = 0; k < 1000; ++k) {
    const HalfDiff angles = random_angles(random);
    const auto [wi, wo] = directions_from_half_diff(angles);
    const double length = 2.0 * std::cos(angles.theta_d_rad);
    EXPECT_NEAR(wi.x + wo.x, length * std::sin(angles.theta_h_rad), kTolerance);
    EXPECT_NEAR(wi.y + wo.y, 0.0, kTolerance);
    EXPECT_NEAR(wi.z + wo.z, length * std::cos(angles.theta_h_rad), kTolerance);
  }
}

TEST(HalfDiff, AnglesSurviveTheWayToDirectionsAndBack) {
  std::mt19937 random(3);
  for (int k = 0; k < 1000; ++k) {
    const HalfDiff angles = random_angles(random);
    const auto [wi, wo] = directions_from_half_diff(angles);
    const HalfDiff back = half_diff_from_directions(wi, wo);
    EXPECT_NEAR(back.theta_h_rad, angles.theta_h_rad, 1e-12);
    EXPECT_NEAR(back.theta_d_rad, angles.theta_d_rad, 1e-12);
    // Compared on the circle, as loosely as the nearness of a pole asks for.
    const double slack = 1e-13 / (std::sin(angles.theta_h_rad) * std::sin(angles.theta_d_rad)) + 1e-12;
    EXPECT_NEAR(std::remainder(back.phi_d_rad - angles.phi_d_rad, 2.0 * kPi), 0.0, slack);
  }
}

TEST(HalfDiff, TurningBothDirectionsAboutTheNormalChangesNothing) {
  std::mt19937 random(4);
  const auto turned = [](const Vec3& v, double angle) {
    return Vec3{std::cos(angle) * v.x - std::sin(angle) * v.y, std::sin(angle) * v.x + std::cos(angle) * v.y,
                v.z};
  };
  for (int k = 0; k < 1000; ++k) {
    const auto [wi, wo] = directions_from_half_diff({0.7, 0.5, 0.1 + 0.006 * k});
    const double angle = std::uniform_real_distribution<double>(0.0, 2.0 * kPi)(random);
    const HalfDiff back = half_diff_from_directions(turned(wi, angle), turned(wo, angle));
    EXPECT_NEAR(back.theta_h_rad, 0.7, 1e-12);
    EXPECT_NEAR(back.theta_d_rad, 0.5, 1e-12);
    EXPECT_NEAR(std::remainder(back.phi_d_rad - 0.1 - 0.006 * k, 2.0 * kPi), 0.0, 1e-12);
  }
}

TEST(HalfDiff, SwappingTheDirectionsIsHalfATurnOfPhi) {
  std::mt19937 random(5);
  for (int k = 0; k < 1000; ++k) {
    const auto [wi, wo] = directions_from_half_diff(random_angles(random));
    const HalfDiff one = half_diff_from_directions(wi, wo);
    const HalfDiff other = half_diff_from_directions(wo, wi);
    EXPECT_DOUBLE_EQ(one.theta_h_rad, other.theta_h_rad);
    EXPECT_DOUBLE_EQ(one.theta_d_rad, other.theta_d_rad);
    EXPECT_NEAR(std::abs(one.phi_d_rad - other.phi_d_rad), kPi, 1e-12);
  }
}

TEST(HalfDiff, PhiIsInItsRangeAndZeroWhereItIsUndefined) {
  for (int k = 0; k <= 360; ++k) {
    const double phi_rad = k * kPi / 180.0;
    const auto [wi, wo] = directions_from_half_diff({0.3, 0.4, phi_rad});
    const double back = half_diff_from_directions(wi, wo).phi_d_rad;
    EXPECT_GE(back, 0.0);
    EXPECT_LT(back, 2.0 * kPi);
    const auto at_normal = directions_from_half_diff({0.0, 0.4, phi_rad});
    EXPECT_EQ(half_diff_from_directions(at_normal.wi, at_normal.wo).phi_d_rad, 0.0);
    const auto retro = directions_from_half_diff({0.3, 0.0, phi_rad});
    EXPECT_EQ(half_diff_from_directions(retro.wi, retro.wo).phi_d_rad, 0.0);
  }
}

TEST(HalfDiff, SmallAnglesKeepTheirPrecision) {
  const auto [wi, wo] = directions_from_half_diff({1e-9, 1e-6, 1.0});
  const HalfDiff back = half_diff_from_directions(wi, wo);
  EXPECT_NEAR(back.theta_h_rad / 1e-9, 1.0, 1e-6);
  EXPECT_NEAR(back.theta_d_rad / 1e-6, 1.0, 1e-9);
}

}  // namespace
}  // namespace brdfit
