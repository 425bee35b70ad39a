// Vectorised sums of the error measures. Compiled once for every instruction set.
//
// In single precision, which costs the sums less than 1e-6 of themselves: differences are taken of more than
// that, and every term is written as that difference times a factor without cancellation.
#include "brdf/kernel/math.h"
#include "brdf/simd/jobs.h"
#include "brdf/simd/lanes.h"
#include "fit/fast_roots.h"
#include "fit/metric_sums.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {
namespace {

using F = Lanes<float>;
constexpr float kFloor = 1e-3F;  // of log-ratio and relative

HWY_INLINE F squared(F x) {
  return x * x;
}

// Two numbers >= 0 and their difference, which is known better than they are.
struct Compared {
  F a;
  F b;
  F difference;  // a - b

  friend HWY_INLINE Compared operator*(const Compared& x, F y) {
    return {x.a * y, x.b * y, x.difference * y};
  }
};

// (larger + floor) / (smaller + floor) - 1.
HWY_INLINE F rise(const Compared& x) {
  return abs(x.difference) * reciprocal(smaller(x.a, x.b) + F(kFloor));
}

// The sum of three channels' |ln((a + floor) / (b + floor))|: the logarithm of the product.
HWY_INLINE F log_ratios(const F (&rises)[3]) {
  const F product_may_overflow(1e12);
  const F highest = larger(larger(rises[0], rises[1]), rises[2]);
  if (!hn::AllFalse(F::Tag(), hn::Gt(highest.v, product_may_overflow.v))) {
    return log_of_1_plus(rises[0]) + log_of_1_plus(rises[1]) + log_of_1_plus(rises[2]);
  }
  const F two = multiply_add(rises[0], rises[1], rises[0] + rises[1]);
  return log_of_1_plus(multiply_add(two, rises[2], two + rises[2]));
}

// min(a, 1) - min(b, 1).
HWY_INLINE F clipped_difference(const Compared& x) {
  const F one(1.0);
  const auto is_cut = larger(x.a, x.b) > one;
  return select(is_cut, smaller(x.a, one) - smaller(x.b, one), x.difference);
}

struct RootDifferences {
  F cube;  // cbrt(a) - cbrt(b)
  F srgb;  // of the transfers (IEC 61966-2-1) of min(pi a, 1) and min(pi b, 1)
};

// From the twelfth roots p and q of a and b: p - q = (p^12 - q^12) / (p^11 + p^10 q + ... + q^11), and the
// differences of third and fifth powers are that times sums without cancellation.
HWY_INLINE RootDifferences root_differences(const Compared& x, F p, F q) {
  const F p2 = p * p;
  const F q2 = q * q;
  const F pq = p * q;
  const F p3 = p2 * p;
  const F q3 = q2 * q;
  const F squares = p2 + q2;
  const F middle = squares + pq;
  const F elevenths = middle * (p3 + q3) * multiply_add(p3, p3, q3 * q3);
  const F step = x.difference * reciprocal(elevenths);
  const F fourths = multiply_add(pq, middle, multiply_add(p2, p2, q2 * q2));

  const F threshold(0.0031308 * BRDF_INV_PI);
  const F slope(12.92 * BRDF_PI);
  const F scale(1.055 * 1.6111863737983265);  // pi^(5/12)
  const F one(1.0);
  const F low = smaller(x.a, x.b);
  const F high = larger(x.a, x.b);
  const auto transfer = [&](F seen, F root_5) HWY_ATTR {
    const F value = select(seen > threshold, multiply_add(scale, root_5, F(-0.055)), slope * seen);
    return smaller(value, one);
  };
  const F mixed = transfer(x.a, p2 * p3) - transfer(x.b, q2 * q3);
  const F unless_bright = select(high > threshold, mixed, slope * x.difference);
  const F unless_cut = select(low > threshold, scale * (step * fourths), unless_bright);
  return {step * (p + q) * squares, select(high > F(BRDF_INV_PI), mixed, unless_cut)};
}

struct Sums {
  F weight, log_ratio, relative, cube_root, srgb, cosine_l2, clipped;
};

// One channel; log-ratios are added for three at once. root_a, root_b: twelfth roots of what is seen.
HWY_INLINE void add(Sums& s, const Compared& f, const Compared& seen, F root_a, F root_b, F weight) {
  const RootDifferences roots = root_differences(seen, root_a, root_b);
  s.relative = multiply_add(weight, abs(f.difference) * reciprocal(f.b + F(kFloor)), s.relative);
  s.cube_root = multiply_add(weight, squared(roots.cube), s.cube_root);
  s.srgb = multiply_add(weight, squared(roots.srgb), s.srgb);
  s.cosine_l2 = multiply_add(weight, squared(seen.difference), s.cosine_l2);
  s.clipped = multiply_add(weight, squared(clipped_difference(f)), s.clipped);
}

// Numbers in double precision as the sum of two floats.
struct Split {
  float high[kLineBlock];
  float low[kLineBlock];

  explicit HWY_INLINE Split(const double* from) {
    for (std::size_t k = 0; k < kLineBlock; ++k) {
      high[k] = static_cast<float>(from[k]);
      low[k] = static_cast<float>(from[k] - static_cast<double>(high[k]));
    }
  }
};

HWY_INLINE void narrow(const double* from, float* to) {
  for (std::size_t k = 0; k < kLineBlock; ++k) to[k] = static_cast<float>(from[k]);
}

// Entries at.. of one channel of r.
HWY_INLINE F load_r(const fit::MetricSide& side, int channel, std::size_t at) {
  const float* r = side.r[channel];
  const F::Tag d;
  if (side.step > 0) return F::load(r + at);
  return F::of(hn::Reverse(d, hn::LoadU(d, r - at - (F::size - 1))));
}

// How often the entries at.. count; r: of any channel.
HWY_INLINE F weight_at(const fit::MetricSide& side, F r, std::size_t at) {
  const F zero(0.0);
  const F place = F::of(hn::Iota(F::Tag(), static_cast<float>(at)));
  F weight = side.weight != nullptr ? F::load(side.weight + at) : F(1.0);
  weight = select(r < zero, zero, weight);
  weight = select(place < F(static_cast<double>(side.begin)), zero, weight);
  return select(place < F(static_cast<double>(side.end)), weight, zero);
}

// The terms of a job are added in single precision, the jobs' sums in double.
HWY_INLINE void add_to(fit::MetricSums& sums, const Sums& s) {
  sums.weight += static_cast<double>(sum(s.weight));
  sums.log_ratio += static_cast<double>(sum(s.log_ratio));
  sums.relative += static_cast<double>(sum(s.relative));
  sums.cube_root += static_cast<double>(sum(s.cube_root));
  sums.srgb += static_cast<double>(sum(s.srgb));
  sums.cosine_l2 += static_cast<double>(sum(s.cosine_l2));
  sums.clipped += static_cast<double>(sum(s.clipped));
}

}  // namespace

HWY_FLATTEN void sum_metrics(const fit::MetricJob& job, fit::MetricSums& sums) {
  static_assert(kLineBlock % F::size == 0);
  const F zero(0.0);
  Sums s = {zero, zero, zero, zero, zero, zero, zero};
  float cosines[2][kLineBlock];
  for (std::size_t first = 0; first < job.count; first += kLineBlock) {
    const Split f[3] = {Split(job.f[0] + first), Split(job.f[1] + first), Split(job.f[2] + first)};
    for (int side = 0; side < job.side_count; ++side) narrow(job.sides[side].cos_i + first, cosines[side]);
    for (std::size_t k = 0; k < kLineBlock; k += F::size) {
      F root_f[3];
      for (int c = 0; c < 3; ++c) root_f[c] = twelfth_root(F::load(f[c].high + k));
      for (int i = 0; i < job.side_count; ++i) {
        const fit::MetricSide& side = job.sides[i];
        const F cos_i = F::load(cosines[i] + k);
        const F root_cos = twelfth_root(cos_i);
        F r[3];
        F root_r[3];
        F rises[3];
        for (int c = 0; c < 3; ++c) r[c] = load_r(side, c, first + k);
        const F weight = weight_at(side, r[0], first + k);
        s.weight = s.weight + weight;
        for (int c = 0; c < 3; ++c) {
          r[c] = select(weight > zero, r[c], zero);
          root_r[c] = twelfth_root(r[c]);
        }
        for (int c = 0; c < 3; ++c) {
          const F a = F::load(f[c].high + k);
          const Compared x = {a, r[c], (a - r[c]) + F::load(f[c].low + k)};
          const Compared seen = x * cos_i;
          rises[c] = rise(seen);
          add(s, x, seen, root_f[c] * root_cos, root_r[c] * root_cos, weight);
        }
        s.log_ratio = multiply_add(weight, log_ratios(rises), s.log_ratio);
      }
    }
  }
  add_to(sums, s);
}

HWY_FLATTEN double sum_order_gap(const fit::MetricJob& job) {
  F s(0.0);
  float a[3][kLineBlock];
  float b[3][kLineBlock];
  float difference[3][kLineBlock];
  float cos_i[kLineBlock];
  for (std::size_t first = 0; first < job.count; first += kLineBlock) {
    for (int c = 0; c < 3; ++c) {
      const double* f = job.f[c] + first;
      const double* swapped = job.f_swapped[c] + first;
      narrow(f, a[c]);
      narrow(swapped, b[c]);
      for (std::size_t k = 0; k < kLineBlock; ++k) difference[c][k] = static_cast<float>(f[k] - swapped[k]);
    }
    for (int i = 0; i < job.side_count; ++i) {
      const fit::MetricSide& side = job.sides[i];
      narrow(side.cos_i + first, cos_i);
      for (std::size_t k = 0; k < kLineBlock; k += F::size) {
        const F weight = weight_at(side, load_r(side, 0, first + k), first + k);
        const F cosine = F::load(cos_i + k);
        F rises[3];
        for (int c = 0; c < 3; ++c) {
          const Compared x = {F::load(a[c] + k), F::load(b[c] + k), F::load(difference[c] + k)};
          rises[c] = rise(x * cosine);
        }
        s = multiply_add(weight, log_ratios(rises), s);
      }
    }
  }
  return static_cast<double>(sum(s));
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA
