// The microfacet distributions and masking: published forms, normalisation, limits.
#include "brdf/kernel/ggx.h"

#include <gtest/gtest.h>

#include "tests/reference_burley.h"

namespace brdfit::kernel {
namespace {

constexpr double kPi = std::numbers::pi;

// The integral over the hemisphere of f(theta) for a function of the polar angle alone, by the trapezium rule
// in log tan theta: exponentially accurate, however narrow the lobe at theta = 0.
template <class F>
double integrate_polar(const F& f) {
  constexpr double kStep = 1.0 / 64;
  double sum = 0.0;
  for (double x = -40.0; x <= 40.0; x += kStep) {
    const double theta = std::atan(std::exp(x));
    const double sine = std::exp(x) * std::cos(theta);
    sum += f(sine, 1.0 / std::hypot(1.0, std::exp(x))) * sine * (sine * std::cos(theta)) * kStep;
  }
  return 2.0 * kPi * sum;
}

// The same for any function of the direction.
template <class F>
double integrate(const F& f) {
  constexpr int kAzimuths = 256;
  double sum = 0.0;
  for (int k = 0; k < kAzimuths; ++k) {
    const double phi = 2.0 * kPi * (k + 0.5) / kAzimuths;
    sum += integrate_polar(
        [&](double sine, double cosine) { return f(sine * std::cos(phi), sine * std::sin(phi), cosine); });
  }
  return sum / kAzimuths;
}

TEST(GgxD, EqualsTheFormWalterPublished) {
  for (const double alpha : {0.01, 0.1, 0.5, 1.0}) {
    for (const double theta : {0.0, 0.02, 0.3, 1.0, 1.5}) {
      const double tan_squared = std::pow(std::tan(theta), 2);
      const double a2 = alpha * alpha;
      const double expected = a2 / (kPi * std::pow(std::cos(theta), 4) * std::pow(a2 + tan_squared, 2));
      EXPECT_NEAR(ggx_d(alpha, std::pow(std::sin(theta), 2), std::cos(theta)), expected, 1e-13 * expected);
    }
  }
}

TEST(GgxD, EqualsThePublishedFormulas) {
  for (const double alpha : {1e-4, 0.01, 0.3, 1.0}) {
    for (const double theta : {0.0, 1e-4, 0.02, 0.3, 1.0, 1.5}) {
      const auto expected = static_cast<double>(reference::ggx_d(alpha, std::cos(reference::Number(theta))));
      EXPECT_NEAR(ggx_d(alpha, std::pow(std::sin(theta), 2), std::cos(theta)), expected, 1e-11 * expected);
    }
  }
}

TEST(GgxD, IsNormalised) {
  for (const double alpha : {1e-4, 0.01, 0.1, 0.5, 1.0}) {
    const double area = integrate_polar(
        [&](double sine, double cosine) { return ggx_d(alpha, sine * sine, cosine) * cosine; });
    EXPECT_NEAR(area, 1.0, 1e-12) << "alpha " << alpha;
  }
}

TEST(GgxDAnisotropic, IsNormalised) {
  for (const double alpha_x : {0.1, 0.5, 1.0}) {
    for (const double alpha_y : {0.2, 0.3}) {
      const double area = integrate(
          [&](double x, double y, double z) { return ggx_d_anisotropic(alpha_x, alpha_y, x, y, z) * z; });
      EXPECT_NEAR(area, 1.0, 1e-10) << alpha_x << " " << alpha_y;
    }
  }
}

TEST(GgxDAnisotropic, WithEqualAlphasIsIsotropic) {
  for (const double alpha : {0.001, 0.2, 1.0}) {
    const double isotropic = ggx_d(alpha, 0.09 + 0.16, std::sqrt(0.75));
    EXPECT_NEAR(ggx_d_anisotropic(alpha, alpha, 0.3, 0.4, std::sqrt(0.75)), isotropic, 1e-13 * isotropic);
  }
}

TEST(Gtr1D, IsNormalised) {
  for (const double alpha : {0.001, 0.03, 0.1, 0.9}) {
    const double area = integrate_polar(
        [&](double sine, double cosine) { return gtr1_d(alpha, sine * sine, cosine) * cosine; });
    EXPECT_NEAR(area, 1.0, 1e-12) << "alpha " << alpha;
  }
}

TEST(Gtr1D, EqualsThePublishedFormulas) {
  for (const double alpha : {0.001, 0.01, 0.1, 0.9, 1.0, 2.0}) {
    for (const double theta : {0.0, 0.01, 0.5, 1.5}) {
      const auto expected = static_cast<double>(reference::gtr1_d(alpha, std::cos(reference::Number(theta))));
      EXPECT_NEAR(gtr1_d(alpha, std::pow(std::sin(theta), 2), std::cos(theta)), expected, 1e-12 * expected);
    }
  }
}

TEST(Gtr1D, ReachesOneOverPiContinuously) {
  EXPECT_NEAR(gtr1_d(1.0 - 1e-9, 0.4, std::sqrt(0.6)), 1.0 / kPi, 1e-8);
  EXPECT_EQ(gtr1_d(1.0, 0.4, std::sqrt(0.6)), BRDF_INV_PI);
  EXPECT_EQ(gtr1_d(7.0, 0.4, std::sqrt(0.6)), BRDF_INV_PI);
}

TEST(GgxV, EqualsSmithAsHeitzWritesIt) {
  for (const double alpha : {1e-4, 0.01, 0.3, 1.0}) {
    for (const double cos_i : {1e-9, 0.01, 0.5, 1.0}) {
      for (const double cos_o : {1e-6, 0.2, 1.0}) {
        for (const Masking masking : {Masking::kSeparable, Masking::kCorrelated}) {
          const auto expected = static_cast<double>(reference::ggx_v(alpha, cos_i, cos_o, masking));
          EXPECT_NEAR(ggx_v(alpha, cos_i, cos_o, static_cast<int>(masking)), expected, 1e-13 * expected)
              << alpha << " " << cos_i << " " << cos_o << " " << name_of(masking);
        }
      }
    }
  }
}

// V grows as 1 / cosine, and times cos_i it has a limit there: nothing may cut it off above the horizon.
TEST(GgxV, EqualsSmithDownToTheHorizonInDoubleAndFloat) {
  for (const double alpha : {1e-4, 0.3, 1.0}) {
    for (const double cosine : {1.01 * BRDF_HORIZON, 1e-20, 1e-6}) {
      const auto expected =
          static_cast<double>(reference::ggx_v(alpha, cosine, cosine, Masking::kCorrelated));
      EXPECT_NEAR(ggx_v(alpha, cosine, cosine, BRDF_MASKING_CORRELATED), expected, 1e-13 * expected);
      const auto single = static_cast<float>(cosine);
      const auto v = ggx_v(static_cast<float>(alpha), single, single, BRDF_MASKING_CORRELATED);
      EXPECT_NEAR(static_cast<double>(v), expected, 1e-6 * expected) << alpha << " " << cosine;
    }
  }
}

TEST(GgxV, OfCorrelatedHeightsIsNeverBelowTheSeparableForm) {
  for (const double cos_i : {0.01, 0.3, 1.0}) {
    for (const double cos_o : {0.05, 0.6}) {
      EXPECT_GE(ggx_v(0.4, cos_i, cos_o, BRDF_MASKING_CORRELATED),
                ggx_v(0.4, cos_i, cos_o, BRDF_MASKING_SEPARABLE));
    }
  }
}

// Heitz 2014, eq. 14: the visible facets cover what the surface covers, cos_o = integral of G1 <wo.h> D.
TEST(SmithShare, MasksWhatTheDistributionHides) {
  for (const double alpha : {0.3, 0.8}) {
    for (const double cos_o : {0.2, 0.7, 1.0}) {
      const double sin_o = std::sqrt(1.0 - cos_o * cos_o);
      const double g1 = 2.0 * cos_o * smith_share(alpha, cos_o);
      const double covered = integrate([&](double x, double, double z) {
        const double facing = x * sin_o + z * cos_o;
        return facing > 0.0 ? g1 * facing * ggx_d(alpha, 1.0 - z * z, z) : 0.0;
      });
      EXPECT_NEAR(covered, cos_o, 1e-5) << alpha << " " << cos_o;
    }
  }
}

TEST(SmithShareAnisotropic, MasksWhatTheDistributionHides) {
  constexpr double kAlphaX = 0.7;
  constexpr double kAlphaY = 0.3;
  for (const double phi : {0.0, 0.6, kPi / 2}) {
    const double cos_o = 0.3;
    const double sin_o = std::sqrt(1.0 - cos_o * cos_o);
    const double o_x = sin_o * std::cos(phi);
    const double o_y = sin_o * std::sin(phi);
    const double g1 = 2.0 * cos_o * smith_share_anisotropic(kAlphaX, kAlphaY, o_x, o_y, cos_o);
    const double covered = integrate([&](double x, double y, double z) {
      const double facing = x * o_x + y * o_y + z * cos_o;
      return facing > 0.0 ? g1 * facing * ggx_d_anisotropic(kAlphaX, kAlphaY, x, y, z) : 0.0;
    });
    EXPECT_NEAR(covered, cos_o, 1e-5) << phi;
  }
}

TEST(SmithShareAnisotropic, WithEqualAlphasIsIsotropic) {
  for (const double alpha : {0.01, 0.5, 1.0}) {
    EXPECT_NEAR(smith_share_anisotropic(alpha, alpha, 0.48, 0.64, 0.6), smith_share(alpha, 0.6), 1e-14);
  }
}

}  // namespace
}  // namespace brdfit::kernel
