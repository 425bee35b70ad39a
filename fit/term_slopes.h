// The pieces that models are made of, with their derivatives by the shape written out by hand. That is
// several times faster than dual numbers: a lobe's roots and quotients are shared, and nothing is multiplied
// by 0. Values are those of the kernels; tests compare both with the kernels run on Jets.
//
// For sources added by brdfit_add_simd alone, as brdf/simd/lanes.h.
#ifndef BRDFIT_FIT_TERM_SLOPES_H_
#define BRDFIT_FIT_TERM_SLOPES_H_

#include "brdf/kernel/burley.h"
#include "brdf/kernel/callisto.h"
#include "brdf/simd/dual.h"
#include "brdf/simd/lanes.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {

// A value and its derivative by one parameter.
template <class S>
struct Sloped {
  Lanes<S> a;
  Lanes<S> d;

  friend HWY_INLINE Sloped operator*(const Sloped& x, Lanes<S> y) { return {x.a * y, x.d * y}; }
};

// A value and its derivatives by two.
template <class S>
struct TwiceSloped {
  Lanes<S> a;
  Lanes<S> d[2];
};

// A parameter of GGX, with what depends on it alone.
template <class S>
struct Alpha {
  Lanes<S> value;
  Lanes<S> squared;
  Lanes<S> two_over;

  Alpha() = default;
  explicit HWY_INLINE Alpha(Lanes<S> alpha)
      : value(alpha), squared(alpha * alpha), two_over(Lanes<S>(2.0) / alpha) {}
};

// D V of a GGX lobe: d[0] by the alpha of D, d[1] by the alpha of V. All quotients come from one, of the
// product of q (as in ggx_d), 1/V and the roots in Smith's function.
template <class S>
HWY_INLINE TwiceSloped<S> sloped_lobe(const Alpha<S>& of_d, const Alpha<S>& of_v,
                                      const kernel::Geometry<Lanes<S>>& g, int masking) {
  using L = Lanes<S>;
  const L one(1.0);
  const L sine_h = g.h_x * g.h_x;  // sines are squared
  const L spread = of_d.squared * (g.cos_h * g.cos_h);
  const L q = spread + sine_h;
  const L square_i = g.cos_i * g.cos_i;
  const L square_o = g.cos_o * g.cos_o;
  const L sine_i = one - square_i;
  const L sine_o = one - square_o;
  const L root_i = sqrt(multiply_add(of_v.squared, sine_i, square_i));
  const L root_o = sqrt(multiply_add(of_v.squared, sine_o, square_o));
  const L roots = root_i * root_o;
  L shares;  // 1/V
  L slope;   // of 1/V, times roots / alpha
  if (masking == BRDF_MASKING_CORRELATED) {
    shares = kernel::at_least(L(2.0) * (g.cos_i * root_o + g.cos_o * root_i), L(BRDF_TINY));
    slope = L(2.0) * (g.cos_i * sine_o * root_i + g.cos_o * sine_i * root_o);
  } else {
    const L share_i = g.cos_i + root_i;
    const L share_o = g.cos_o + root_o;
    shares = share_i * share_o;
    slope = sine_i * (root_o * share_o) + sine_o * (root_i * share_i);
  }
  const L v_parts = shares * roots;
  const L inverse = one / (q * v_parts);
  const L inverse_q = inverse * v_parts;
  const L inverse_v_parts = inverse * q;
  TwiceSloped<S> lobe;
  lobe.a = L(BRDF_INV_PI) * of_d.squared * (inverse_q * inverse_q) * (inverse_v_parts * roots);
  lobe.d[0] = lobe.a * of_d.two_over * ((sine_h - spread) * inverse_q);
  lobe.d[1] = L(0.0) - lobe.a * of_v.value * (slope * inverse_v_parts);
  return lobe;
}

template <class S>
HWY_INLINE Sloped<S> sloped_lobe(const Alpha<S>& alpha, const kernel::Geometry<Lanes<S>>& g, int masking) {
  const TwiceSloped<S> lobe = sloped_lobe<S>(alpha, alpha, g, masking);
  return {lobe.a, lobe.d[0] + lobe.d[1]};
}

// diffuse_base_cos by alpha.
template <class S>
HWY_INLINE Sloped<S> sloped_diffuse(Lanes<S> alpha, const kernel::Geometry<Lanes<S>>& g, int diffuse) {
  const Dual<S, 1> base = kernel::diffuse_base_cos(Dual<S, 1>(alpha, 0), g, diffuse);
  return {base.a, base.d[0]};
}

// power_product by both exponents: where a base is 0, so are its log and with it the slope.
template <class S>
HWY_INLINE TwiceSloped<S> sloped_power_product(Lanes<S> base_1, Lanes<S> log_1, Lanes<S> exponent_1,
                                               Lanes<S> base_2, Lanes<S> log_2, Lanes<S> exponent_2) {
  const Lanes<S> power = kernel::power_product(base_1, log_1, exponent_1, base_2, log_2, exponent_2);
  return {power, {power * log_1, power * log_2}};
}

// callisto_specular_falloff by its parameter.
template <class S>
struct SpecularFalloff {
  using V = Lanes<S>;
  Dual<S, 1> amount;  // the clamped factor
  V exponent;

  SpecularFalloff() = default;
  explicit HWY_INLINE SpecularFalloff(V falloff)
      : amount(kernel::clamp01(Dual<S, 1>(2.0) * Dual<S, 1>(falloff, 0))),
        exponent(kernel::callisto_exponent(falloff)) {}

  HWY_INLINE Sloped<S> at(V one_minus_cos_d, V log_one_minus_cos_d) const {
    const V power = kernel::power_from_log(one_minus_cos_d, log_one_minus_cos_d, exponent);
    const V by_exponent = V(-10.0) * log_one_minus_cos_d;
    return {amount.a * power, power * multiply_add(amount.a, by_exponent, amount.d[0])};
  }
};

// smoothstep_from_zero by the length of an edge = mask length. inverse_edge: 1 / edge, or anything where edge
// is 0.
template <class S>
HWY_INLINE Sloped<S> sloped_step(Lanes<S> edge, Lanes<S> inverse_edge, Lanes<S> inverse_length, Lanes<S> x) {
  using L = Lanes<S>;
  const L one(1.0);
  const L t = select(edge > x, x * inverse_edge, one);
  return {t * t * (L(3.0) - L(2.0) * t), L(-6.0) * t * t * (one - t) * inverse_length};
}

// burley_clearcoat by its alpha. What depends on alpha alone is in the constructor.
template <class S>
struct Clearcoat {
  using V = Lanes<S>;
  V squared;
  V double_alpha;
  Dual<S, 1> scale;  // (alpha^2 - 1) / (pi log alpha^2)

  Clearcoat() = default;
  explicit HWY_INLINE Clearcoat(V alpha) : squared(alpha * alpha), double_alpha(V(2.0) * alpha) {
    const Dual<S, 1> a2 = kernel::square(Dual<S, 1>(alpha, 0));
    scale = (a2 - Dual<S, 1>(1.0)) / (Dual<S, 1>(BRDF_PI) * log(a2));
  }

  HWY_INLINE Sloped<S> at(const kernel::Geometry<V>& g) const {
    const V f = kernel::fresnel(V(0.04), kernel::schlick_falloff(g));
    const V share =
        (g.cos_i + kernel::smith_root(V(0.25), g.cos_i)) * (g.cos_o + kernel::smith_root(V(0.25), g.cos_o));
    const V cos_h_squared = g.cos_h * g.cos_h;
    const V q = squared * cos_h_squared + g.h_x * g.h_x;
    const V inverse = V(1.0) / (q * share);
    const V d_and_v = V(0.25) * f * inverse;
    const V slope = double_alpha * cos_h_squared * (inverse * share);
    return {scale.a * d_and_v, d_and_v * (scale.d[0] - scale.a * slope)};
  }
};

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA

#endif  // BRDFIT_FIT_TERM_SLOPES_H_
