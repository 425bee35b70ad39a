// Fresnel: Schlick, f0 of the metallic workflow, Callisto's falloff.
#include "brdf/kernel/fresnel.h"

#include <gtest/gtest.h>

#include "brdf/kernel/callisto.h"

namespace brdfit::kernel {
namespace {

double callisto_falloff(double n_s, double one_minus_cos_d) {
  return callisto_specular_falloff(n_s, one_minus_cos_d, log_or_zero(one_minus_cos_d));
}

TEST(SchlickFalloff, IsTheFifthPowerOfOneMinusCosD) {
  for (const double theta_d : {0.0, 0.3, 1.0, 1.5}) {
    const auto g = geometry_from_directions(std::sin(theta_d), 0.0, std::cos(theta_d), -std::sin(theta_d),
                                            0.0, std::cos(theta_d));
    EXPECT_NEAR(schlick_falloff(g), std::pow(1.0 - std::cos(theta_d), 5), 1e-15);
  }
}

TEST(Fresnel, GoesFromF0ToWhite) {
  EXPECT_EQ(fresnel(0.04, 0.0), 0.04);
  EXPECT_DOUBLE_EQ(fresnel(0.04, 1.0), 1.0);
  EXPECT_DOUBLE_EQ(fresnel(0.04, 0.25), 0.04 + 0.96 * 0.25);
}

TEST(MetallicF0, BlendsTheDielectricWithTheBaseColour) {
  EXPECT_DOUBLE_EQ(metallic_f0(0.9, 0.0, 0.5), 0.04);
  EXPECT_DOUBLE_EQ(metallic_f0(0.9, 1.0, 0.5), 0.9);
  EXPECT_DOUBLE_EQ(metallic_f0(0.9, 0.25, 1.0), 0.75 * 0.08 + 0.25 * 0.9);
}

TEST(CallistoFresnel, AtOneHalfIsSchlick) {
  for (const double u : {0.0, 1e-9, 0.1, 0.5, 0.99, 1.0}) {
    EXPECT_NEAR(callisto_falloff(0.5, u), std::pow(u, 5), 1e-13 * std::pow(u, 5)) << u;
  }
}

TEST(CallistoFresnel, AtZeroIsRemoved) {
  for (const double u : {0.0, 0.1, 0.9, 1.0}) EXPECT_EQ(callisto_falloff(0.0, u), 0.0) << u;
}

TEST(CallistoFresnel, AtOneIsWhiteAtEveryAngle) {
  for (const double u : {0.0, 1e-300, 0.1, 1.0}) EXPECT_EQ(callisto_falloff(1.0, u), 1.0) << u;
}

TEST(CallistoFresnel, EqualsThePublishedFormulas) {
  for (const double n_s : {0.01, 0.2, 0.4999, 0.51, 0.8, 0.99}) {
    for (const double u : {1e-6, 0.2, 0.8, 1.0}) {
      const double r = 2.0 * (1.0 - n_s);
      const double expected = std::min(1.0, 2.0 - r) * std::pow(u, 5.0 * r);
      EXPECT_NEAR(callisto_falloff(n_s, u), expected, 1e-12 * expected) << n_s << " " << u;
    }
  }
}

TEST(CallistoFresnel, GrowsWithTheParameter) {
  double before = 0.0;
  for (double n_s = 0.05; n_s <= 1.0; n_s += 0.05) {
    const double now = callisto_falloff(n_s, 0.6);
    EXPECT_GT(now, before) << n_s;
    before = now;
  }
}

}  // namespace
}  // namespace brdfit::kernel
