// Forward-mode derivatives over SIMD lanes: a value and its N partial derivatives, as the kernels' Real
// beside lanes as Geo. (ceres::Jet does the same for scalars; its Eigen members do not take lanes.)
#ifndef BRDFIT_BRDF_SIMD_DUAL_H_
#define BRDFIT_BRDF_SIMD_DUAL_H_

#include "brdf/simd/lanes.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {

template <class Scalar, int N>
struct Dual {
  using V = Lanes<Scalar>;
  V a;     // value
  V d[N];  // partial derivatives

  Dual() = default;
  explicit HWY_INLINE Dual(double x) : a(x) { clear(); }
  explicit HWY_INLINE Dual(V x) : a(x) { clear(); }
  // The k-th variable.
  HWY_INLINE Dual(V x, int k) : a(x) {
    clear();
    d[k] = V(1.0);
  }

  HWY_INLINE void clear() {
    for (int i = 0; i < N; ++i) d[i] = V(0.0);
  }

  // f(x) with f' at x.
  HWY_INLINE Dual chain(V value, V slope) const {
    Dual r;
    r.a = value;
    for (int i = 0; i < N; ++i) r.d[i] = slope * d[i];
    return r;
  }

  friend HWY_INLINE Dual operator+(const Dual& x, const Dual& y) {
    Dual r;
    r.a = x.a + y.a;
    for (int i = 0; i < N; ++i) r.d[i] = x.d[i] + y.d[i];
    return r;
  }
  friend HWY_INLINE Dual operator-(const Dual& x, const Dual& y) {
    Dual r;
    r.a = x.a - y.a;
    for (int i = 0; i < N; ++i) r.d[i] = x.d[i] - y.d[i];
    return r;
  }
  friend HWY_INLINE Dual operator*(const Dual& x, const Dual& y) {
    Dual r;
    r.a = x.a * y.a;
    for (int i = 0; i < N; ++i) r.d[i] = multiply_add(x.a, y.d[i], x.d[i] * y.a);
    return r;
  }
  friend HWY_INLINE Dual operator/(const Dual& x, const Dual& y) {
    Dual r;
    const V inverse = V(1.0) / y.a;
    r.a = x.a * inverse;
    for (int i = 0; i < N; ++i) r.d[i] = (x.d[i] - r.a * y.d[i]) * inverse;
    return r;
  }

  // With geometry, which has no derivatives.
  friend HWY_INLINE Dual operator+(const Dual& x, V y) { return x.shifted(x.a + y); }
  friend HWY_INLINE Dual operator+(V x, const Dual& y) { return y.shifted(x + y.a); }
  friend HWY_INLINE Dual operator-(const Dual& x, V y) { return x.shifted(x.a - y); }
  friend HWY_INLINE Dual operator*(const Dual& x, V y) { return x.chain(x.a * y, y); }
  friend HWY_INLINE Dual operator*(V x, const Dual& y) { return y.chain(x * y.a, x); }
  friend HWY_INLINE Dual operator/(V x, const Dual& y) {
    const V inverse = V(1.0) / y.a;
    const V value = x * inverse;
    return y.chain(value, V(0.0) - value * inverse);
  }

  friend HWY_INLINE LaneMask<Scalar> operator>(const Dual& x, const Dual& y) { return x.a > y.a; }
  friend HWY_INLINE LaneMask<Scalar> operator<(const Dual& x, const Dual& y) { return x.a < y.a; }

 private:
  HWY_INLINE Dual shifted(V value) const {
    Dual r = *this;
    r.a = value;
    return r;
  }
};

template <class S, int N>
HWY_INLINE Dual<S, N> select(LaneMask<S> condition, const Dual<S, N>& yes, const Dual<S, N>& no) {
  Dual<S, N> r;
  r.a = select(condition, yes.a, no.a);
  for (int i = 0; i < N; ++i) r.d[i] = select(condition, yes.d[i], no.d[i]);
  return r;
}
template <class S, int N>
HWY_INLINE Dual<S, N> sqrt(const Dual<S, N>& x) {
  const Lanes<S> root = sqrt(x.a);
  return x.chain(root, Lanes<S>(0.5) / root);
}
template <class S, int N>
HWY_INLINE Dual<S, N> exp(const Dual<S, N>& x) {
  const Lanes<S> value = exp(x.a);
  return x.chain(value, value);
}
template <class S, int N>
HWY_INLINE Dual<S, N> log(const Dual<S, N>& x) {
  return x.chain(log(x.a), Lanes<S>(1.0) / x.a);
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA

#endif  // BRDFIT_BRDF_SIMD_DUAL_H_
