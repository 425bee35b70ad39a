// Derivatives of models by their product form: what automatic differentiation takes from the kernels, and
// differences to compare it with.
#ifndef BRDFIT_TESTS_SLOPE_DIFFERENCES_H_
#define BRDFIT_TESTS_SLOPE_DIFFERENCES_H_

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/product_eval.h"

namespace brdfit::testing_support {

// A model with its options and effects, at one geometry.
struct Setting {
  Model model;
  MaterialOptions options;
  Effects effects;
  kernel::Geometry<double> geometry;
};

template <class T>
std::array<T, 3> evaluate(const Setting& s, const std::vector<T>& q) {
  return eval_product(s.model, s.options, s.effects, q.data(), s.geometry);
}

template <int N>
std::array<ceres::Jet<double, N>, 3> jets_of(const Setting& s, const std::vector<double>& q) {
  std::vector<ceres::Jet<double, N>> variables;
  for (int k = 0; k < N; ++k) variables.emplace_back(q[static_cast<std::size_t>(k)], k);
  return evaluate(s, variables);
}

// d f_c / d q_k by differences of fourth order in extended precision: central where side is 0, else one-sided
// towards the sign of side.
inline std::array<long double, 3> difference(const Setting& s, const std::vector<double>& q, std::size_t k,
                                             double step, int side) {
  using Number = long double;
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

inline std::string describe_slope(const Setting& s, std::size_t k) {
  const ProductEntry entry = product_layout(s.model)[k];
  return std::string(name_of(s.model)) + ", d/d " + std::string(entry.parameter) + "[" +
         std::to_string(entry.channel) + "], effects " + std::to_string(s.effects.bits()) + ", cos_i " +
         std::to_string(s.geometry.cos_i) + ", cos_o " + std::to_string(s.geometry.cos_o) + ", cos_h " +
         std::to_string(s.geometry.cos_h) + ", cos_d " + std::to_string(s.geometry.cos_d);
}

// jets: those of the setting at q. rounding: of the difference, where it is one of large terms.
template <int N>
void expect_slope(const Setting& s, const std::vector<double>& q,
                  const std::array<ceres::Jet<double, N>, 3>& jets, std::size_t k, int side,
                  double rounding = 0.0) {
  const bool is_roughness = product_layout(s.model)[k].parameter == "roughness";
  const double step = 1e-5 * (is_roughness ? q[k] : std::max(1.0, std::abs(q[k])));
  const auto expected = difference(s, q, k, step, side);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto slope = static_cast<double>(expected[c]);
    ASSERT_NEAR(jets[c].v[static_cast<Eigen::Index>(k)], slope,
                1e-8 * (std::abs(slope) + std::abs(jets[c].a)) + rounding)
        << describe_slope(s, k) << " = " << q[k] << ", side " << side;
  }
}

// Geometry of cosines that no pair of rounded directions may have: h at azimuth 0.
inline kernel::Geometry<double> exact_geometry(double cos_h, double cos_d, double cos_i, double cos_o) {
  kernel::Geometry<double> g{};
  g.cos_i = cos_i;
  g.cos_o = cos_o;
  g.wi_x = std::sqrt(1.0 - cos_i * cos_i);
  g.wo_x = std::sqrt(1.0 - cos_o * cos_o);
  g.cos_h = cos_h;
  g.h_x = std::sqrt(1.0 - cos_h * cos_h);
  g.cos_d = cos_d;
  g.cos_k = kernel::cos_k_from_cos_d(cos_d);
  g.one_minus_cos_h = 1.0 - cos_h;
  g.one_minus_cos_d = 1.0 - cos_d;
  return g;
}

}  // namespace brdfit::testing_support

#endif  // BRDFIT_TESTS_SLOPE_DIFFERENCES_H_
