// Vectorised Gram matrices. Compiled once for every instruction set.
//
// Shapes are differentiated by running the kernels on dual numbers. A dual number has fewer slots for
// derivatives than a shape has parameters: no term depends on more than a few, and parameters that never meet
// in a term share a slot. The combination of terms to a channel is differentiated by hand, as it is linear in
// nearly everything.
#include "fit/gram.h"

#include "brdf/simd/dual.h"
#include "brdf/simd/model_lanes.h"
#include "fit/loss_kernel.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {
namespace {

using fit::Gram;
using fit::GramJob;
using fit::kGramSide;

template <int N>
using D = Dual<double, N>;

// Each model: prepare() evaluates its terms, y() is a channel's f cos_i, and derivatives() are those of y
// times a slope. The slope goes into factors that derivatives share.
struct LambertGgxRows : LambertGgxLanes {
  static constexpr int coefficients = fit::kLambertGgxCoefficients;
  using LambertGgxLanes::LambertGgxLanes;
  kernel::LambertGgxTerms<D<1>> at;
  kernel::LambertGgxTerms<V> value;

  HWY_INLINE void prepare(const kernel::Geometry<V>& g, const kernel::GeometryLogs<V>&) {
    const kernel::LambertGgxShape<D<1>> s = {D<1>(shape.alpha, 0)};
    at = kernel::lambert_ggx_terms(s, g, masking, diffuse);
    value = {at.diffuse.a, at.falloff.a, at.specular.a};
  }
  HWY_INLINE V y(int c) const { return combine(c, value); }
  HWY_INLINE void derivatives(int c, V slope, V* dy) const {
    const V specular = slope * value.specular;
    const V f = slope * kernel::fresnel(colour[c].f0, value.falloff);
    dy[0] = slope * colour[c].rho * at.diffuse.d[0] + f * at.specular.d[0];
    dy[1] = slope * value.diffuse;
    dy[2] = (V(1.0) - value.falloff) * specular;
  }
};

struct BurleyRows : BurleyLanes {
  static constexpr int coefficients = fit::kBurleyCoefficients;
  using BurleyLanes::BurleyLanes;
  kernel::BurleyTerms<D<2>> at;
  kernel::BurleyTerms<V> value;

  // Slots: diffuse (roughness, subsurface), specular (roughness, alpha), clearcoat (-, clearcoat_alpha).
  HWY_INLINE void prepare(const kernel::Geometry<V>& g, const kernel::GeometryLogs<V>&) {
    const kernel::BurleyShape<D<2>> s = {D<2>(shape.roughness, 0), D<2>(shape.subsurface, 1),
                                         D<2>(shape.alpha_x, 1), D<2>(shape.alpha_y, 1),
                                         D<2>(shape.clearcoat_alpha, 1)};
    at = kernel::burley_terms(s, g, burley_g, effects);
    value = {at.diffuse.a, at.sheen.a, at.falloff.a, at.specular.a, at.clearcoat.a};
  }
  HWY_INLINE V y(int c) const { return combine(c, value); }
  HWY_INLINE void derivatives(int c, V slope, V* dy) const {
    const V rho = slope * colour[c].rho;
    const V f = slope * kernel::fresnel(colour[c].f0, value.falloff);
    dy[0] = rho * at.diffuse.d[0] + f * at.specular.d[0];
    dy[1] = rho * at.diffuse.d[1];
    dy[2] = f * at.specular.d[1];
    dy[3] = slope * colour[c].clearcoat * at.clearcoat.d[1];
    dy[4] = slope * value.diffuse;
    dy[5] = slope * value.sheen;
    dy[6] = slope * ((V(1.0) - value.falloff) * value.specular);
    dy[7] = slope * value.clearcoat;
  }
};

struct CallistoRows : CallistoLanes {
  static constexpr int coefficients = fit::kCallistoCoefficients;
  using CallistoLanes::CallistoLanes;
  kernel::CallistoTerms<D<3>> at;
  kernel::CallistoTerms<V> value;

  // Slots: diffuse (alpha_1), specular (alpha_1, alpha_2, opacity), fresnel and retro (exponent, tangent
  // exponent), falloff (specular_falloff), terminator_step (terminator_length).
  HWY_INLINE void prepare(const kernel::Geometry<V>& g, const kernel::GeometryLogs<V>& logs) {
    const kernel::CallistoShape<D<3>> s = {D<3>(shape.alpha_1, 0),
                                           D<3>(shape.alpha_2, 1),
                                           D<3>(shape.opacity, 2),
                                           D<3>(shape.fresnel_exponent, 0),
                                           D<3>(shape.fresnel_tangent_exponent, 1),
                                           D<3>(shape.retro_exponent, 0),
                                           D<3>(shape.retro_tangent_exponent, 1),
                                           D<3>(shape.specular_falloff, 0),
                                           D<3>(shape.terminator_length, 0)};
    at = kernel::callisto_terms(s, g, logs, masking, diffuse, effects);
    value = {at.diffuse.a,  at.fresnel.a,    at.retro.a,          at.falloff.a,
             at.specular.a, at.terminator.a, at.terminator_step.a};
  }

