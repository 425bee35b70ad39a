// A SIMD vector as a number type for the kernels, on Highway's vectors for the instruction set of the
// compile.
//
// For sources added by brdfit_add_simd alone (see cmake/BrdfitSimd.cmake): everything here lives in a
// namespace named after the instruction set.
#ifndef BRDFIT_BRDF_SIMD_LANES_H_
#define BRDFIT_BRDF_SIMD_LANES_H_

#ifndef BRDFIT_SIMD_ISA
#error "lanes.h is for sources that brdfit_add_simd compiles"
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <cstddef>

namespace brdfit::simd::BRDFIT_SIMD_ISA {

namespace hn = hwy::HWY_NAMESPACE;

template <class Scalar>
struct LaneMask {
  hn::Mask<hn::ScalableTag<Scalar>> mask;
};

template <class Scalar>
struct Lanes {
  using Tag = hn::ScalableTag<Scalar>;
  static constexpr std::size_t size = hn::MaxLanes(Tag());

  hn::Vec<Tag> v;

  Lanes() = default;
  explicit HWY_INLINE Lanes(double x) : v(hn::Set(Tag(), static_cast<Scalar>(x))) {}

  static HWY_INLINE Lanes of(hn::Vec<Tag> vector) {
    Lanes result;
    result.v = vector;
    return result;
  }
  static HWY_INLINE Lanes load(const Scalar* from) { return of(hn::LoadU(Tag(), from)); }
  HWY_INLINE void store(Scalar* to) const { hn::StoreU(v, Tag(), to); }

  friend HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return of(hn::Add(a.v, b.v)); }
  friend HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return of(hn::Sub(a.v, b.v)); }
  friend HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return of(hn::Mul(a.v, b.v)); }
  friend HWY_INLINE Lanes operator/(Lanes a, Lanes b) { return of(hn::Div(a.v, b.v)); }
  friend HWY_INLINE LaneMask<Scalar> operator>(Lanes a, Lanes b) { return {hn::Gt(a.v, b.v)}; }
  friend HWY_INLINE LaneMask<Scalar> operator<(Lanes a, Lanes b) { return {hn::Lt(a.v, b.v)}; }
};

template <class S>
HWY_INLINE Lanes<S> select(LaneMask<S> condition, Lanes<S> yes, Lanes<S> no) {
  return Lanes<S>::of(hn::IfThenElse(condition.mask, yes.v, no.v));
}
template <class S>
HWY_INLINE Lanes<S> sqrt(Lanes<S> x) {
  return Lanes<S>::of(hn::Sqrt(x.v));
}
template <class S>
HWY_INLINE Lanes<S> exp(Lanes<S> x) {
  return Lanes<S>::of(hn::Exp(typename Lanes<S>::Tag(), x.v));
}
// exp of doubles for x <= 709 (kernels raise numbers in [0, 1] to powers, so x <= 0), with fewer steps than
// hn::Exp and its accuracy: relative error 2e-16; results below the smallest normal number are 0.
HWY_INLINE Lanes<double> exp(Lanes<double> x) {
  using Tag = Lanes<double>::Tag;
  const Tag d;
  const hn::RebindToUnsigned<Tag> bits;
  // The sum's low bits are the nearest whole number of x / ln 2.
  const auto shifter = hn::Set(d, 6755399441055744.0);  // 1.5 * 2^52
  const auto shifted = hn::MulAdd(x.v, hn::Set(d, 1.442695040888963407359924681), shifter);
  const auto power = hn::Sub(shifted, shifter);
  auto r = hn::MulAdd(power, hn::Set(d, -0.6931471805596629565116018), x.v);
  r = hn::MulAdd(power, hn::Set(d, -0.28235290563031577122588448175e-12), r);
  const auto e = hn::Add(hn::impl::ExpImpl<double>().ExpPoly(d, r), hn::Set(d, 1.0));
  const auto scaled =
      hn::BitCast(d, hn::Add(hn::BitCast(bits, e), hn::ShiftLeft<52>(hn::BitCast(bits, shifted))));
  return Lanes<double>::of(hn::IfThenElseZero(hn::Ge(x.v, hn::Set(d, -708.0)), scaled));
}
template <class S>
HWY_INLINE Lanes<S> log(Lanes<S> x) {
  return Lanes<S>::of(hn::Log(typename Lanes<S>::Tag(), x.v));
}
template <class S>
HWY_INLINE Lanes<S> abs(Lanes<S> x) {
  return Lanes<S>::of(hn::Abs(x.v));
}
// a b + c in one rounding.
template <class S>
HWY_INLINE Lanes<S> multiply_add(Lanes<S> a, Lanes<S> b, Lanes<S> c) {
  return Lanes<S>::of(hn::MulAdd(a.v, b.v, c.v));
}
template <class S>
HWY_INLINE S sum(Lanes<S> x) {
  return hn::GetLane(hn::SumOfLanes(typename Lanes<S>::Tag(), x.v));
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA

#endif  // BRDFIT_BRDF_SIMD_LANES_H_
