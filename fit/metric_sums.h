// Sums behind the error measures, as plain data for vector code.
#ifndef BRDFIT_FIT_METRIC_SUMS_H_
#define BRDFIT_FIT_METRIC_SUMS_H_

#include <cstddef>

namespace brdfit::fit {

// Two sets of values to compare, column by column. Entries with weight 0 are left out of every sum, but must
// be finite.
struct MetricJob {
  const double* f[3] = {};          // sr^-1
  const float* r[3] = {};           // negative where nothing was measured: then with weight 0
  const double* f_swapped[3] = {};  // f(wo, wi); only for sum_order_gap
  const double* cos_i = nullptr;
  const float* weight = nullptr;  // 0 or a count
  std::size_t count = 0;          // a multiple of simd::kBlock
};

struct MetricSums {
  double log_ratio = 0.0;
  double relative = 0.0;
  double cube_root = 0.0;
  double srgb = 0.0;
  double cosine_l2 = 0.0;
  double clipped = 0.0;

  MetricSums& operator+=(const MetricSums& other) {
    log_ratio += other.log_ratio;
    relative += other.relative;
    cube_root += other.cube_root;
    srgb += other.srgb;
    cosine_l2 += other.cosine_l2;
    clipped += other.clipped;
    return *this;
  }
};

// Adds up each measure's terms of f against r, over channels.
using MetricFunction = void (*)(const MetricJob&, MetricSums&);

// Sum over channels of weight |ln((f cos_i + 1e-3) / (f_swapped cos_i + 1e-3))|.
using OrderGapFunction = double (*)(const MetricJob&);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_METRIC_SUMS_H_