  HWY_INLINE V y(int c) const { return combine(c, value); }
  // y = sum c2 with sum = gain_f gain_r rho diffuse + f specular, as callisto_combine writes it.
  HWY_INLINE void derivatives(int c, V slope, V* dy) const {
    const kernel::CallistoColour<V>& k = colour[c];
    const V one(1.0);
    const V gain_f = one + (k.fresnel - one) * value.fresnel;
    const V gain_r = one + (k.retro - one) * value.retro;
    const V f = kernel::fresnel(k.f0, value.falloff);
    const V masked_step = (value.terminator_step - one) * value.terminator;
    const V c2 = slope * (one + masked_step * k.terminator);
    const V gains = gain_f * gain_r * c2;
    const V diffuse_c2 = k.rho * value.diffuse * c2;
    const V specular_c2 = value.specular * c2;
    const V sum = slope * (gain_f * gain_r * k.rho * value.diffuse + f * value.specular);
    const V by_specular = f * c2;
    const V by_gain_f = gain_r * diffuse_c2;
    const V by_gain_r = gain_f * diffuse_c2;
    const V by_fresnel = by_gain_f * (k.fresnel - one);
    const V by_retro = by_gain_r * (k.retro - one);
    dy[0] = by_specular * at.specular.d[0] + gains * k.rho * at.diffuse.d[0];
    dy[1] = by_specular * at.specular.d[1];
    dy[2] = by_specular * at.specular.d[2];
    dy[3] = by_fresnel * at.fresnel.d[0];
    dy[4] = by_fresnel * at.fresnel.d[1];
    dy[5] = by_retro * at.retro.d[0];
    dy[6] = by_retro * at.retro.d[1];
    dy[7] = (one - k.f0) * at.falloff.d[0] * specular_c2;
    dy[8] = sum * value.terminator * k.terminator * at.terminator_step.d[0];
    dy[9] = gains * value.diffuse;
    dy[10] = (one - value.falloff) * specular_c2;
    dy[11] = by_gain_f * value.fresnel;
    dy[12] = by_gain_r * value.retro;
    dy[13] = sum * masked_step;
  }
};

// Over Lambert diffuse only the terminator's step tells wi from wo, as terms are per cos_i: the mean of both
// orders is that of their steps.
struct CallistoMeanStepLanes : CallistoLanes {
  using CallistoLanes::CallistoLanes;
  HWY_INLINE kernel::CallistoTerms<V> terms(const kernel::Geometry<V>& g,
                                            const kernel::GeometryLogs<V>& logs) const {
    kernel::CallistoTerms<V> t = CallistoLanes::terms(g, logs);
    const V other = kernel::smoothstep_from_zero(t.terminator * shape.terminator_length, g.cos_o);
    t.terminator_step = V(0.5) * (t.terminator_step + other);
    return t;
  }
};

struct CallistoMeanStepRows : CallistoRows {
  using CallistoRows::CallistoRows;
  HWY_INLINE void prepare(const kernel::Geometry<V>& g, const kernel::GeometryLogs<V>& logs) {
    CallistoRows::prepare(g, logs);
    const D<3> length(shape.terminator_length, 0);
    const D<3> other = kernel::smoothstep_from_zero(value.terminator * length, g.cos_o);
    at.terminator_step = (at.terminator_step + other) * V(0.5);
    value.terminator_step = at.terminator_step.a;
  }
};

// Rows of one channel over a block of samples: derivatives, then the residual. Rows of all channels fit the
// cache; their stride is not a power of two, so that they do not compete for the same lines of it.
constexpr std::size_t kRowLength = 2 * kBlock;
constexpr std::size_t kRowStride = kRowLength + 8;
template <int Rows>
using BlockRows = double[Rows][kRowStride];

// Products of rows i <= j, summed over samples lane by lane.
template <int Rows>
struct Products {
  V sums[Rows][Rows];

