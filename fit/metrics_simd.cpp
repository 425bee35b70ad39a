// Vectorised sums of the error measures. Compiled once for every instruction set.
//
// In single precision, which halves the time and costs the sums less than 1e-6 of themselves: differences are
// taken in double, and every term is written as that difference times a factor without cancellation.
#include "brdf/kernel/math.h"
#include "brdf/simd/jobs.h"
#include "brdf/simd/lanes.h"
#include "fit/metric_sums.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {
namespace {

using F = Lanes<float>;
HWY_INLINE F squared(F x) {
  return x * x;
}

// x^(1/12) for x >= 0; small but above 0 at 0.
HWY_INLINE F twelfth_root(F x) {
  return exp(log(kernel::at_least(x, F(1e-37))) * F(1.0 / 12.0));
}

// Two numbers >= 0 and their difference, which is known better than they are.
struct Compared {
  F a;
  F b;
  F difference;  // a - b
};

// |ln((a + floor) / (b + floor))|.
HWY_INLINE F log_ratio(const Compared& x) {
  const F smaller = kernel::at_most(x.a, x.b) + F(1e-3);
  return F::of(hn::Log1p(F::Tag(), (abs(x.difference) / smaller).v));
}

// min(a, 1) and min(b, 1).
HWY_INLINE Compared clipped(const Compared& x) {
  const F one(1.0);
  const Compared result = {kernel::at_most(x.a, one), kernel::at_most(x.b, one), x.difference};
  const auto is_cut = kernel::at_least(x.a, x.b) > one;
  return {result.a, result.b, select(is_cut, result.a - result.b, x.difference)};
}

// cbrt(a) - cbrt(b) = (a - b) / (cbrt(a)^2 + cbrt(a) cbrt(b) + cbrt(b)^2).
HWY_INLINE F cube_root_difference(const Compared& x, F root_a, F root_b) {
  const F p = squared(squared(root_a));
  const F q = squared(squared(root_b));
  return x.difference / (p * p + p * q + q * q);
}

// The difference of sRGB transfers (IEC 61966-2-1) of numbers in [0, 1], with their twelfth roots p and q:
// x^(1/2.4) is p^5, and p^5 - q^5 = (p^12 - q^12) (p^4 + p^3 q + ... + q^4) / (p^11 + p^10 q + ... + q^11).
HWY_INLINE F srgb_difference(const Compared& x, F p, F q) {
  const F threshold(0.0031308);
  const F slope(12.92);
  const F scale(1.055);
  const F p2 = p * p;
  const F q2 = q * q;
  const F pq = p * q;
  const F p3 = p2 * p;
  const F q3 = q2 * q;
  const F fourths = p2 * p2 + pq * (p2 + pq + q2) + q2 * q2;
  const F elevenths = (p2 + pq + q2) * (p3 + q3) * (p3 * p3 + q3 * q3);
  const F both_bright = scale * x.difference * (fourths / elevenths);
  const F of_a = select(x.a > threshold, scale * (p2 * p3) - F(0.055), slope * x.a);
  const F of_b = select(x.b > threshold, scale * (q2 * q3) - F(0.055), slope * x.b);
  const F mixed = select(kernel::at_least(x.a, x.b) > threshold, of_a - of_b, slope * x.difference);
  return select(kernel::at_most(x.a, x.b) > threshold, both_bright, mixed);
}

struct Sums {
  F log_ratio, relative, cube_root, srgb, cosine_l2, clipped;
};

HWY_INLINE void add(Sums& s, const Compared& f, F cos_i, F weight) {
  const F one(1.0);
  const F pi(BRDF_PI);
  const F root_of_pi(1.100092378963587);  // twelfth
  const Compared seen = {f.a * cos_i, f.b * cos_i, f.difference * cos_i};
  const F root_a = twelfth_root(seen.a);
  const F root_b = twelfth_root(seen.b);
  const Compared shown = clipped({pi * seen.a, pi * seen.b, pi * seen.difference});
  const F shown_difference = srgb_difference(shown, kernel::at_most(root_of_pi * root_a, one),
                                             kernel::at_most(root_of_pi * root_b, one));
  s.log_ratio = multiply_add(weight, log_ratio(seen), s.log_ratio);
  s.relative = multiply_add(weight, abs(f.difference) / (f.b + F(1e-3)), s.relative);
  s.cube_root = multiply_add(weight, squared(cube_root_difference(seen, root_a, root_b)), s.cube_root);
  s.srgb = multiply_add(weight, squared(shown_difference), s.srgb);
  s.cosine_l2 = multiply_add(weight, squared(seen.difference), s.cosine_l2);
  s.clipped = multiply_add(weight, squared(clipped(f).difference), s.clipped);
}

// A block of one channel in single precision.
struct Block {
  float a[kBlock];
  float b[kBlock];
  float difference[kBlock];

  HWY_INLINE Compared at(std::size_t k) const {
    return {F::load(a + k), F::load(b + k), F::load(difference + k)};
  }
};

template <class T>
HWY_INLINE void narrow(const double* a, const T* b, Block& to) {
  for (std::size_t k = 0; k < kBlock; ++k) {
    const T from_b = b[k] > T{0} ? b[k] : T{0};
    to.a[k] = static_cast<float>(a[k]);
    to.b[k] = static_cast<float>(from_b);
    to.difference[k] = static_cast<float>(a[k] - static_cast<double>(from_b));
  }
}

HWY_INLINE void narrow(const double* from, float* to) {
  for (std::size_t k = 0; k < kBlock; ++k) to[k] = static_cast<float>(from[k]);
}

// The terms of a block are added in single precision, the blocks' sums in double.
HWY_INLINE void add_to(fit::MetricSums& sums, const Sums& s) {
  sums.log_ratio += static_cast<double>(sum(s.log_ratio));
  sums.relative += static_cast<double>(sum(s.relative));
  sums.cube_root += static_cast<double>(sum(s.cube_root));
  sums.srgb += static_cast<double>(sum(s.srgb));
  sums.cosine_l2 += static_cast<double>(sum(s.cosine_l2));
  sums.clipped += static_cast<double>(sum(s.clipped));
}

}  // namespace

HWY_FLATTEN void sum_metrics(const fit::MetricJob& job, fit::MetricSums& sums) {
  const F zero(0.0);
  float cos_i[kBlock];
  Block block;
  for (std::size_t first = 0; first < job.count; first += kBlock) {
    narrow(job.cos_i + first, cos_i);
    Sums s = {zero, zero, zero, zero, zero, zero};
    for (int c = 0; c < 3; ++c) {
      narrow(job.f[c] + first, job.r[c] + first, block);
      for (std::size_t k = 0; k < kBlock; k += F::size) {
        add(s, block.at(k), F::load(cos_i + k), F::load(job.weight + first + k));
      }
    }
    add_to(sums, s);
  }
}

HWY_FLATTEN double sum_order_gap(const fit::MetricJob& job) {
  float cos_i[kBlock];
  Block block;
  double total = 0.0;
  for (std::size_t first = 0; first < job.count; first += kBlock) {
    narrow(job.cos_i + first, cos_i);
    F s(0.0);
    for (int c = 0; c < 3; ++c) {
      narrow(job.f[c] + first, job.f_swapped[c] + first, block);
      for (std::size_t k = 0; k < kBlock; k += F::size) {
        const Compared f = block.at(k);
        const F cosine = F::load(cos_i + k);
        const F gap = log_ratio({f.a * cosine, f.b * cosine, f.difference * cosine});
        s = multiply_add(F::load(job.weight + first + k), gap, s);
      }
    }
    total += static_cast<double>(sum(s));
  }
  return total;
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA
