// Vectorised colour differences. Compiled once for every instruction set.
//
// Colours are computed in double precision, as PQ raises to the 79th power; stored in single precision, a
// difference is good to 1e-4 of a just noticeable one.
#include "brdf/kernel/math.h"
#include "brdf/simd/jobs.h"
#include "brdf/simd/lanes.h"
#include "render/delta_e_job.h"
#include "render/itp.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {
namespace {

using F = Lanes<float>;
using D = Lanes<double>;

HWY_INLINE void narrow(const double* from, float* to) {
  for (std::size_t k = 0; k < kBlock; ++k) to[k] = static_cast<float>(from[k]);
}

HWY_INLINE F difference(const render::DeltaEJob& job, std::size_t column, std::size_t at) {
  return F::load(job.a[column] + at) - F::load(job.b[column] + at);
}

}  // namespace

HWY_FLATTEN void convert_to_itp(const render::ItpJob& job) {
  double wide[3][kBlock];
  const D pi(BRDF_PI);
  for (std::size_t first = 0; first < job.count; first += kBlock) {
    for (std::size_t k = 0; k < kBlock; k += D::size) {
      const std::size_t at = first + k;
      const render::Itp<D> itp = render::itp_of(
          pi * D::load(job.f_cos[0] + at), pi * D::load(job.f_cos[1] + at), pi * D::load(job.f_cos[2] + at));
      itp.i.store(wide[0] + k);
      itp.t.store(wide[1] + k);
      itp.p.store(wide[2] + k);
    }
    for (std::size_t c = 0; c < 3; ++c) narrow(wide[c], job.itp[c] + first);
  }
}

// The terms of a block are added in single precision, the blocks' sums in double.
HWY_FLATTEN render::DeltaESum sum_delta_e(const render::DeltaEJob& job) {
  const F zero(0.0);
  const F one(1.0);
  render::DeltaESum total;
  for (std::size_t first = 0; first < job.count; first += kBlock) {
    F distance = zero;
    F pairs = zero;
    for (std::size_t k = 0; k < kBlock; k += F::size) {
      const std::size_t at = first + k;
      const F i = difference(job, 0, at);
      const F t = difference(job, 1, at);
      const F p = difference(job, 2, at);
      const F least = kernel::at_most(F::load(job.a[0] + at), F::load(job.b[0] + at));
      const F counts = select(least < zero, zero, one);
      distance = multiply_add(counts, sqrt(i * i + t * t + p * p), distance);
      pairs = pairs + counts;
    }
    total.distance += static_cast<double>(sum(distance));
    total.pairs += static_cast<double>(sum(pairs));
  }
  return total;
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA
