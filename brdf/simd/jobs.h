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

// f cos_i in sr^-1, 0 below the horizon, for count pairs (a multiple of kBlock) into three arrays.
using EvalColumns = void (*)(const Coefficients&, const GeometryColumns&, std::size_t count,
                             double* const out[3]);
using EvalDirections = void (*)(const Coefficients&, const DirectionColumns&, std::size_t count,
                                double* const out[3]);

}  // namespace brdfit::simd

#endif  // BRDFIT_BRDF_SIMD_JOBS_H_
