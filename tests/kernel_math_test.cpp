// The kernels' small functions, at the ends of their domains above all.
#include "brdf/kernel/math.h"

#include <gtest/gtest.h>

#include <cmath>

namespace brdfit::kernel {
namespace {

double power(double base, double exponent) {
  return power_from_log(base, log_or_zero(base), exponent);
}

double product(double base_1, double exponent_1, double base_2, double exponent_2) {
  return power_product(base_1, log_or_zero(base_1), exponent_1, base_2, log_or_zero(base_2), exponent_2);
}

TEST(PowerFromLog, EqualsPow) {
  for (const double base : {1e-29, 1e-12, 0.01, 0.3, 0.999999, 1.0}) {
    for (const double exponent : {0.0, 1e-9, 0.5, 1.0, 5.0, 10.0}) {
      const double expected = std::pow(base, exponent);
      EXPECT_NEAR(power(base, exponent), expected, 1e-12 * expected) << base << "^" << exponent;
    }
  }
}

TEST(PowerFromLog, OfZeroIsOneForExponentZeroAndElseZero) {
  EXPECT_EQ(power(0.0, 0.0), 1.0);
  EXPECT_EQ(power(0.0, 1e-12), 0.0);
  EXPECT_EQ(power(0.0, 10.0), 0.0);
}

// Devices differ in what they do with numbers so small.
TEST(PowerFromLog, TakesBasesBelowTinyForZero) {
  EXPECT_EQ(power(0.9e-30, 0.01), 0.0);
  EXPECT_EQ(power(1e-40, 0.0), 1.0);
}

TEST(PowerFromLog, ClampsANegativeBaseAtZero) {
  EXPECT_EQ(power(-1e-17, 0.0), 1.0);
  EXPECT_EQ(power(-1e-17, 2.5), 0.0);
}

TEST(PowerProduct, IsTheProductOfThePowers) {
  for (const double a : {0.0, 1e-8, 0.2, 1.0}) {
    for (const double b : {0.0, 1e-8, 0.7, 1.0}) {
      for (const double n : {0.0, 0.4, 10.0}) {
        for (const double m : {0.0, 2.5, 10.0}) {
          const double expected = std::pow(a, n) * std::pow(b, m);
          EXPECT_NEAR(product(a, n, b, m), expected, 1e-12 * expected)
              << a << "^" << n << " " << b << "^" << m;
        }
      }
    }
  }
}

TEST(PowerProduct, LeavesOfOneAllDigitsWhereItIsCloseToOneInFloat) {
  for (const float distance : {1e-7F, 1e-4F, 0.03F, 0.3F, 0.7F, 0.99F}) {
    for (const float exponent : {0.0F, 1e-3F, 0.7F, 10.0F}) {
      const float base = 1.0F - distance;
      const float log_1 = accurate_log_or_zero(base, distance);
      const float power = power_product(base, log_1, exponent, 1.0F, 0.0F, 2.0F);
      const double expected = -std::expm1(exponent * std::log1p(-static_cast<double>(distance)));
      EXPECT_NEAR(one_minus_power_product(power, log_1, exponent, 0.0F, 2.0F), expected, 4e-7 * expected)
          << distance << " " << exponent;
    }
  }
}

TEST(PowerProduct, LeavesOfOneEverythingWhereABaseIsZero) {
  for (const double exponent : {0.0, 0.5, 10.0}) {
    const double power = product(0.0, exponent, 0.3, 1.0);
    EXPECT_DOUBLE_EQ(one_minus_power_product(power, log_or_zero(0.0), exponent, log_or_zero(0.3), 1.0),
                     1.0 - power);
  }
}

TEST(LerpReal, KeepsTheEndThatIsSmallBesideTheOther) {
  EXPECT_EQ(lerp_real(1e7F, 0.3F, 1.0F), 0.3F);
  EXPECT_EQ(lerp_real(0.3F, 1e7F, 0.0F), 0.3F);
  EXPECT_DOUBLE_EQ(lerp_real(2.0, 4.0, 0.25), 2.5);
}

TEST(AccurateDot, OfFloatsKeepsItsDigitsWhereTermsCancel) {
  const float x = 0.6F;
  const float y = 0.8F;
  const double expected = static_cast<double>(x) * y - static_cast<double>(y) * 0.6000001F;
  EXPECT_NEAR(accurate_dot(x, y, 0.0F, y, -0.6000001F, 0.5F), expected, 1e-7 * std::abs(expected));
}

TEST(SmoothstepFromZero, IsTheHermiteStep) {
  EXPECT_DOUBLE_EQ(smoothstep_from_zero(0.5, 0.25), 0.5);
  EXPECT_DOUBLE_EQ(smoothstep_from_zero(1.0, 0.25), 0.0625 * 2.5);
  EXPECT_EQ(smoothstep_from_zero(0.5, 0.5), 1.0);
  EXPECT_EQ(smoothstep_from_zero(0.5, 0.9), 1.0);
}

TEST(SmoothstepFromZero, OfZeroWidthIsOne) {
  for (const double x : {1e-300, 1e-9, 0.5, 1.0}) EXPECT_EQ(smoothstep_from_zero(0.0, x), 1.0) << x;
}

TEST(SmoothstepFromZero, NeverOvershootsForTheSmallestWidths) {
  for (const double edge : {1e-300, 5e-324}) EXPECT_EQ(smoothstep_from_zero(edge, 0.5), 1.0) << edge;
}

TEST(Clamp01, KeepsTheInsideAndStopsAtTheEnds) {
  EXPECT_EQ(clamp01(-0.5), 0.0);
  EXPECT_EQ(clamp01(0.0), 0.0);
  EXPECT_EQ(clamp01(0.25), 0.25);
  EXPECT_EQ(clamp01(1.0), 1.0);
  EXPECT_EQ(clamp01(1.5), 1.0);
}

}  // namespace
}  // namespace brdfit::kernel
