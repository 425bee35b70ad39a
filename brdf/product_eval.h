// Models as functions of their coefficients or of their product form, for any type of parameters and of
// directions: what the scalar forms in double, float and Jets share.
#ifndef BRDFIT_BRDF_PRODUCT_EVAL_H_
#define BRDFIT_BRDF_PRODUCT_EVAL_H_

#include <array>

#include "brdf/coefficients.h"

namespace brdfit {

// combine(colour, terms) of the three channels, 0 below the horizon.
template <class Coefs, class Terms, class G, class Combine>
auto combine_channels(const Coefs& k, const Terms& terms, const kernel::Geometry<G>& g,
                      const Combine& combine) {
  std::array<decltype(combine(k.colour[0], terms)), 3> result;
  for (std::size_t c = 0; c < 3; ++c) {
    result[c] = kernel::above_horizon(combine(k.colour[c], terms), g.cos_i, g.cos_o);
  }
  return result;
}

// f cos_i in sr^-1 per channel from a model's coefficients. Only Callisto looks at the logs.
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

// As above, with the logs taken where an effect needs them.
template <template <class> class Coefs, class T, class G>
std::array<T, 3> eval_coefficients(const Coefs<T>& k, const MaterialOptions& options, Effects effects,
                                   const kernel::Geometry<G>& g) {
  kernel::GeometryLogs<G> logs{};
  constexpr std::uint32_t kPowers =
      BRDF_EFFECT_SPECULAR_FRESNEL_FALLOFF | BRDF_EFFECT_DIFFUSE_FRESNEL | BRDF_EFFECT_RETROREFLECTION;
  if ((effects.bits() & kPowers) != 0) logs = kernel::geometry_logs(g);
  return eval_coefficients(k, options, effects, g, logs);
}

// f(the coefficients of the material's model), from q laid out as product_layout(model) says.
template <class T, class F>
auto with_coefficients(Model model, Effects effects, const T* q, const F& f) {
  switch (model) {
    case Model::kLambertGgx:
      return f(lambert_ggx_coefficients(q));
    case Model::kBurley:
      return f(burley_coefficients(q, static_cast<int>(effects.bits())));
    case Model::kCallisto:
      break;
  }
  return f(callisto_coefficients(q));
}

// f cos_i per channel; q as product_layout(model) says.
template <class T, class G>
std::array<T, 3> eval_product(Model model, const MaterialOptions& options, Effects effects, const T* q,
                              const kernel::Geometry<G>& g) {
  return with_coefficients(model, effects, q, [&](const auto& coefficients) {
    return eval_coefficients(coefficients, options, effects, g);
  });
}

}  // namespace brdfit

#endif  // BRDFIT_BRDF_PRODUCT_EVAL_H_
