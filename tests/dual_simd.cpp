// Dual numbers over lanes through every operation, for the test of them. Compiled once for every instruction
// set.
#include "brdf/simd/dual.h"
#include "tests/dual_job.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {
namespace {

using V = Lanes<double>;
using D = Dual<double, 2>;

void store(const D& from, DualJob& job, std::size_t operation, std::size_t at) {
  from.a.store(job.value[operation] + at);
  for (int k = 0; k < 2; ++k) from.d[k].store(job.slope[k][operation] + at);
}

}  // namespace

HWY_FLATTEN void run_dual(DualJob& job) {
  for (std::size_t at = 0; at < kDualCount; at += V::size) {
    const V plain_x = V::load(job.x + at);
    const V plain_y = V::load(job.y + at);
    const D x(plain_x, 0);
    const D y(plain_y, 1);
    std::size_t operation = 0;
    for (const D& result : {x + y, x - y, x * y, x / y, x + plain_y, plain_x + y, x - plain_y, x * plain_y,
                            plain_x * y, plain_x / y, select(x > y, x, y), select(x < y, x, y), sqrt(x * y),
                            exp(x - y), log(x * x * y), D(3.0) * x / (D(plain_y) + x)}) {
      store(result, job, operation++, at);
    }
  }
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA
