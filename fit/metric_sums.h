// Sums behind the error measures, as plain data for vector code.
#ifndef BRDFIT_FIT_METRIC_SUMS_H_
#define BRDFIT_FIT_METRIC_SUMS_H_

#include <cstddef>

#include "brdf/simd/jobs.h"

namespace brdfit::simd {
enum class Isa;
}

namespace brdfit::fit {

// What f is compared with, column by column. Entries that are left out of every sum must be readable all the
// same.
struct MetricSide {
  const float* r[3] = {};  // entry k is r[c][step k]; negative where nothing was measured: left out
  int step = 1;            // or -1
  std::size_t begin = 0;   // entries before begin and from end on are left out as well
  std::size_t end = 0;
  const double* cos_i = nullptr;
  const float* weight = nullptr;  // how often each counts, once where null
};

struct MetricJob {
  const double* f[3] = {};          // sr^-1
  const double* f_swapped[3] = {};  // f(wo, wi); only for sum_order_gap
  std::size_t count = 0;            // a multiple of simd::kLineBlock
  // One, or two that the same values of f are compared with: a line of a table and its mirror image.
  MetricSide sides[2];
  int side_count = 1;
};

struct MetricSums {
  double weight = 0.0;
  double log_ratio = 0.0;
  double relative = 0.0;
  double cube_root = 0.0;
  double srgb = 0.0;
  double cosine_l2 = 0.0;
  double clipped = 0.0;

  MetricSums& operator+=(const MetricSums& other) {
    weight += other.weight;
    log_ratio += other.log_ratio;
    relative += other.relative;
    cube_root += other.cube_root;
    srgb += other.srgb;
    cosine_l2 += other.cosine_l2;
    clipped += other.clipped;
    return *this;
  }
};

// Adds up each measure's terms of f against r, over channels and sides.
using MetricFunction = void (*)(const MetricJob&, MetricSums&);
MetricFunction metric_function(simd::Isa isa);

// Sum over channels and sides of weight |ln((f cos_i + 1e-3) / (f_swapped cos_i + 1e-3))|.
using OrderGapFunction = double (*)(const MetricJob&);
OrderGapFunction order_gap_function(simd::Isa isa);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_METRIC_SUMS_H_
