// Vectorised Gram matrices. Compiled once for every instruction set.
//
// Terms of a block of samples are evaluated first, then the rows of one channel after the other, so that a
// channel's rows and their products stay in the cache.
#include "fit/gram.h"

#include <type_traits>

#include "brdf/simd/model_lanes.h"
#include "fit/gram_products.h"
#include "fit/gram_rows.h"
#include "fit/loss_kernel.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {
namespace {

using fit::Gram;
using fit::GramJob;
using fit::kGramSide;

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

// How a channel's value counts: the slope and the residual of its row in the Gram matrix, and its cost, all
// without the sample's weight.
//
// Two residuals r and u with slopes a and b and the same derivatives are one with slope s = sqrt(a^2 + b^2),
// as far as the Gram matrix goes. At first s^2 and the product s times the residual, a r + b u, stand here.
template <class S>
struct Counted {
  Lanes<S> slope;
  Lanes<S> residual;
  Lanes<S> cost;
};

// The columns of a job in one precision, in the order of kSingleColumns.
template <class S>
struct Columns;

template <>
struct Columns<double> {
  const double* at[fit::kSingleColumns];

  explicit Columns(const GramJob& job)
      : at{job.geometry.cos_i,
           job.geometry.cos_o,
           job.geometry.sin_h,
           job.geometry.cos_h,
           job.geometry.cos_d,
           job.geometry.one_minus_cos_h,
           job.geometry.one_minus_cos_d,
           job.geometry.log_cos_h,
           job.geometry.log_cos_d,
           job.geometry.log_one_minus_cos_h,
           job.geometry.log_one_minus_cos_d,
           job.sqrt_weight,
           job.clipped_share,
           job.target[0],
           job.target[1],
           job.target[2],
           job.clipped_target[0],
           job.clipped_target[1],
           job.clipped_target[2]} {}
};

template <>
struct Columns<float> {
  const float* at[fit::kSingleColumns];

  explicit Columns(const GramJob& job) {
    for (std::size_t k = 0; k < fit::kSingleColumns; ++k) at[k] = job.single + k * job.single_stride;
  }
};

// One vector of every column.
template <class S>
struct Reader {
  using V = Lanes<S>;
  Columns<S> columns;

  explicit HWY_INLINE Reader(const GramJob& job) : columns(job) {}

  HWY_INLINE V load(int column, std::size_t at) const { return V::load(columns.at[column] + at); }
  HWY_INLINE V cos_i(std::size_t at) const { return load(0, at); }
  HWY_INLINE V weight(std::size_t at) const { return load(11, at); }
  HWY_INLINE V clipped_share(std::size_t at) const { return load(12, at); }
  HWY_INLINE V target(int c, std::size_t at) const { return load(13 + c, at); }
  HWY_INLINE V clipped_target(int c, std::size_t at) const { return load(16 + c, at); }
  HWY_INLINE kernel::Geometry<V> geometry(std::size_t at) const {
    kernel::Geometry<V> g;
    g.cos_i = load(0, at);
    g.cos_o = load(1, at);
    g.h_x = load(2, at);
    g.cos_h = load(3, at);
    g.cos_d = load(4, at);
    g.cos_k = kernel::cos_k_from_cos_d(g.cos_d);
    g.one_minus_cos_h = load(5, at);
    g.one_minus_cos_d = load(6, at);
    g.h_y = g.wi_x = g.wi_y = g.wo_x = g.wo_y = V(0.0);
    return g;
  }
  HWY_INLINE kernel::GeometryLogs<V> logs(std::size_t at) const {
    return {load(7, at), load(8, at), load(9, at), load(10, at)};
  }
};

// The same pair with the directions exchanged. Only their cosines differ in isotropic columns.
template <class V>
HWY_INLINE kernel::Geometry<V> swapped(const kernel::Geometry<V>& g) {
  kernel::Geometry<V> s = g;
  s.cos_i = g.cos_o;
  s.cos_o = g.cos_i;
  return s;
}

// Any loss. inverse_cos_i: 1 / cos_i, which all channels share.
template <class S>
struct AnyLoss {
  using V = Lanes<S>;
  int loss;
  double width;
  double clipped_width;
  bool curvature;

  explicit HWY_INLINE AnyLoss(const GramJob& job)
      : loss(job.loss), width(job.robust_width), clipped_width(job.clipped_width), curvature(job.curvature) {}

  // What products of derivatives are weighted by.
  HWY_INLINE V of_products(V weight) const { return curvature ? weight * weight * weight : weight; }

  // The cost of a residual and the weight that its square has in it.
  static HWY_INLINE V robust_cost(V residual, double width, V& weight) {
    if (width == 0.0) {
      weight = V(1.0);
      return V(0.5) * residual * residual;
    }
    const V t = residual * V(1.0 / width);
    const V root = sqrt(V(1.0) + t * t);
    weight = V(1.0) / root;
    return V(width * width) * (t * t / (root + V(1.0)));  // root - 1 without cancellation
  }

  HWY_INLINE Counted<S> count(V y, V cos_i, V inverse_cos_i, V target, V clipped_target, V share) const {
    const auto main = fit::transform(loss, y, cos_i);
    // Of f itself: the slope still lacks the factor 1 / cos_i.
    const auto clipped = fit::transform(BRDFIT_LOSS_SLICE, y * inverse_cos_i, V(1.0));
    const V r = main.value - target;
    const V u = clipped.value - clipped_target;
    V weight;
    V clipped_weight;
    const V main_cost = robust_cost(r, width, weight);
    const V cost = multiply_add(share, robust_cost(u, clipped_width, clipped_weight), main_cost);
    const V clipped_slope = clipped.slope * inverse_cos_i;
    const V slope_squared = of_products(weight) * main.slope * main.slope +
                            share * of_products(clipped_weight) * clipped_slope * clipped_slope;
    return {kernel::at_least(slope_squared, V(1e-30)),
            weight * main.slope * r + share * clipped_weight * clipped_slope * u, cost};
  }
};

// The log-ratio with both robust widths, which is what nearly every fit uses: one quotient for all.
template <class S>
struct RobustLogRatio {
  using V = Lanes<S>;
  V inverse_width_squared;
  V width_squared;
  V clipped_inverse_squared;
  V clipped_squared;
  bool curvature;

  explicit HWY_INLINE RobustLogRatio(const GramJob& job)
      : inverse_width_squared(1.0 / (job.robust_width * job.robust_width)),
        width_squared(job.robust_width * job.robust_width),
        clipped_inverse_squared(1.0 / (job.clipped_width * job.clipped_width)),
        clipped_squared(job.clipped_width * job.clipped_width),
        curvature(job.curvature) {}

  HWY_INLINE Counted<S> count(V y, V, V inverse_cos_i, V target, V clipped_target, V share) const {
    const V one(1.0);
    const V shifted = y + V(fit::kLogFloor);
    const V r = log(shifted) - target;
    const V f = y * inverse_cos_i;
    const auto is_clipped = f > one;
    const V u = select(is_clipped, one, f) - clipped_target;
    const V clipped_slope = select(is_clipped, V(0.0), inverse_cos_i);
    const V t = r * r * inverse_width_squared;
    const V v = u * u * clipped_inverse_squared;
    const V root_t = sqrt(one + t);
    const V root_v = sqrt(one + v);
    // Costs are squared widths times root - 1, written without cancellation as t / (root + 1).
    const V above_t = root_t + one;
    const V above_v = root_v + one;
    const V roots = root_t * root_v;
    const V aboves = above_t * above_v;
    const V inverse = one / (shifted * roots * aboves);
    const V inverse_aboves = inverse * (shifted * roots);
    const V cost = inverse_aboves * (width_squared * t * above_v + share * (clipped_squared * v * above_t));
    const V rest = inverse * aboves;  // 1 / (shifted roots)
    const V slope = rest * roots;
    const V weight = rest * shifted * root_v;
    const V clipped_weight = rest * shifted * root_t;
    const V weighted = slope * weight;
    const V clipped_factor = share * clipped_slope * clipped_weight;
    const V gradient = weighted * r + clipped_factor * u;
    if (!curvature) return {weighted * slope + clipped_factor * clipped_slope, gradient, cost};
    const V squares =
        weighted * slope * weight * weight + clipped_factor * clipped_slope * clipped_weight * clipped_weight;
    return {kernel::at_least(squares, V(1e-30)), gradient, cost};
  }
};

// kMean: f is the mean of f(wi, wo) and f(wo, wi), which is what a cell holds; for materials that are
// reciprocal the second is the first.
template <class S, template <class> class ModelRows, template <class> class LossOf, bool kMean>
struct GramOf {
  using V = Lanes<S>;
  using Model = ModelRows<S>;
  using Terms = typename Model::Terms;
  static constexpr int n = Model::coefficients;
  static constexpr std::size_t kVectors = kRowLength<S> / V::size;

  struct Nothing {};
  // What the channels of a sample share.
  struct Shared {
    Terms terms;
    std::conditional_t<kMean, Terms, Nothing> other;
    V inverse_cos_i;
    V to_cos_i;  // turns f(wo, wi) cos_o into f(wo, wi) cos_i
  };

  // Sums over all blocks.
  Products<S, n + 1> products[3];
  V total;
  // Of the block at hand.
  alignas(64) BlockRows<S, n + 1> rows;
  Shared shared[kVectors];
  V y[kVectors];
  Counted<S> counted[kVectors];

  static HWY_FLATTEN void run(const GramJob& job, Gram& gram) {
    const Model model(job.coefficients);
    const LossOf<S> loss(job);
    const Reader<S> reader(job);
    GramOf of;
    for (auto& channel : of.products) channel.clear();
    of.total = V(0.0);
    for (std::size_t first = 0; first < job.count; first += kRowLength<S>) {
      const std::size_t length = job.count - first < kRowLength<S> ? job.count - first : kRowLength<S>;
      of.share(model, reader, first, length);
      for (int c = 0; c < 3; ++c) {
        of.count(model, loss, reader, c, first, length);
        of.fill(model, reader, c, first, length);
        add_products<S, n + 1>(of.rows, length, of.products[c]);
      }
    }
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i <= n; ++i) {
        for (int j = i; j <= n; ++j) {
          gram.channel[c][i * kGramSide + j] = static_cast<double>(sum(of.products[c].sums[i][j]));
        }
      }
    }
    gram.cost = static_cast<double>(sum(of.total));
  }

  HWY_INLINE void share(const Model& model, const Reader<S>& reader, std::size_t first, std::size_t length) {
    for (std::size_t at = 0; at < length; at += V::size) {
      const kernel::Geometry<V> g = reader.geometry(first + at);
      const kernel::GeometryLogs<V> logs = reader.logs(first + at);
      Shared& to = shared[at / V::size];
      to.terms = model.terms(g, logs);
      to.inverse_cos_i = V(1.0) / g.cos_i;
      if constexpr (kMean) {
        to.other = model.terms(swapped(g), logs);
        to.to_cos_i = g.cos_i / g.cos_o;
      }
    }
  }

  // Roots and quotients of a sample wait for each other: in short loops those of neighbours overlap.
  HWY_INLINE void count(const Model& model, const LossOf<S>& loss, const Reader<S>& reader, int c,
                        std::size_t first, std::size_t length) {
    for (std::size_t k = 0; k < length / V::size; ++k) {
      y[k] = model.y(c, shared[k].terms);
      if constexpr (kMean) y[k] = V(0.5) * (y[k] + model.y(c, shared[k].other) * shared[k].to_cos_i);
    }
    for (std::size_t at = 0; at < length; at += V::size) {
      const std::size_t k = at / V::size;
      counted[k] =
          loss.count(y[k], reader.cos_i(first + at), shared[k].inverse_cos_i, reader.target(c, first + at),
                     reader.clipped_target(c, first + at), reader.clipped_share(first + at));
    }
    for (std::size_t k = 0; k < length / V::size; ++k) {
      const V slope = sqrt(counted[k].slope);
      counted[k] = {slope, counted[k].residual / slope, counted[k].cost};
    }
  }

  HWY_INLINE void fill(const Model& model, const Reader<S>& reader, int c, std::size_t first,
                       std::size_t length) {
    for (std::size_t at = 0; at < length; at += V::size) {
      const Shared& s = shared[at / V::size];
      const Counted<S>& value = counted[at / V::size];
      const V weight = reader.weight(first + at);
      const V slope = weight * value.slope;
      V dy[n];
      if constexpr (kMean) {
        V other[n];
        model.derivatives(c, s.terms, V(0.5) * slope, dy);
        model.derivatives(c, s.other, V(0.5) * slope * s.to_cos_i, other);
        for (int k = 0; k < n; ++k) dy[k] = dy[k] + other[k];
      } else {
        model.derivatives(c, s.terms, slope, dy);
      }
      for (int k = 0; k < n; ++k) dy[k].store(rows[k] + at);
      (weight * value.residual).store(rows[n] + at);
      total = multiply_add(weight * weight, value.cost, total);
    }
  }
};

template <template <class> class ModelRows, bool kMean>
void gram_of(const GramJob& job, Gram& gram) {
  if (job.loss == BRDFIT_LOSS_LOG_RATIO && job.robust_width > 0.0 && job.clipped_width > 0.0) {
    // The mean of whole terms is too rare to be compiled once more.
    if constexpr (!kMean) {
      if (job.single != nullptr && !job.curvature)
        return GramOf<float, ModelRows, RobustLogRatio, kMean>::run(job, gram);
    }
    return GramOf<double, ModelRows, RobustLogRatio, kMean>::run(job, gram);
  }
  GramOf<double, ModelRows, AnyLoss, kMean>::run(job, gram);
}

template <class ModelLanes, bool kMean>
HWY_FLATTEN double cost_of(const GramJob& job) {
  const ModelLanes model(job.coefficients);
  const AnyLoss<double> loss(job);
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
      const Counted<double> counted =
          loss.count(y, g.cos_i, inverse_cos_i, V::load(job.target[c] + at),
                     V::load(job.clipped_target[c] + at), V::load(job.clipped_share + at));
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
