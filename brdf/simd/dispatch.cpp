// Run-time choice of the instruction set.
#include "brdf/simd/dispatch.h"

#include <algorithm>
#include <vector>

#include "brdf/coefficients.h"

namespace brdfit::simd {

BRDFIT_DECLARE_SIMD(void eval_columns(const Coefficients&, const GeometryColumns&, std::size_t,
                                      double* const[3]))
BRDFIT_DECLARE_SIMD(void eval_directions(const Coefficients&, const DirectionColumns&, std::size_t,
                                         double* const[3]))
BRDFIT_DECLARE_SIMD(void eval_lines(const Coefficients&, const LineColumns&, double* const[3],
                                    double* const[3]))

namespace {

std::vector<Isa> detect() {
  std::vector<Isa> isas = {Isa::kBaseline};
#ifdef BRDFIT_HAVE_X86_ISAS
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("f16c") && __builtin_cpu_supports("bmi") &&
                    __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("pclmul") &&
                    __builtin_cpu_supports("aes");
  if (avx2) isas.push_back(Isa::kAvx2);
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd");
  if (avx512) isas.push_back(Isa::kAvx512);
#endif
  return isas;
}

template <class Coefs, class FillShape, class FillColour>
Coefficients flatten(const Material& material, const Coefs& coefs, const FillShape& fill_shape,
                     const FillColour& fill_colour) {
  Coefficients k;
  k.model = static_cast<int>(material.model());
  k.masking = static_cast<int>(material.options().masking);
  k.burley_g = static_cast<int>(material.options().burley_g);
  k.diffuse = static_cast<int>(material.options().diffuse);
  k.effects = static_cast<int>(material.effects().bits());
  fill_shape(coefs.shape, k.shape);
  for (std::size_t c = 0; c < 3; ++c) fill_colour(coefs.colour[c], k.colour[c]);
  return k;
}

}  // namespace

std::string_view name_of(Isa isa) {
  switch (isa) {
    case Isa::kBaseline:
      return "baseline";
    case Isa::kAvx2:
      return "avx2";
    case Isa::kAvx512:
      return "avx512";
  }
  return "";
}

std::span<const Isa> available_isas() {
  static const std::vector<Isa> isas = detect();
  return isas;
}

Isa best_isa() {
  return available_isas().back();
}

EvalColumns eval_columns(Isa isa) {
  return BRDFIT_PICK(isa, eval_columns);
}
EvalDirections eval_directions(Isa isa) {
  return BRDFIT_PICK(isa, eval_directions);
}
EvalLines eval_lines(Isa isa) {
  return BRDFIT_PICK(isa, eval_lines);
}

Coefficients coefficients_of(const Material& material) {
  const std::vector<double> q = product_form(material);
  const auto put = [](double* to, std::initializer_list<double> from) { std::ranges::copy(from, to); };
  switch (material.model()) {
    case Model::kLambertGgx:
      return flatten(
          material, lambert_ggx_coefficients(q.data()),
          [&](const auto& s, double* to) { put(to, {s.alpha}); },
          [&](const auto& c, double* to) {
            put(to, {c.rho, c.f0});
          });
    case Model::kBurley:
      return flatten(
          material, burley_coefficients(q.data(), static_cast<int>(material.effects().bits())),
          [&](const auto& s, double* to) {
            put(to, {s.roughness, s.subsurface, s.alpha_x, s.alpha_y, s.clearcoat_alpha});
          },
          [&](const auto& c, double* to) {
            put(to, {c.rho, c.sheen, c.f0, c.clearcoat});
          });
    case Model::kCallisto:
      break;
  }
  return flatten(
      material, callisto_coefficients(q.data()),
      [&](const auto& s, double* to) {
        put(to, {s.alpha_1, s.alpha_2, s.opacity, s.fresnel_exponent, s.fresnel_tangent_exponent,
                 s.retro_exponent, s.retro_tangent_exponent, s.specular_falloff, s.terminator_length});
      },
      [&](const auto& c, double* to) {
        put(to, {c.rho, c.f0, c.fresnel, c.retro, c.terminator});
      });
}

}  // namespace brdfit::simd
