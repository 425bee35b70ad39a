// Vectorised sums of the error measures. Compiled once for every instruction set.
#include "brdf/kernel/math.h"
#include "brdf/simd/jobs.h"
#include "brdf/simd/lanes.h"
#include "fit/metric_sums.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {
namespace {

using V = Lanes<double>;

HWY_INLINE V log_of_floored(V x) {
  return log(kernel::at_least(x, V(1e-300)));
}

// sRGB transfer of x in [0, 1] (IEC 61966-2-1), with log x at hand.
HWY_INLINE V srgb_from_log(V x, V log_x) {
  const V bright = V(1.055) * exp(log_x * V(1.0 / 2.4)) - V(0.055);
  return select(x > V(0.0031308), bright, V(12.92) * x);
}

HWY_INLINE V log_ratio(V a, V b) {
  return abs(log((a + V(1e-3)) / (b + V(1e-3))));
}

HWY_INLINE V squared(V x) {
  return x * x;
}

struct Sums {
  V log_ratio, relative, cube_root, srgb, cosine_l2, clipped;
};

HWY_INLINE void add(Sums& s, V f, V r, V cos_i, V weight) {
  const V one(1.0);
  const V fc = f * cos_i;
  const V rc = r * cos_i;
  const V log_fc = log_of_floored(fc);
  const V log_rc = log_of_floored(rc);
  const V third(1.0 / 3.0);
  const V pi(BRDF_PI);
  const V log_pi(1.1447298858494001741);
  const V cube = exp(log_fc * third) - exp(log_rc * third);
  const V shown_f = srgb_from_log(kernel::at_most(pi * fc, one), kernel::at_most(log_pi + log_fc, V(0.0)));
  const V shown_r = srgb_from_log(kernel::at_most(pi * rc, one), kernel::at_most(log_pi + log_rc, V(0.0)));
  s.log_ratio = multiply_add(weight, log_ratio(fc, rc), s.log_ratio);
  s.relative = multiply_add(weight, abs(f - r) / (r + V(1e-3)), s.relative);
  s.cube_root = multiply_add(weight, squared(cube), s.cube_root);
  s.srgb = multiply_add(weight, squared(shown_f - shown_r), s.srgb);
  s.cosine_l2 = multiply_add(weight, squared(fc - rc), s.cosine_l2);
  s.clipped = multiply_add(weight, squared(kernel::at_most(f, one) - kernel::at_most(r, one)), s.clipped);
}

}  // namespace

HWY_FLATTEN void sum_metrics(const fit::MetricJob& job, fit::MetricSums& sums) {
  const V zero(0.0);
  Sums s = {zero, zero, zero, zero, zero, zero};
  for (std::size_t at = 0; at < job.count; at += V::size) {
    const V cos_i = V::load(job.cos_i + at);
    const V weight = V::load(job.weight + at);
    for (int c = 0; c < 3; ++c) add(s, V::load(job.f[c] + at), V::load(job.r[c] + at), cos_i, weight);
  }
  sums.log_ratio += sum(s.log_ratio);
  sums.relative += sum(s.relative);
  sums.cube_root += sum(s.cube_root);
  sums.srgb += sum(s.srgb);
  sums.cosine_l2 += sum(s.cosine_l2);
  sums.clipped += sum(s.clipped);
}

HWY_FLATTEN double sum_log_ratio(const fit::MetricJob& job) {
  V total(0.0);
  for (std::size_t at = 0; at < job.count; at += V::size) {
    const V cos_i = V::load(job.cos_i + at);
    const V weight = V::load(job.weight + at);
    for (int c = 0; c < 3; ++c) {
      const V ratio = log_ratio(V::load(job.f[c] + at) * cos_i, V::load(job.r[c] + at) * cos_i);
      total = multiply_add(weight, ratio, total);
    }
  }
  return sum(total);
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA
