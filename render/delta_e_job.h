// Colours to compare, as plain data for vector code.
#ifndef BRDFIT_RENDER_DELTA_E_JOB_H_
#define BRDFIT_RENDER_DELTA_E_JOB_H_

#include <cstddef>

namespace brdfit::render {

// I of a colour that is not there. I of a colour is never negative.
inline constexpr float kNoColour = -1.0F;

// f cos_i in sr^-1, column by column, to I, T, P of its radiance under a light of irradiance pi.
struct ItpJob {
  const double* f_cos[3] = {};
  float* itp[3] = {};
  std::size_t count = 0;  // a multiple of simd::kBlock
};
using ItpFunction = void (*)(const ItpJob&);

// Pairs of colours; those of which one is kNoColour are left out.
struct DeltaEJob {
  const float* a[3] = {};
  const float* b[3] = {};
  std::size_t count = 0;  // a multiple of simd::kBlock
};
struct DeltaESum {
  double distance = 0.0;  // in ITP
  double pairs = 0.0;
};
using DeltaEFunction = DeltaESum (*)(const DeltaEJob&);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_DELTA_E_JOB_H_