  HWY_INLINE void clear() {
    for (int i = 0; i < Rows; ++i) {
      for (int j = i; j < Rows; ++j) sums[i][j] = V(0.0);
    }
  }
};

// Rows are multiplied tile by tile: a tile's sums and its rows fill the registers. (Highway's vectors are of
// 64 bytes only where there are 32 registers.) All row counts, 4, 9 and 15, are cut with little waste.
constexpr int kTile = V::size == 8 ? 5 : 3;

// The tile of rows I... by J...; of a tile on the diagonal the upper triangle.
template <int Rows, int I, int J>
HWY_INLINE void add_tile(const BlockRows<Rows>& rows, std::size_t length, Products<Rows>& products) {
  constexpr int height = I + kTile < Rows ? kTile : Rows - I;
  constexpr int width = J + kTile < Rows ? kTile : Rows - J;
  V sums[height][width];
#pragma GCC unroll 5
  for (int a = 0; a < height; ++a) {
#pragma GCC unroll 5
    for (int b = I == J ? a : 0; b < width; ++b) sums[a][b] = products.sums[I + a][J + b];
  }
  for (std::size_t at = 0; at < length; at += V::size) {
    V left[height];
#pragma GCC unroll 5
    for (int a = 0; a < height; ++a) left[a] = V::load(rows[I + a] + at);
#pragma GCC unroll 5
    for (int b = 0; b < width; ++b) {
      const V right = I == J ? left[b] : V::load(rows[J + b] + at);
#pragma GCC unroll 5
      for (int a = 0; a < (I == J ? b + 1 : height); ++a) {
        sums[a][b] = multiply_add(left[a], right, sums[a][b]);
      }
    }
  }
#pragma GCC unroll 5
  for (int a = 0; a < height; ++a) {
#pragma GCC unroll 5
    for (int b = I == J ? a : 0; b < width; ++b) products.sums[I + a][J + b] = sums[a][b];
  }
}

// All tiles from (I, J) on.
template <int Rows, int I = 0, int J = 0>
HWY_INLINE void add_products(const BlockRows<Rows>& rows, std::size_t length, Products<Rows>& products) {
  add_tile<Rows, I, J>(rows, length, products);
  if constexpr (J + kTile < Rows) {
    add_products<Rows, I, J + kTile>(rows, length, products);
  } else if constexpr (I + kTile < Rows) {
    add_products<Rows, I + kTile, I + kTile>(rows, length, products);
  }
}

// How a channel's value counts: the slope and the residual of its row in the Gram matrix, and its cost, all
// without the sample's weight.
struct Counted {
  V slope;
  V residual;
  V cost;
};

// The cost of a residual and the weight that its square has in it.
HWY_INLINE V robust_cost(V residual, double width, V& weight) {
  if (width == 0.0) {
    weight = V(1.0);
    return V(0.5) * residual * residual;
  }
  const V t = residual * V(1.0 / width);
  const V root = sqrt(V(1.0) + t * t);
  weight = V(1.0) / root;
  return V(width * width) * (t * t / (root + V(1.0)));  // root - 1 without cancellation
}

// inverse_cos_i: 1 / cos_i, which all channels share.
HWY_INLINE Counted count(const GramJob& job, int c, std::size_t at, V y, V cos_i, V inverse_cos_i) {
  const auto main = fit::transform(job.loss, y, cos_i);
  // Of f itself: the slope still lacks the factor 1 / cos_i.
  const auto clipped = fit::transform(BRDFIT_LOSS_SLICE, y * inverse_cos_i, V(1.0));
  const V r = main.value - V::load(job.target[c] + at);
  const V u = clipped.value - V::load(job.clipped_target[c] + at);
  const V share = V::load(job.clipped_share + at);
  V weight;
  V clipped_weight;
  const V main_cost = robust_cost(r, job.robust_width, weight);
  const V cost = multiply_add(share, robust_cost(u, job.clipped_width, clipped_weight), main_cost);
  const V clipped_slope = clipped.slope * inverse_cos_i;
  const V clipped_factor = share * clipped_weight * clipped_slope;
  // Two residuals with slopes a and b and the same derivatives are one with slope sqrt(a^2 + b^2), as far as
  // the Gram matrix goes.
  const V slope_squared = weight * main.slope * main.slope + clipped_factor * clipped_slope;
  const V slope = sqrt(kernel::at_least(slope_squared, V(1e-200)));
  return {slope, (weight * main.slope * r + clipped_factor * u) / slope, cost};
}

// The same pair with the directions exchanged. Only their cosines differ in isotropic columns.
HWY_INLINE kernel::Geometry<V> swapped(const kernel::Geometry<V>& g) {
  kernel::Geometry<V> s = g;
  s.cos_i = g.cos_o;
  s.cos_o = g.cos_i;
  return s;
}

// kMean: f is the mean of f(wi, wo) and f(wo, wi), which is what a cell holds; for materials that are
// reciprocal the second is the first.
template <class ModelRows, bool kMean>
HWY_FLATTEN void gram_of(const GramJob& job, Gram& gram) {
  constexpr int n = ModelRows::coefficients;
  ModelRows model(job.coefficients);
  ModelRows other(job.coefficients);
  alignas(64) BlockRows<n + 1> blocks[3];
  Products<n + 1> products[3];
  for (auto& channel : products) channel.clear();
  V total(0.0);
  for (std::size_t first = 0; first < job.count; first += kRowLength) {
    const std::size_t length = job.count - first < kRowLength ? job.count - first : kRowLength;
    for (std::size_t at = 0; at < length; at += V::size) {
      const kernel::Geometry<V> g = load_geometry(job.geometry, first + at);
      const kernel::GeometryLogs<V> logs = load_logs(job.geometry, first + at);
      model.prepare(g, logs);
      if constexpr (kMean) other.prepare(swapped(g), logs);
      const V weight = V::load(job.sqrt_weight + first + at);
      const V inverse_cos_i = V(1.0) / g.cos_i;
      // Turns f(wo, wi) cos_o into f(wo, wi) cos_i.
      const V to_cos_i = kMean ? g.cos_i / g.cos_o : V(1.0);
      // All channels first: what one waits for, roots and quotients, overlaps with the others.
      Counted counted[3];
      for (int c = 0; c < 3; ++c) {
        V y = model.y(c);
        if constexpr (kMean) y = V(0.5) * (y + other.y(c) * to_cos_i);
        counted[c] = count(job, c, first + at, y, g.cos_i, inverse_cos_i);
      }
      for (int c = 0; c < 3; ++c) {
        V dy[n];
        const V slope = weight * counted[c].slope;
        if constexpr (kMean) {
          V dy_other[n];
          model.derivatives(c, V(0.5) * slope, dy);
          other.derivatives(c, V(0.5) * slope * to_cos_i, dy_other);
          for (int k = 0; k < n; ++k) dy[k] = dy[k] + dy_other[k];
        } else {
          model.derivatives(c, slope, dy);
        }
        for (int k = 0; k < n; ++k) dy[k].store(blocks[c][k] + at);
        (weight * counted[c].residual).store(blocks[c][n] + at);
        total = multiply_add(weight * weight, counted[c].cost, total);
      }
    }
    for (int c = 0; c < 3; ++c) add_products(blocks[c], length, products[c]);
  }
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i <= n; ++i) {
      for (int j = i; j <= n; ++j) gram.channel[c][i * kGramSide + j] = sum(products[c].sums[i][j]);
    }
  }
  gram.cost = sum(total);
}

template <class ModelLanes, bool kMean>
HWY_FLATTEN double cost_of(const GramJob& job) {
  const ModelLanes model(job.coefficients);
  V total(0.0);
  for (std::size_t at = 0; at < job.count; at += V::size) {
    const kernel::Geometry<V> g = load_geometry(job.geometry, at);
    const kernel::GeometryLogs<V> logs = load_logs(job.geometry, at);
    const auto terms = model.terms(g, logs);
    auto other_terms = terms;
    if constexpr (kMean) other_terms = model.terms(swapped(g), logs);
    const V to_cos_i = kMean ? g.cos_i / g.cos_o : V(1.0);
    const V weight = V::load(job.sqrt_weight + at);
    const V inverse_cos_i = V(1.0) / g.cos_i;
    for (int c = 0; c < 3; ++c) {
      V y = model.combine(c, terms);
      if constexpr (kMean) y = V(0.5) * (y + model.combine(c, other_terms) * to_cos_i);
      const Counted counted = count(job, c, at, y, g.cos_i, inverse_cos_i);
      total = multiply_add(weight * weight, counted.cost, total);
    }
  }
  return sum(total);
}

}  // namespace

void accumulate_gram(const GramJob& job, Gram& gram) {
  for (auto& channel : gram.channel) {
    for (double& entry : channel) entry = 0.0;
  }
  // Burley is reciprocal; the others may be asked for the mean of both orders.
  if (job.coefficients.model == 1) return gram_of<BurleyRows, false>(job, gram);
  if (job.coefficients.model == 0) {
    return job.mean_of_orders ? gram_of<LambertGgxRows, true>(job, gram)
                              : gram_of<LambertGgxRows, false>(job, gram);
  }
  if (!job.mean_of_orders) return gram_of<CallistoRows, false>(job, gram);
  if (job.coefficients.diffuse == BRDF_DIFFUSE_LAMBERT)
    return gram_of<CallistoMeanStepRows, false>(job, gram);
  gram_of<CallistoRows, true>(job, gram);
}

double evaluate_cost(const GramJob& job) {
  if (job.coefficients.model == 1) return cost_of<BurleyLanes, false>(job);
  if (job.coefficients.model == 0) {
    return job.mean_of_orders ? cost_of<LambertGgxLanes, true>(job) : cost_of<LambertGgxLanes, false>(job);
  }
  if (!job.mean_of_orders) return cost_of<CallistoLanes, false>(job);
  if (job.coefficients.diffuse == BRDF_DIFFUSE_LAMBERT) return cost_of<CallistoMeanStepLanes, false>(job);
  return cost_of<CallistoLanes, true>(job);
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA
