// Derivatives that automatic differentiation takes from the kernels, against differences, and their
// finiteness on the closed domain.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "tests/random_parameters.h"
#include "tests/slope_differences.h"

namespace brdfit {
namespace {

using testing_support::jets_of;
using testing_support::Pair;
using testing_support::Random;
using testing_support::Setting;

template <int N>
void expect_derivative(const Setting& s, const std::vector<double>& q, std::size_t k, int side) {
  testing_support::expect_slope<N>(s, q, jets_of<N>(s, q), k, side);
}

// Every entry of the product form, at random interior parameters.
template <int N>
void expect_interior_derivatives(Model model, const MaterialOptions& options) {
  Random random(31);
  for (unsigned index = 0; index < 64; ++index) {
    const Effects effects = index < 32 ? effects_of(model) : testing_support::effect_subset(model, index);
    const std::vector<double> q = product_form(testing_support::interior_material(model, effects, random));
    for (const Pair& pair : testing_support::random_pairs(10, random)) {
      const Setting setting = {model, options, effects, testing_support::kernel_geometry(pair)};
      for (std::size_t k = 0; k < N; ++k) {
        expect_derivative<N>(setting, q, k, 0);
        if (testing::Test::HasFatalFailure()) return;
      }
    }
  }
}

// Every entry at both ends of its range, the others inside: the derivative is the one towards the inside, so
// that an optimiser can leave a bound.
template <int N>
void expect_derivatives_at_bounds(Model model, const MaterialOptions& options) {
  Random random(32);
  const auto layout = product_layout(model);
  for (int repeat = 0; repeat < 10; ++repeat) {
    const Effects effects = effects_of(model);
    const std::vector<double> interior =
        product_form(testing_support::interior_material(model, effects, random));
    for (const Pair& pair : testing_support::random_pairs(10, random)) {
      const Setting setting = {model, options, effects, testing_support::kernel_geometry(pair)};
      for (std::size_t k = 0; k < N; ++k) {
        const ParameterInfo& info = *find_parameter(model, layout[k].parameter);
        for (const int side : {1, -1}) {
          std::vector<double> q = interior;
          q[k] = side > 0 ? info.lower : info.upper;
          expect_derivative<N>(setting, q, k, side);
          if (testing::Test::HasFatalFailure()) return;
        }
      }
    }
  }
}

// Geometry with cosines of exactly 0 and 1, which no pair of rounded directions may have.
std::vector<kernel::Geometry<double>> exact_geometries() {
  std::vector<kernel::Geometry<double>> result;
  for (const double cos_h : {0.0, 1.0}) {
    for (const double cos_d : {0.0, 1.0}) {
      for (const double cosine : {1e-300, 1.0}) {
        result.push_back(testing_support::exact_geometry(cos_h, cos_d, cosine, cosine));
      }
    }
  }
  for (const Pair& pair : testing_support::adversarial_pairs()) {
    result.push_back(testing_support::kernel_geometry(pair));
  }
  return result;
}

// Every parameter at one of its ends, for many choices of ends.
template <int N>
void expect_finite_in_corners(Model model, const MaterialOptions& options) {
  Random random(33);
  const auto layout = product_layout(model);
  for (int repeat = 0; repeat < 300; ++repeat) {
    std::vector<double> q;
    for (const ProductEntry& entry : layout) {
      const ParameterInfo& info = *find_parameter(model, entry.parameter);
      q.push_back(random() % 2 == 0 ? info.lower : info.upper);
    }
    for (const auto& geometry : exact_geometries()) {
      const auto f = jets_of<N>({model, options, effects_of(model), geometry}, q);
      for (const auto& channel : f) {
        ASSERT_TRUE(std::isfinite(channel.a)) << name_of(model) << " " << repeat;
        ASSERT_TRUE(channel.v.allFinite()) << name_of(model) << " " << repeat;
      }
    }
  }
}

constexpr MaterialOptions kDefault = {};
constexpr MaterialOptions kOther = {
    .masking = Masking::kCorrelated, .burley_g = BurleyG::k2017, .diffuse = Diffuse::kProxima};

TEST(Derivatives, OfLambertGgxEqualDifferences) {
  expect_interior_derivatives<kLambertGgxProductSize>(Model::kLambertGgx, kDefault);
  expect_interior_derivatives<kLambertGgxProductSize>(Model::kLambertGgx, kOther);
}

TEST(Derivatives, OfBurleyEqualDifferences) {
  expect_interior_derivatives<kBurleyProductSize>(Model::kBurley, kDefault);
  expect_interior_derivatives<kBurleyProductSize>(Model::kBurley, kOther);
}

TEST(Derivatives, OfCallistoEqualDifferences) {
  expect_interior_derivatives<kCallistoProductSize>(Model::kCallisto, kDefault);
  expect_interior_derivatives<kCallistoProductSize>(Model::kCallisto, kOther);
}

TEST(DerivativesAtBounds, OfLambertGgxPointInside) {
  expect_derivatives_at_bounds<kLambertGgxProductSize>(Model::kLambertGgx, kDefault);
  expect_derivatives_at_bounds<kLambertGgxProductSize>(Model::kLambertGgx, kOther);
}

TEST(DerivativesAtBounds, OfBurleyPointInside) {
  expect_derivatives_at_bounds<kBurleyProductSize>(Model::kBurley, kDefault);
  expect_derivatives_at_bounds<kBurleyProductSize>(Model::kBurley, kOther);
}

TEST(DerivativesAtBounds, OfCallistoPointInside) {
  expect_derivatives_at_bounds<kCallistoProductSize>(Model::kCallisto, kDefault);
  expect_derivatives_at_bounds<kCallistoProductSize>(Model::kCallisto, kOther);
}

TEST(DerivativesInCorners, OfLambertGgxAreFinite) {
  expect_finite_in_corners<kLambertGgxProductSize>(Model::kLambertGgx, kDefault);
  expect_finite_in_corners<kLambertGgxProductSize>(Model::kLambertGgx, kOther);
}

TEST(DerivativesInCorners, OfBurleyAreFinite) {
  expect_finite_in_corners<kBurleyProductSize>(Model::kBurley, kDefault);
  expect_finite_in_corners<kBurleyProductSize>(Model::kBurley, kOther);
}

TEST(DerivativesInCorners, OfCallistoAreFinite) {
  expect_finite_in_corners<kCallistoProductSize>(Model::kCallisto, kDefault);
  expect_finite_in_corners<kCallistoProductSize>(Model::kCallisto, kOther);
}

// A tint divides by the luminance.
TEST(Derivatives, OfTintsAreFiniteForTheDarkestColours) {
  using Jet = ceres::Jet<double, 1>;
  for (const double dark : {5e-324, 1e-310, 1e-200, 1e-40, 1e-25, 0.0}) {
    const Jet base(dark, 0);
    const Jet tint = kernel::burley_tint(base, base * 0.3);
    EXPECT_TRUE(std::isfinite(tint.a)) << dark;
    EXPECT_TRUE(std::isfinite(tint.v[0])) << dark;
    EXPECT_NEAR(tint.a, dark * 0.3 > BRDF_TINY ? 1.0 / 0.3 : 1.0, 1e-12) << dark;
  }
}

TEST(Derivatives, OfZeroToTheZeroIsZero) {
  using Jet = ceres::Jet<double, 1>;
  const Jet power = kernel::power_from_log(0.0, kernel::log_or_zero(0.0), Jet(0.0, 0));
  EXPECT_EQ(power.a, 1.0);
  EXPECT_EQ(power.v[0], 0.0);
}

}  // namespace
}  // namespace brdfit
