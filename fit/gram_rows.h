// Each model as rows of a Gram matrix: terms() evaluates what its channels share, with derivatives; y() is a
// channel's f cos_i, and derivatives() are those of y times a slope, in the order of fit/gram.h. The slope
// goes into factors that derivatives share.
//
// For sources added by brdfit_add_simd alone, as brdf/simd/lanes.h.
#ifndef BRDFIT_FIT_GRAM_ROWS_H_
#define BRDFIT_FIT_GRAM_ROWS_H_

#include "brdf/simd/jobs.h"
#include "fit/gram.h"
#include "fit/term_slopes.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {

template <class S>
struct LambertGgxRows {
  using V = Lanes<S>;
  static constexpr int coefficients = fit::kLambertGgxCoefficients;
  struct Terms {
    Sloped<S> diffuse;
    V falloff;
    Sloped<S> specular;
  };

  Alpha<S> alpha;
  V rho[3];
  V f0[3];
  int masking;
  int diffuse;

  explicit HWY_INLINE LambertGgxRows(const Coefficients& k)
      : alpha(V(k.shape[0])), masking(k.masking), diffuse(k.diffuse) {
    for (int c = 0; c < 3; ++c) {
      rho[c] = V(k.colour[c][0]);
      f0[c] = V(k.colour[c][1]);
    }
  }
  HWY_INLINE Terms terms(const kernel::Geometry<V>& g, const kernel::GeometryLogs<V>&) const {
    return {sloped_diffuse<S>(alpha.value, g, diffuse), kernel::schlick_falloff(g),
            sloped_lobe<S>(alpha, g, masking) * g.cos_i};
  }
  HWY_INLINE V y(int c, const Terms& t) const {
    return rho[c] * t.diffuse.a + kernel::fresnel(f0[c], t.falloff) * t.specular.a;
  }
  HWY_INLINE void derivatives(int c, const Terms& t, V slope, V* dy) const {
    const V f = slope * kernel::fresnel(f0[c], t.falloff);
    dy[0] = slope * rho[c] * t.diffuse.d + f * t.specular.d;
    dy[1] = slope * t.diffuse.a;
    dy[2] = (V(1.0) - t.falloff) * (slope * t.specular.a);
  }
};

template <class S>
struct BurleyRows {
  using V = Lanes<S>;
  static constexpr int coefficients = fit::kBurleyCoefficients;
  struct Terms {
    Dual<S, 2> diffuse;  // by roughness and subsurface
    V sheen;
    V falloff;
    TwiceSloped<S> specular;  // by roughness and alpha
    Sloped<S> clearcoat;
  };

  kernel::BurleyShape<Dual<S, 2>> of_diffuse;
  Alpha<S> alpha;
  Alpha<S> masking_alpha;
  V masking_slope;  // of masking_alpha by roughness
  Clearcoat<S> coat;
  kernel::BurleyColour<V> colour[3];
  int burley_g;
  int effects;

  explicit HWY_INLINE BurleyRows(const Coefficients& k)
      : alpha(V(k.shape[2])), coat(V(k.shape[4])), burley_g(k.burley_g), effects(k.effects) {
    of_diffuse.roughness = Dual<S, 2>(V(k.shape[0]), 0);
    of_diffuse.subsurface = Dual<S, 2>(V(k.shape[1]), 1);
    masking_slope = V(0.5) + V(0.5) * V(k.shape[0]);
    masking_alpha = burley_g == BRDF_BURLEY_G_2012 ? Alpha<S>(masking_slope * masking_slope) : alpha;
    for (int c = 0; c < 3; ++c) {
      colour[c] = {V(k.colour[c][0]), V(k.colour[c][1]), V(k.colour[c][2]), V(k.colour[c][3])};
    }
  }
  HWY_INLINE Terms terms(const kernel::Geometry<V>& g, const kernel::GeometryLogs<V>&) const {
    Terms t;
    t.diffuse = kernel::burley_diffuse(of_diffuse.roughness, of_diffuse.subsurface, g, effects) * g.cos_i;
    t.falloff = kernel::schlick_falloff(g);
    t.sheen = t.falloff * g.cos_i;
    const TwiceSloped<S> lobe = sloped_lobe<S>(alpha, masking_alpha, g, BRDF_MASKING_SEPARABLE);
    t.specular.a = lobe.a * g.cos_i;
    if (burley_g == BRDF_BURLEY_G_2012) {
      t.specular.d[0] = lobe.d[1] * masking_slope * g.cos_i;
      t.specular.d[1] = lobe.d[0] * g.cos_i;
    } else {
      t.specular.d[0] = V(0.0);
      t.specular.d[1] = (lobe.d[0] + lobe.d[1]) * g.cos_i;
    }
    t.clearcoat = {V(0.0), V(0.0)};
    if ((effects & BRDF_EFFECT_CLEARCOAT) != 0) t.clearcoat = coat.at(g) * g.cos_i;
    return t;
  }
  HWY_INLINE V y(int c, const Terms& t) const {
    const kernel::BurleyColour<V>& k = colour[c];
    return k.rho * t.diffuse.a + k.sheen * t.sheen + kernel::fresnel(k.f0, t.falloff) * t.specular.a +
           k.clearcoat * t.clearcoat.a;
  }
  HWY_INLINE void derivatives(int c, const Terms& t, V slope, V* dy) const {
    const V rho = slope * colour[c].rho;
    const V f = slope * kernel::fresnel(colour[c].f0, t.falloff);
    dy[0] = rho * t.diffuse.d[0] + f * t.specular.d[0];
    dy[1] = rho * t.diffuse.d[1];
    dy[2] = f * t.specular.d[1];
    dy[3] = slope * colour[c].clearcoat * t.clearcoat.d;
    dy[4] = slope * t.diffuse.a;
    dy[5] = slope * t.sheen;
    dy[6] = slope * ((V(1.0) - t.falloff) * t.specular.a);
    dy[7] = slope * t.clearcoat.a;
  }
};

template <class S>
struct CallistoRows {
  using V = Lanes<S>;
  static constexpr int coefficients = fit::kCallistoCoefficients;
  struct Terms {
    Sloped<S> diffuse;
    TwiceSloped<S> fresnel;
    TwiceSloped<S> retro;
    Sloped<S> falloff;
    V specular;
    V by_alpha_1;
    V by_alpha_2;
    V by_opacity;
    V mask;
    Sloped<S> step;
  };

  Alpha<S> alpha_1;
  Alpha<S> alpha_2;
  V opacity;
  V fresnel_exponent;
  V fresnel_tangent_exponent;
  V retro_exponent;
  V retro_tangent_exponent;
  SpecularFalloff<S> specular_falloff;
  V length;
  V inverse_length;  // 0 where the length is
  kernel::CallistoColour<V> colour[3];
  int masking;
  int diffuse;
  int effects;

  explicit HWY_INLINE CallistoRows(const Coefficients& k)
      : alpha_1(V(k.shape[0])),
        alpha_2(V(k.shape[1])),
        opacity(k.shape[2]),
        fresnel_exponent(k.shape[3]),
        fresnel_tangent_exponent(k.shape[4]),
        retro_exponent(k.shape[5]),
        retro_tangent_exponent(k.shape[6]),
        specular_falloff(V(k.shape[7])),
        length(k.shape[8]),
        inverse_length(k.shape[8] > 0.0 ? 1.0 / k.shape[8] : 0.0),
        masking(k.masking),
        diffuse(k.diffuse),
        effects(k.effects) {
    for (int c = 0; c < 3; ++c) {
      colour[c] = {V(k.colour[c][0]), V(k.colour[c][1]), V(k.colour[c][2]), V(k.colour[c][3]),
                   V(k.colour[c][4])};
    }
  }

  HWY_INLINE Terms terms(const kernel::Geometry<V>& g, const kernel::GeometryLogs<V>& logs) const {
    Terms t = smooth_terms(g, logs);
    if ((effects & BRDF_EFFECT_SMOOTH_TERMINATOR) == 0) return without_terminator(t);
    t.mask = kernel::callisto_terminator_mask(g);
    const V edge = t.mask * length;
    t.step = sloped_step<S>(edge, V(1.0) / edge, inverse_length, g.cos_i);
    return t;
  }

  HWY_INLINE V y(int c, const Terms& t) const { return parts(c, t).sum * parts(c, t).c2; }

  HWY_INLINE void derivatives(int c, const Terms& t, V slope, V* dy) const {
    const kernel::CallistoColour<V>& k = colour[c];
    const V one(1.0);
    const Parts p = parts(c, t);
    const V c2 = slope * p.c2;
    const V sum = slope * p.sum;
    const V gains = p.gain_f * p.gain_r * c2;
    const V diffuse_c2 = k.rho * t.diffuse.a * c2;
    const V specular_c2 = t.specular * c2;
    const V by_specular = p.f * c2;
    const V by_gain_f = p.gain_r * diffuse_c2;
    const V by_gain_r = p.gain_f * diffuse_c2;
    const V by_fresnel = by_gain_f * (k.fresnel - one);
    const V by_retro = by_gain_r * (k.retro - one);
    dy[0] = by_specular * t.by_alpha_1 + gains * k.rho * t.diffuse.d;
    dy[1] = by_specular * t.by_alpha_2;
    dy[2] = by_specular * t.by_opacity;
    dy[3] = by_fresnel * t.fresnel.d[0];
    dy[4] = by_fresnel * t.fresnel.d[1];
    dy[5] = by_retro * t.retro.d[0];
    dy[6] = by_retro * t.retro.d[1];
    dy[7] = (one - k.f0) * t.falloff.d * specular_c2;
    dy[8] = sum * t.mask * k.terminator * t.step.d;
    dy[9] = gains * t.diffuse.a;
    dy[10] = (one - t.falloff.a) * specular_c2;
    dy[11] = by_gain_f * t.fresnel.a;
    dy[12] = by_gain_r * t.retro.a;
    dy[13] = sum * p.masked_step;
  }

 protected:
  // All but the terminator.
  HWY_INLINE Terms smooth_terms(const kernel::Geometry<V>& g, const kernel::GeometryLogs<V>& logs) const {
    const V zero(0.0);
    Terms t;
    t.diffuse = sloped_diffuse<S>(alpha_1.value, g, diffuse);
    const Sloped<S> first = sloped_lobe<S>(alpha_1, g, masking) * g.cos_i;
    t.specular = first.a;
    t.by_alpha_1 = first.d;
    t.by_alpha_2 = t.by_opacity = zero;
    if ((effects & BRDF_EFFECT_DUAL_SPECULAR) != 0) {
      const Sloped<S> second = sloped_lobe<S>(alpha_2, g, masking) * g.cos_i;
      t.by_opacity = second.a - first.a;
      t.specular = multiply_add(opacity, t.by_opacity, first.a);
      t.by_alpha_1 = first.d - opacity * first.d;
      t.by_alpha_2 = opacity * second.d;
    }
    t.falloff = {kernel::schlick_falloff(g), zero};
    if ((effects & BRDF_EFFECT_SPECULAR_FRESNEL_FALLOFF) != 0) {
      t.falloff = specular_falloff.at(g.one_minus_cos_d, logs.one_minus_cos_d);
    }
    t.fresnel = t.retro = {zero, {zero, zero}};
    if ((effects & BRDF_EFFECT_DIFFUSE_FRESNEL) != 0) {
      t.fresnel = sloped_power_product<S>(g.one_minus_cos_d, logs.one_minus_cos_d, fresnel_exponent, g.cos_h,
                                          logs.cos_h, fresnel_tangent_exponent);
    }
    if ((effects & BRDF_EFFECT_RETROREFLECTION) != 0) {
      t.retro = sloped_power_product<S>(g.one_minus_cos_h, logs.one_minus_cos_h, retro_exponent, g.cos_d,
                                        logs.cos_d, retro_tangent_exponent);
    }
    return t;
  }
  static HWY_INLINE Terms without_terminator(Terms t) {
    t.mask = V(0.0);
    t.step = {V(1.0), V(0.0)};
    return t;
  }

 private:
  // y = sum c2 with sum = gain_f gain_r rho diffuse + f specular, as callisto_combine writes it.
  struct Parts {
    V gain_f, gain_r, f, masked_step, sum, c2;
  };
  HWY_INLINE Parts parts(int c, const Terms& t) const {
    const kernel::CallistoColour<V>& k = colour[c];
    const V one(1.0);
    Parts p;
    p.gain_f = multiply_add(k.fresnel - one, t.fresnel.a, one);
    p.gain_r = multiply_add(k.retro - one, t.retro.a, one);
    p.f = kernel::fresnel(k.f0, t.falloff.a);
    p.masked_step = (t.step.a - one) * t.mask;
    p.sum = multiply_add(p.gain_f * p.gain_r, k.rho * t.diffuse.a, p.f * t.specular);
    p.c2 = multiply_add(p.masked_step, k.terminator, one);
    return p;
  }
};

// Over Lambert diffuse only the terminator's step tells wi from wo, as terms are per cos_i: the mean of both
// orders is that of their steps.
template <class S>
struct CallistoMeanStepRows : CallistoRows<S> {
  using V = Lanes<S>;
  using typename CallistoRows<S>::Terms;
  using CallistoRows<S>::CallistoRows;

  HWY_INLINE Terms terms(const kernel::Geometry<V>& g, const kernel::GeometryLogs<V>& logs) const {
    Terms t = this->smooth_terms(g, logs);
    if ((this->effects & BRDF_EFFECT_SMOOTH_TERMINATOR) == 0) return this->without_terminator(t);
    t.mask = kernel::callisto_terminator_mask(g);
    const V edge = t.mask * this->length;
    const V inverse_edge = V(1.0) / edge;
    const Sloped<S> by_i = sloped_step<S>(edge, inverse_edge, this->inverse_length, g.cos_i);
    const Sloped<S> by_o = sloped_step<S>(edge, inverse_edge, this->inverse_length, g.cos_o);
    t.step = {V(0.5) * (by_i.a + by_o.a), V(0.5) * (by_i.d + by_o.d)};
    return t;
  }
};

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA

#endif  // BRDFIT_FIT_GRAM_ROWS_H_
