// Lambert + GGX and Proxima as published, for tests to compare with.
#ifndef BRDFIT_TESTS_REFERENCE_LAMBERT_GGX_H_
#define BRDFIT_TESTS_REFERENCE_LAMBERT_GGX_H_

#include <algorithm>
#include <array>

#include "brdf/material.h"
#include "tests/reference_geometry.h"

namespace brdfit::reference {

// The published form: D of GGX from cos_h.
inline Number ggx_d(Number alpha, Number cos_h) {
  const Number root = (alpha * alpha - 1) * cos_h * cos_h + 1;
  return alpha * alpha / (kPi * root * root);
}

// The same from the components of h = (h_x, h_y, cos_h), possibly anisotropic.
inline Number gtr2_d(Number alpha_x, Number alpha_y, const Geometry& g) {
  const Number x = g.h_x / alpha_x;
  const Number y = g.h_y / alpha_y;
  const Number root = x * x + y * y + g.cos_h * g.cos_h;
  return 1 / (kPi * alpha_x * alpha_y * root * root);
}

inline Number smith_lambda(Number alpha, Number cosine) {
  const Number tan_squared = (1 - cosine * cosine) / (cosine * cosine);
  return (std::sqrt(1 + alpha * alpha * std::max(tan_squared, Number(0))) - 1) / 2;
}

// V = G / (4 cos_i cos_o).
inline Number ggx_v(Number alpha, Number cos_i, Number cos_o, Masking masking) {
  const Number in = smith_lambda(alpha, cos_i);
  const Number out = smith_lambda(alpha, cos_o);
  const Number g = masking == Masking::kSeparable ? 1 / ((1 + in) * (1 + out)) : 1 / (1 + in + out);
  return g / (4 * cos_i * cos_o);
}

inline Number ggx_lobe(Number alpha, const Geometry& g, Masking masking) {
  return gtr2_d(alpha, alpha, g) * ggx_v(alpha, g.cos_i, g.cos_o, masking);
}

// f cos_i of the diffuse base per unit albedo. Its magnitude includes what a root near 0 makes of a rounding
// of its argument.
inline Expected diffuse_cos(Number alpha, const Geometry& g, Diffuse diffuse) {
  if (diffuse == Diffuse::kLambert) return {g.cos_i / kPi, g.cos_i / kPi};
  const Number cos_k = -std::cos(2 * g.theta_d);
  const Number root = std::sqrt(std::max(cos_k, Number(0)));
  const Number slope = Number(0.19) - Number(0.55) * g.cos_i;
  const Number condition = 1 / (2 * std::sqrt(std::max(std::abs(cos_k), Number(1e-16))));
  return {(alpha * slope * (1 - root) + g.cos_i) / kPi,
          (alpha * (Number(0.19) + Number(0.55) * g.cos_i) * (1 + Number(0.01) * condition) + g.cos_i) / kPi};
}

inline Number metallic_f0(Number base, Number metallic, Number dielectric) {
  return lerp(dielectric, base, metallic);
}

inline std::array<Expected, 3> lambert_ggx_cos(const Material& m, const Vec3& wi, const Vec3& wo) {
  std::array<Expected, 3> result;
  const Geometry g = geometry(wi, wo);
  if (!g.above) return result;
  const Number roughness = m.number("roughness");
  const Number metallic = m.number("metallic");
  const Number dielectric = Number(0.08) * m.number("specular");
  const Expected diffuse = diffuse_cos(roughness * roughness, g, m.options().diffuse);
  const Number lobe = ggx_lobe(roughness * roughness, g, m.options().masking) * g.cos_i;
  for (std::size_t c = 0; c < 3; ++c) {
    const Number base = m.colour("base_color")[c];
    const Number f0 = metallic_f0(base, metallic, dielectric);
    const Number rho = base * (1 - metallic);
    result[c].value = rho * diffuse.value + (f0 + (1 - f0) * schlick(g)) * lobe;
    result[c].magnitude = rho * diffuse.magnitude + (dielectric + base + schlick(g)) * lobe;
  }
  return result;
}

}  // namespace brdfit::reference

#endif  // BRDFIT_TESTS_REFERENCE_LAMBERT_GGX_H_
