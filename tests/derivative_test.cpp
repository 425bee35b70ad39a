// Derivatives that automatic differentiation takes from the kernels, against differences, and their
// finiteness on the closed domain.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "tests/product_eval.h"
#include "tests/random_parameters.h"

namespace brdfit {
namespace {

using testing_support::Pair;
using testing_support::Random;
using Number = long double;

// A model with its options and effects, at one geometry.
struct Setting {
  Model model;
  MaterialOptions options;
  Effects effects;
  kernel::Geometry<double> geometry;
};

template <class T>
std::array<T, 3> evaluate(const Setting& s, const std::vector<T>& q) {
  return testing_support::eval_product(s.model, s.options, s.effects, q.data(), s.geometry);
}

template <int N>
std::array<ceres::Jet<double, N>, 3> jets_of(const Setting& s, const std::vector<double>& q) {
  std::vector<ceres::Jet<double, N>> variables;
  for (int k = 0; k < N; ++k) variables.emplace_back(q[static_cast<std::size_t>(k)], k);
  return evaluate(s, variables);
}

// d f_c / d q_k by differences of fourth order in extended precision: central where side is 0, else one-sided
// towards the sign of side.
std::array<Number, 3> difference(const Setting& s, const std::vector<double>& q, std::size_t k, double step,
                                 int side) {
  const std::vector<Number> exact(q.begin(), q.end());
  const auto at = [&](int steps) {
    std::vector<Number> moved = exact;
    moved[k] += Number(step) * steps;
    return evaluate(s, moved);
  };
  struct Tap {
    int steps;
    Number weight;
  };
  const std::vector<Tap> central = {{-2, 1}, {-1, -8}, {1, 8}, {2, -1}};
  const std::vector<Tap> one_sided = {{0, -25}, {side, 48}, {2 * side, -36}, {3 * side, 16}, {4 * side, -3}};
  std::array<Number, 3> sum = {0, 0, 0};
  for (const Tap& tap : side == 0 ? central : one_sided) {
    const auto f = at(tap.steps);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += tap.weight * f[c];
  }
  for (Number& x : sum) x /= 12 * Number(step) * (side == 0 ? 1 : side);
  return sum;
}

std::string what(const Setting& s, std::size_t k) {
  const ProductEntry entry = product_layout(s.model)[k];
  return std::string(name_of(s.model)) + ", d/d " + std::string(entry.parameter) + "[" +
         std::to_string(entry.channel) + "], effects " + std::to_string(s.effects.bits());
}

template <int N>
void expect_derivative(const Setting& s, const std::vector<double>& q, std::size_t k, int side) {
  const bool is_roughness = product_layout(s.model)[k].parameter == "roughness";
  const double step = 1e-5 * (is_roughness ? q[k] : std::max(1.0, std::abs(q[k])));
  const auto expected = difference(s, q, k, step, side);
  const auto actual = jets_of<N>(s, q);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto slope = static_cast<double>(expected[c]);
    ASSERT_NEAR(actual[c].v[static_cast<Eigen::Index>(k)], slope,
                1e-8 * (std::abs(slope) + std::abs(actual[c].a)))
        << what(s, k) << " = " << q[k] << ", side " << side;
  }
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
        kernel::Geometry<double> g{};
        g.cos_i = cosine;
        g.cos_o = cosine;
        g.wi_x = 1.0 - cosine;
        g.wo_x = 1.0 - cosine;
        g.cos_h = cos_h;
        g.h_x = 1.0 - cos_h;
        g.cos_d = cos_d;
        g.cos_k = kernel::cos_k_from_cos_d(cos_d);
        g.one_minus_cos_h = 1.0 - cos_h;
        g.one_minus_cos_d = 1.0 - cos_d;
        result.push_back(g);
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

TEST(Derivatives, OfZeroToTheZeroIsZero) {
  using Jet = ceres::Jet<double, 1>;
  const Jet power = kernel::power_from_log(0.0, kernel::log_or_zero(0.0), Jet(0.0, 0));
  EXPECT_EQ(power.a, 1.0);
  EXPECT_EQ(power.v[0], 0.0);
}

}  // namespace
}  // namespace brdfit
