// Plain data handed to vector code: what to evaluate, where, and into what.
#ifndef BRDFIT_BRDF_SIMD_JOBS_H_
#define BRDFIT_BRDF_SIMD_JOBS_H_

#include <cstddef>

namespace brdfit::simd {

// Vector code works on counts that are a multiple of this; callers pad their arrays.
inline constexpr std::size_t kBlock = 64;

// A model with its coefficients as the kernels take them: the members of the kernel's Shape struct in order,
// then those of its Colour struct for red, green and blue.
struct Coefficients {
  int model = 0;  // as brdfit::Model
  int masking = 0;
  int burley_g = 0;
  int diffuse = 0;
  int effects = 0;
  double shape[9] = {};
  double colour[3][5] = {};
};

// The geometry of isotropic pairs, column by column; see kernel::Geometry and kernel::GeometryLogs.
struct GeometryColumns {
  const double* cos_i = nullptr;
  const double* cos_o = nullptr;
  const double* sin_h = nullptr;
  const double* cos_h = nullptr;
  const double* cos_d = nullptr;
  const double* one_minus_cos_h = nullptr;
  const double* one_minus_cos_d = nullptr;
  const double* log_cos_h = nullptr;
  const double* log_cos_d = nullptr;
  const double* log_one_minus_cos_h = nullptr;
  const double* log_one_minus_cos_d = nullptr;
};

// Unit directions, column by column.
struct DirectionColumns {
  const double* wi_x = nullptr;
  const double* wi_y = nullptr;
  const double* wi_z = nullptr;
  const double* wo_x = nullptr;
  const double* wo_y = nullptr;
  const double* wo_z = nullptr;
};

// Lines of a table are evaluated this many at a time, and their pairs in multiples of kLineBlock.
inline constexpr std::size_t kLines = 8;
inline constexpr std::size_t kLineBlock = 16;

// Lines of isotropic pairs that share h; along a line cos_d is the same too. All pairs above the horizon.
struct LineColumns {
  double sin_h = 0.0;
  double cos_h = 1.0;
  double one_minus_cos_h = 0.0;
  double log_cos_h = 0.0;
  double log_one_minus_cos_h = 0.0;
  // One entry for each line; finite for those without pairs as well.
  double cos_d[kLines] = {};
  double one_minus_cos_d[kLines] = {};
  double log_cos_d[kLines] = {};
  double log_one_minus_cos_d[kLines] = {};
  std::size_t count[kLines] = {};  // pairs of each line, a multiple of kLineBlock
  // One line after another, each beginning a multiple of stride.
  const double* cos_i = nullptr;
  const double* cos_o = nullptr;
  std::size_t stride = 0;
};

// f(wi, wo) in sr^-1 into f, laid out as cos_i, and f(wo, wi) into swapped unless that is null.
using EvalLines = void (*)(const Coefficients&, const LineColumns&, double* const f[3],
                           double* const swapped[3]);

// f cos_i in sr^-1, 0 below the horizon, for count pairs (a multiple of kBlock) into three arrays.
using EvalColumns = void (*)(const Coefficients&, const GeometryColumns&, std::size_t count,
                             double* const out[3]);
using EvalDirections = void (*)(const Coefficients&, const DirectionColumns&, std::size_t count,
                                double* const out[3]);

}  // namespace brdfit::simd

#endif  // BRDFIT_BRDF_SIMD_JOBS_H_
