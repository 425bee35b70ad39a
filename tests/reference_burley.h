// Burley 2012 as published, for tests to compare with.
#ifndef BRDFIT_TESTS_REFERENCE_BURLEY_H_
#define BRDFIT_TESTS_REFERENCE_BURLEY_H_

#include "tests/reference_lambert_ggx.h"

namespace brdfit::reference {

inline Number gtr1_d(Number alpha, Number cos_h) {
  if (alpha >= 1) return 1 / kPi;
  const Number a2 = alpha * alpha;
  return (a2 - 1) / (kPi * std::log(a2) * (1 + (a2 - 1) * cos_h * cos_h));
}

inline Number burley_g(Number alpha, Number cosine) {
  const Number a2 = alpha * alpha;
  const Number c2 = cosine * cosine;
  return 1 / (cosine + std::sqrt(a2 + c2 - a2 * c2));
}

inline Number burley_g_anisotropic(Number alpha_x, Number alpha_y, const Vec3& w) {
  const Number x = w.x * alpha_x;
  const Number y = w.y * alpha_y;
  return 1 / (w.z + std::sqrt(x * x + y * y + Number(w.z) * w.z));
}

inline Number burley_specular_d_v(const Material& m, const Vec3& wi, const Vec3& wo, const Geometry& g) {
  const bool anisotropic = m.effects().has(Effect::kAnisotropic);
  const Number roughness = m.number("roughness");
  const Number alpha = roughness * roughness;
  const Number aspect = anisotropic ? std::sqrt(1 - Number(0.9) * m.number("anisotropic")) : Number(1);
  const Number alpha_x = anisotropic ? std::max(Number(0.001), alpha / aspect) : alpha;
  const Number alpha_y = anisotropic ? std::max(Number(0.001), alpha * aspect) : alpha;
  const Number d = gtr2_d(alpha_x, alpha_y, g);
  if (m.options().burley_g == BurleyG::k2017) {
    return d * burley_g_anisotropic(alpha_x, alpha_y, wi) * burley_g_anisotropic(alpha_x, alpha_y, wo);
  }
  const Number remapped = (Number(0.5) + Number(0.5) * roughness) * (Number(0.5) + Number(0.5) * roughness);
  return d * burley_g(remapped, g.cos_i) * burley_g(remapped, g.cos_o);
}

// The diffuse lobe per unit base colour.
inline Expected burley_diffuse(const Material& m, const Geometry& g) {
  const Number roughness = m.number("roughness");
  const Number fl = power(1 - g.cos_i, 5);
  const Number fv = power(1 - g.cos_o, 5);
  const Number fd90 = Number(0.5) + 2 * g.cos_d * g.cos_d * roughness;
  const Number fd = lerp(1, fd90, fl) * lerp(1, fd90, fv);
  if (!m.effects().has(Effect::kSubsurface)) return {fd / kPi, fd / kPi};
  const Number fss90 = g.cos_d * g.cos_d * roughness;
  const Number fss = lerp(1, fss90, fl) * lerp(1, fss90, fv);
  const Number ss = Number(1.25) * (fss * (1 / (g.cos_i + g.cos_o) - Number(0.5)) + Number(0.5));
  const Number largest = fd + Number(1.25) * (1 / (g.cos_i + g.cos_o) + 1);
  return {lerp(fd, ss, m.number("subsurface")) / kPi, largest / kPi};
}

inline Number burley_clearcoat(const Material& m, const Geometry& g) {
  if (!m.effects().has(Effect::kClearcoat)) return 0;
  const Number a = lerp(Number(0.1), Number(0.001), m.number("clearcoat_gloss"));
  // 1 + (a^2 - 1) cos_h^2 loses digits near cos_h = 1: from sin_h^2 instead, the normalisation as published.
  const Number sin_squared = g.h_x * g.h_x + g.h_y * g.h_y;
  const Number d = gtr1_d(a, 0) / (sin_squared + a * a * g.cos_h * g.cos_h);
  return Number(0.25) * m.number("clearcoat") * d * lerp(Number(0.04), 1, schlick(g)) *
         burley_g(Number(0.25), g.cos_i) * burley_g(Number(0.25), g.cos_o);
}

inline std::array<Expected, 3> burley_cos(const Material& m, const Vec3& wi, const Vec3& wo) {
  std::array<Expected, 3> result;
  const Geometry g = geometry(wi, wo);
  if (!g.above) return result;
  const auto value_of = [&m](Effect effect, std::string_view name) {
    return m.effects().has(effect) ? Number(m.number(name)) : Number(0);
  };
  const Number metallic = m.number("metallic");
  const Number fh = schlick(g);
  const Rgb base = m.colour("base_color");
  const Number luminance = Number(0.3) * base[0] + Number(0.6) * base[1] + Number(0.1) * base[2];
  const Expected diffuse = burley_diffuse(m, g);
  const Number lobe = burley_specular_d_v(m, wi, wo, g);
  const Number clearcoat = burley_clearcoat(m, g);
  const Number specular_tint = value_of(Effect::kSpecularTint, "specular_tint");
  const Number sheen = value_of(Effect::kSheen, "sheen");
  for (std::size_t c = 0; c < 3; ++c) {
    const Number tint = luminance > 0 ? base[c] / luminance : Number(1);
    const Number dielectric = Number(0.08) * m.number("specular") * lerp(1, tint, specular_tint);
    const Number f0 = metallic_f0(base[c], metallic, dielectric);
    const Number sheen_term = fh * sheen * lerp(1, tint, m.number("sheen_tint"));
    const Number f_diffuse = (base[c] * diffuse.value + sheen_term) * (1 - metallic);
    const Number f_specular = lerp(f0, 1, fh) * lobe;
    result[c].value = (f_diffuse + f_specular + clearcoat) * g.cos_i;
    result[c].magnitude =
        (base[c] * diffuse.magnitude * (1 - metallic) + fh * sheen * (1 + tint) +
         (Number(0.08) * m.number("specular") * (1 + tint) + base[c] + fh) * lobe + clearcoat) *
        g.cos_i;
  }
  return result;
}

}  // namespace brdfit::reference

#endif  // BRDFIT_TESTS_REFERENCE_BURLEY_H_
