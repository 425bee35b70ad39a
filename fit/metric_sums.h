// Sums behind the error measures, as plain data for vector code.
#ifndef BRDFIT_FIT_METRIC_SUMS_H_
#define BRDFIT_FIT_METRIC_SUMS_H_

#include <cstddef>

namespace brdfit::fit {

// Entries with weight 0 are left out of every sum.
struct MetricJob {
  const double* f[3] = {};  // sr^-1
  const double* r[3] = {};
  const double* cos_i = nullptr;
  const double* weight = nullptr;  // 0 or a count
  std::size_t count = 0;           // a multiple of simd::kBlock
};

struct MetricSums {
  double log_ratio = 0.0;
  double relative = 0.0;
  double cube_root = 0.0;
  double srgb = 0.0;
  double cosine_l2 = 0.0;
  double clipped = 0.0;
};

using MetricFunction = void (*)(const MetricJob&, MetricSums&);
// Sum over channels of weight |ln((a cos_i + 1e-3) / (b cos_i + 1e-3))|, a in f and b in r of the job.
using LogRatioFunction = double (*)(const MetricJob&);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_METRIC_SUMS_H_
