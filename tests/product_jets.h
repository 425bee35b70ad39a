// f cos_i and its derivatives by the product form, through ceres::Jet and the templated kernels: what the
// vectorised derivatives of fits are compared with.
#ifndef BRDFIT_TESTS_PRODUCT_JETS_H_
#define BRDFIT_TESTS_PRODUCT_JETS_H_

#include <ceres/jet.h>

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "measured/sampling.h"
#include "tests/product_eval.h"

namespace brdfit::testing_support {

// One channel's f cos_i in sr^-1, and its slope by every entry of the product form.
struct Sloped {
  double value = 0.0;
  Eigen::VectorXd slope;
};

// Observation k of a sample set as kernels see it, and the same with wi and wo exchanged.
inline kernel::Geometry<double> geometry_of(const SampleSet& samples, std::size_t k) {
  const simd::GeometryColumns columns = samples.geometry();
  kernel::Geometry<double> g = {};
  g.cos_i = columns.cos_i[k];
  g.cos_o = columns.cos_o[k];
  g.h_x = columns.sin_h[k];
  g.cos_h = columns.cos_h[k];
  g.cos_d = columns.cos_d[k];
  g.cos_k = kernel::cos_k_from_cos_d(g.cos_d);
  g.one_minus_cos_h = columns.one_minus_cos_h[k];
  g.one_minus_cos_d = columns.one_minus_cos_d[k];
  return g;
}

inline kernel::Geometry<double> swapped(kernel::Geometry<double> g) {
  std::swap(g.cos_i, g.cos_o);
  return g;
}

template <int N>
std::array<Sloped, 3> sloped_of_size(const Material& material, std::span<const double> q,
                                     const kernel::Geometry<double>& g) {
  using Jet = ceres::Jet<double, N>;
  std::array<Jet, N> variables;
  for (int k = 0; k < N; ++k) {
    variables[static_cast<std::size_t>(k)] = Jet(q[static_cast<std::size_t>(k)], k);
  }
  const auto jets =
      eval_product(material.model(), material.options(), material.effects(), variables.data(), g);
  std::array<Sloped, 3> result;
  for (std::size_t c = 0; c < 3; ++c) result[c] = {jets[c].a, jets[c].v};
  return result;
}

// At the product form q of a material whose model, options and effects are given.
inline std::array<Sloped, 3> sloped(const Material& material, std::span<const double> q,
                                    const kernel::Geometry<double>& g) {
  switch (material.model()) {
    case Model::kLambertGgx:
      return sloped_of_size<kLambertGgxProductSize>(material, q, g);
    case Model::kBurley:
      return sloped_of_size<kBurleyProductSize>(material, q, g);
    case Model::kCallisto:
      break;
  }
  return sloped_of_size<kCallistoProductSize>(material, q, g);
}

// The mean of f(wi, wo) and f(wo, wi), times cos_i: what a table's cell holds.
inline std::array<Sloped, 3> sloped_mean(const Material& material, std::span<const double> q,
                                         const kernel::Geometry<double>& g) {
  std::array<Sloped, 3> result = sloped(material, q, g);
  const std::array<Sloped, 3> back = sloped(material, q, swapped(g));
  for (std::size_t c = 0; c < 3; ++c) {
    result[c].value = 0.5 * (result[c].value + back[c].value * g.cos_i / g.cos_o);
    result[c].slope = 0.5 * (result[c].slope + back[c].slope * g.cos_i / g.cos_o);
  }
  return result;
}

}  // namespace brdfit::testing_support

#endif  // BRDFIT_TESTS_PRODUCT_JETS_H_
