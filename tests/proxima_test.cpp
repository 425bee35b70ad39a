// Proxima against the published formulas and against the integral that it approximates.
#include "brdf/kernel/proxima.h"

#include "tests/model_matchers.h"

namespace brdfit {
namespace {

using testing_support::Pair;
using testing_support::Random;

constexpr double kPi = std::numbers::pi;
constexpr MaterialOptions kProxima = {.diffuse = Diffuse::kProxima};
constexpr MaterialOptions kProximaCorrelated = {.masking = Masking::kCorrelated,
                                                .diffuse = Diffuse::kProxima};

double proxima(double alpha, double cos_i, double cos_d) {
  return kernel::proxima_eval_cos(alpha, cos_i, cos_d, kernel::cos_k_from_cos_d(cos_d));
}

TEST(Proxima, EqualsThePublishedFormulasInLambertGgx) {
  testing_support::expect_equals_reference(Model::kLambertGgx, kProxima, 1e-12);
}

TEST(Proxima, EqualsThePublishedFormulasInCallisto) {
  testing_support::expect_equals_reference(Model::kCallisto, kProxima, 1e-12);
  testing_support::expect_equals_reference(Model::kCallisto, kProximaCorrelated, 1e-12);
}

TEST(Proxima, IsDarkBelowTheHorizon) {
  testing_support::expect_dark_below_horizon(Model::kCallisto, kProxima);
}

TEST(Proxima, IsNotReciprocal) {
  const Pair pair = testing_support::pair_at(0.5, 0.5, 0.0);
  for (const Model model : {Model::kLambertGgx, Model::kCallisto}) {
    Material material(model);
    EXPECT_TRUE(is_reciprocal(material));
    material.options() = kProxima;
    EXPECT_FALSE(is_reciprocal(material));
    EXPECT_GT(std::abs(eval(material, pair.wi, pair.wo)[0] - eval(material, pair.wo, pair.wi)[0]), 1e-3);
  }
}

TEST(Proxima, OfASmoothSurfaceIsLambert) {
  for (const double cos_i : {0.0, 0.1, 0.5, 1.0}) {
    EXPECT_DOUBLE_EQ(proxima(0.0, cos_i, 0.9), cos_i / kPi);
  }
}

TEST(Proxima, TimesTheCosineStaysBoundedAndNotNegativeToTheHorizon) {
  for (const double alpha : {1e-4, 0.5, 1.0}) {
    for (double cos_i = 0.0; cos_i <= 1.0; cos_i += 1.0 / 64) {
      for (double cos_d = 0.0; cos_d <= 1.0; cos_d += 1.0 / 64) {
        const double value = proxima(alpha, cos_i, cos_d);
        EXPECT_GE(value, 0.0);
        EXPECT_LE(value, 1.0 / kPi + 0.19 / kPi);
      }
    }
  }
}

TEST(Proxima, HasNoExcessWhereTheDirectionsAreOpposite) {
  EXPECT_EQ(kernel::proxima_excess(0.3, 0.0, 1.0), 0.0);
}

// f cos_i of Lambertian facets without masking (Heitz 2014): the integral of <wi.m> <wo.m> D / (pi cos_o).
double facets_eval_cos(double alpha, const Pair& pair) {
  constexpr int kPolar = 400;
  constexpr int kAzimuth = 200;
  double sum = 0.0;
  for (int i = 0; i < kPolar; ++i) {
    // Facets drawn from D cos: tan^2 = alpha^2 u / (1 - u).
    const double u = (i + 0.5) / kPolar;
    const double theta = std::atan(alpha * std::sqrt(u / (1.0 - u)));
    for (int k = 0; k < kAzimuth; ++k) {
      const Vec3 m = testing_support::direction(theta, 2 * kPi * (k + 0.5) / kAzimuth);
      const double in = pair.wi.x * m.x + pair.wi.y * m.y + pair.wi.z * m.z;
      const double out = pair.wo.x * m.x + pair.wo.y * m.y + pair.wo.z * m.z;
      sum += std::max(in, 0.0) * std::max(out, 0.0) / m.z;
    }
  }
  return sum / (kPolar * kAzimuth * kPi * pair.wo.z);
}

TEST(Proxima, HalvesTheSquaredErrorOfLambertAgainstTheFacetIntegral) {
  Random random(11);
  for (const double alpha : {0.25, 0.5, 1.0}) {
    double proxima_error = 0.0;
    double lambert_error = 0.0;
    for (int k = 0; k < 200; ++k) {
      const Pair pair = {testing_support::random_direction(random),
                         testing_support::direction(testing_support::uniform(random, 0.0, 1.0), 0.0)};
      const double expected = facets_eval_cos(alpha, pair);
      const auto g = reference::geometry(pair.wi, pair.wo);
      const double value = proxima(alpha, pair.wi.z, static_cast<double>(g.cos_d));
      proxima_error += std::pow(value - expected, 2);
      lambert_error += std::pow(pair.wi.z / kPi - expected, 2);
    }
    EXPECT_LT(proxima_error, 0.5 * lambert_error) << alpha;
  }
}

}  // namespace
}  // namespace brdfit
