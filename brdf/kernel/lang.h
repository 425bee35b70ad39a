// The dialect of the kernel headers: the common subset of C++ and GLSL in which every reflectance model is
// written once.
//
// Real is the type of material parameters and results; Geo is the type of directions. In C++ both are
// template parameters (double, float, ceres::Jet with double geometry, SIMD lanes); in GLSL both are float.
// Keeping directions out of the Jets saves their derivatives.
//
// Rules of the dialect: scalar functions and plain structs; literals as REAL(0.5) or GEO(0.5); select()
// instead of branches on values; branches only on uniform ints (options); no default arguments; no clamps on
// parameters.
#ifndef BRDFIT_BRDF_KERNEL_LANG_H_
#define BRDFIT_BRDF_KERNEL_LANG_H_

#ifdef __cplusplus

#include <cmath>

// A function of parameters and geometry, of parameters only, of geometry only.
#define BRDF_FUNCTION              \
  template <class Real, class Geo> \
  inline
#define BRDF_REAL_FUNCTION \
  template <class Real>    \
  inline
#define BRDF_GEO_FUNCTION \
  template <class Geo>    \
  inline
// A struct of parameters or of geometry, and its use as a type.
#define BRDF_REAL_STRUCT(name) \
  template <class Real>        \
  struct name
#define BRDF_GEO_STRUCT(name) \
  template <class Geo>        \
  struct name
#define OF_REAL(name) name<Real>
#define OF_GEO(name) name<Geo>
#define REAL(literal) Real(literal)
#define GEO(literal) Geo(literal)
// A geometry value used as a value of the parameter type.
#define TO_REAL(value) Real(value)
#define BRDF_NAMESPACE_BEGIN namespace brdfit::kernel {
#define BRDF_NAMESPACE_END }

BRDF_NAMESPACE_BEGIN
// Unqualified calls in kernels find these for double and float, and by argument-dependent lookup the
// overloads of Jets and SIMD lanes.
using std::exp;
using std::log;
using std::sqrt;
template <class T>
inline T select(bool condition, const T& yes, const T& no) {
  return condition ? yes : no;
}

// Where terms cancel, single precision needs more than the plain formula, which serves every other type.
// glsl_float.h has the same functions for GLSL.

// a . b, to the last digits even where its terms cancel.
template <class T>
inline T accurate_dot(T a_x, T a_y, T a_z, T b_x, T b_y, T b_z) {
  return a_x * b_x + a_y * b_y + a_z * b_z;
}
inline float accurate_dot(float a_x, float a_y, float a_z, float b_x, float b_y, float b_z) {
  return static_cast<float>(
      accurate_dot<double>(double{a_x}, double{a_y}, double{a_z}, double{b_x}, double{b_y}, double{b_z}));
}

// By how much numbers whose squares add up to `sum` are to be multiplied before they are squared again, lest
// their squares vanish.
template <class T>
inline T scale_before_squares(T) {
  return T(1.0);
}
inline float scale_before_squares(float sum) {
  return sum > 1e-30F ? 1.0F : 0x1p100F;
}

// log(x) for x > 0 from x and 1 - x, with all digits where x is close to 1.
template <class T>
inline T accurate_log(T x, T) {
  return log(x);
}
inline float accurate_log(float x, float one_minus_x) {
  return one_minus_x < 0.5F ? std::log1p(-one_minus_x) : std::log(x);
}

// 1 - exp(x) for x <= 0 from x and exp(x), with all digits where x is close to 0.
template <class T>
inline T one_minus_exp(T, T exp_x) {
  return T(1.0) - exp_x;
}
inline float one_minus_exp(float x, float) {
  return -std::expm1(x);
}
BRDF_NAMESPACE_END

#else  // GLSL

#define Real float
#define Geo float
#define BRDF_FUNCTION
#define BRDF_REAL_FUNCTION
#define BRDF_GEO_FUNCTION
#define BRDF_REAL_STRUCT(name) struct name
#define BRDF_GEO_STRUCT(name) struct name
#define OF_REAL(name) name
#define OF_GEO(name) name
#define REAL(literal) (literal)
#define GEO(literal) (literal)
#define TO_REAL(value) (value)
#define BRDF_NAMESPACE_BEGIN
#define BRDF_NAMESPACE_END

#include "glsl_float.h"

#endif

#endif  // BRDFIT_BRDF_KERNEL_LANG_H_
