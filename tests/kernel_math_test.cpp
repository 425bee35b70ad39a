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
  for (const double base : {1e-300, 1e-12, 0.01, 0.3, 0.999999, 1.0}) {
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
