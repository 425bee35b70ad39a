// Models as functions of their product form, for any parameter and geometry type.
#ifndef BRDFIT_TESTS_PRODUCT_EVAL_H_
#define BRDFIT_TESTS_PRODUCT_EVAL_H_

#include <array>

#include "brdf/coefficients.h"
#include "tests/direction_pairs.h"

namespace brdfit::testing_support {

template <class G = double>
kernel::Geometry<G> kernel_geometry(const Pair& pair) {
  const auto as = [](double x) { return static_cast<G>(x); };
  return kernel::geometry_from_directions(as(pair.wi.x), as(pair.wi.y), as(pair.wi.z), as(pair.wo.x),
                                          as(pair.wo.y), as(pair.wo.z));
}

template <class Coefs, class Terms, class G, class Combine>
auto combine_channels(const Coefs& k, const Terms& terms, const kernel::Geometry<G>& g,
                      const Combine& combine) {
  std::array<decltype(combine(k.colour[0], terms)), 3> result;
  for (std::size_t c = 0; c < 3; ++c) {
    result[c] = kernel::above_horizon(combine(k.colour[c], terms), g.cos_i, g.cos_o);
  }
  return result;
}

// f cos_i per channel from a model's coefficients.
template <class T, class G>
std::array<T, 3> eval_coefficients(const LambertGgxCoefficients<T>& k, const MaterialOptions& options,
                                   Effects, const kernel::Geometry<G>& g, const kernel::GeometryLogs<G>&) {
  const auto terms = kernel::lambert_ggx_terms(k.shape, g, static_cast<int>(options.masking),
                                               static_cast<int>(options.diffuse));
  return combine_channels(k, terms, g,
                          [](const auto& c, const auto& t) { return kernel::lambert_ggx_combine(c, t); });
}

template <class T, class G>
std::array<T, 3> eval_coefficients(const BurleyCoefficients<T>& k, const MaterialOptions& options,
                                   Effects effects, const kernel::Geometry<G>& g,
                                   const kernel::GeometryLogs<G>&) {
  const auto terms =
      kernel::burley_terms(k.shape, g, static_cast<int>(options.burley_g), static_cast<int>(effects.bits()));
  return combine_channels(k, terms, g,
                          [](const auto& c, const auto& t) { return kernel::burley_combine(c, t); });
}

template <class T, class G>
std::array<T, 3> eval_coefficients(const CallistoCoefficients<T>& k, const MaterialOptions& options,
                                   Effects effects, const kernel::Geometry<G>& g,
                                   const kernel::GeometryLogs<G>& logs) {
  const auto terms =
      kernel::callisto_terms(k.shape, g, logs, static_cast<int>(options.masking),
                             static_cast<int>(options.diffuse), static_cast<int>(effects.bits()));
  return combine_channels(k, terms, g,
                          [](const auto& c, const auto& t) { return kernel::callisto_combine(c, t); });
}

// f cos_i per channel; q as product_layout(model) says.
template <class T, class G>
std::array<T, 3> eval_product(Model model, const MaterialOptions& options, Effects effects, const T* q,
                              const kernel::Geometry<G>& g) {
  const auto logs = kernel::geometry_logs(g);
  switch (model) {
    case Model::kLambertGgx:
      return eval_coefficients(lambert_ggx_coefficients(q), options, effects, g, logs);
    case Model::kBurley:
      return eval_coefficients(burley_coefficients(q, static_cast<int>(effects.bits())), options, effects, g,
                               logs);
    case Model::kCallisto:
      break;
  }
  return eval_coefficients(callisto_coefficients(q), options, effects, g, logs);
}

}  // namespace brdfit::testing_support

#endif  // BRDFIT_TESTS_PRODUCT_EVAL_H_
