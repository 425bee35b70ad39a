// Callisto and Callisto + Proxima as published, for tests to compare with.
#ifndef BRDFIT_TESTS_REFERENCE_CALLISTO_H_
#define BRDFIT_TESTS_REFERENCE_CALLISTO_H_

#include "tests/reference_burley.h"

namespace brdfit::reference {

inline Number callisto_r(Number x) {
  return 2 * (1 - x);
}

// Callisto's h(theta, n, phi, m), with 1 - cos theta given.
inline Number callisto_h(Number one_minus_cos_theta, Number n, Number cos_phi, Number m) {
  return power(one_minus_cos_theta, 5 * n) * power(cos_phi, 5 * m);
}

inline Number smoothstep(Number edge_0, Number edge_1, Number x) {
  if (x >= edge_1) return 1;
  const Number t = std::max((x - edge_0) / (edge_1 - edge_0), Number(0));
  return t * t * (3 - 2 * t);
}

inline Expected callisto_c1(const Material& m, const Geometry& g, std::size_t channel) {
  Expected c1{1, 1};
  if (m.effects().has(Effect::kDiffuseFresnel)) {
    const Number a = callisto_h(one_minus_cos(g.theta_d), callisto_r(m.number("diffuse_fresnel_falloff")),
                                g.cos_h, callisto_r(m.number("diffuse_fresnel_tangent_falloff")));
    const Number rho = Number(m.number("diffuse_fresnel")) * m.colour("diffuse_fresnel_tint")[channel];
    c1 = {c1.value * lerp(1, rho, a), c1.magnitude * (1 + rho * a)};
  }
  if (m.effects().has(Effect::kRetroreflection)) {
    const Number a = callisto_h(one_minus_cos(g.theta_h), callisto_r(m.number("retroreflection_falloff")),
                                g.cos_d, callisto_r(m.number("retroreflection_tangent_falloff")));
    const Number rho = Number(m.number("retroreflection")) * m.colour("retroreflection_tint")[channel];
    c1 = {c1.value * lerp(1, rho, a), c1.magnitude * (1 + rho * a)};
  }
  return c1;
}

inline Expected callisto_c2(const Material& m, const Geometry& g, std::size_t channel) {
  if (!m.effects().has(Effect::kSmoothTerminator)) return {1, 1};
  const Number a = (1 - power(one_minus_cos(g.theta_d), 3)) * (1 - power(one_minus_cos(g.theta_h), 3));
  const Number o = Number(m.number("smooth_terminator")) * m.colour("smooth_terminator_tint")[channel];
  const Number step = smoothstep(0, a * m.number("smooth_terminator_length"), g.cos_i);
  return {lerp(1, step, a * o), 2};
}

// The share of white that the specular Fresnel adds.
inline Number callisto_specular_falloff(const Material& m, const Geometry& g) {
  if (!m.effects().has(Effect::kSpecularFresnelFalloff)) return schlick(g);
  const Number r = callisto_r(m.number("specular_fresnel_falloff"));
  return std::clamp(2 - r, Number(0), Number(1)) * power(one_minus_cos(g.theta_d), 5 * r);
}

inline Number callisto_lobes(const Material& m, const Geometry& g) {
  const Number roughness = m.number("roughness");
  const Number first = ggx_lobe(roughness * roughness, g, m.options().masking);
  if (!m.effects().has(Effect::kDualSpecular)) return first;
  const Number second_roughness = std::min(Number(1), roughness * m.number("dual_specular_roughness_scale"));
  const Number second = ggx_lobe(second_roughness * second_roughness, g, m.options().masking);
  return lerp(first, second, m.number("dual_specular_opacity"));
}

inline std::array<Expected, 3> callisto_cos(const Material& m, const Vec3& wi, const Vec3& wo) {
  std::array<Expected, 3> result;
  const Geometry g = geometry(wi, wo);
  if (!g.above) return result;
  const Number roughness = m.number("roughness");
  const Number metallic = m.number("metallic");
  const Number dielectric = Number(0.08) * m.number("specular");
  const Expected diffuse = diffuse_cos(roughness * roughness, g, m.options().diffuse);
  const Number lobes = callisto_lobes(m, g) * g.cos_i;
  const Number falloff = callisto_specular_falloff(m, g);
  // lerp as the kernels write it, a + (b - a) t, rounds relative to the larger lobe.
  const Number first = ggx_lobe(roughness * roughness, g, m.options().masking) * g.cos_i;
  for (std::size_t c = 0; c < 3; ++c) {
    const Number base = m.colour("base_color")[c];
    const Number f0 = metallic_f0(base, metallic, dielectric);
    const Number rho = base * (1 - metallic);
    const Expected c1 = callisto_c1(m, g, c);
    const Expected c2 = callisto_c2(m, g, c);
    result[c].value = (c1.value * rho * diffuse.value + (f0 + (1 - f0) * falloff) * lobes) * c2.value;
    result[c].magnitude =
        (c1.magnitude * rho * diffuse.magnitude + (dielectric + base + falloff) * (lobes + first)) *
        c2.magnitude;
  }
  return result;
}

// f cos_i of any model.
inline std::array<Expected, 3> eval_cos(const Material& m, const Vec3& wi, const Vec3& wo) {
  switch (m.model()) {
    case Model::kLambertGgx:
      return lambert_ggx_cos(m, wi, wo);
    case Model::kBurley:
      return burley_cos(m, wi, wo);
    case Model::kCallisto:
      break;
  }
  return callisto_cos(m, wi, wo);
}

}  // namespace brdfit::reference

#endif  // BRDFIT_TESTS_REFERENCE_CALLISTO_H_
