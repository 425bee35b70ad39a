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

float select(bool condition, float yes, float no) {
  return condition ? yes : no;
}

#endif

#endif  // BRDFIT_BRDF_KERNEL_LANG_H_
