// Reciprocals, logarithms and roots of floats for sums over many cells: to a few units of the last place, in
// fewer steps than functions for every argument take. Polynomials interpolate at Chebyshev's nodes.
//
// For sources added by brdfit_add_simd alone, as brdf/simd/lanes.h.
#ifndef BRDFIT_FIT_FAST_ROOTS_H_
#define BRDFIT_FIT_FAST_ROOTS_H_

#include <bit>

#include "brdf/simd/lanes.h"

namespace brdfit::simd::BRDFIT_SIMD_ISA {

HWY_INLINE Lanes<float> smaller(Lanes<float> x, Lanes<float> y) {
  return Lanes<float>::of(hn::Min(x.v, y.v));
}
HWY_INLINE Lanes<float> larger(Lanes<float> x, Lanes<float> y) {
  return Lanes<float>::of(hn::Max(x.v, y.v));
}

// 1 / x for x in [1e-37, 1e37].
HWY_INLINE Lanes<float> reciprocal(Lanes<float> x) {
  using F = Lanes<float>;
#if HWY_ARCH_X86
  // At least 12 bits to begin with; Newton's step doubles them.
  const F y = F::of(hn::ApproximateReciprocal(x.v));
  return y * F::of(hn::NegMulAdd(x.v, y.v, hn::Set(F::Tag(), 2.0F)));
#else
  return F(1.0) / x;
#endif
}

// x = 2^exponent (1 + rest) with rest in [sqrt(1/2) - 1, sqrt(2) - 1).
struct Parted {
  Lanes<float> exponent;
  Lanes<float> rest;
};

// For normal x > 0.
HWY_INLINE Parted parted(Lanes<float> x) {
  using F = Lanes<float>;
  const F::Tag d;
  const hn::RebindToSigned<F::Tag> whole;
  const auto bits = hn::BitCast(whole, x.v);
  const auto root_half = hn::Set(whole, 0x3f3504f3);
  const auto exponent = hn::ShiftRight<23>(hn::Sub(bits, root_half));
  const auto rest = hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(exponent)));
  return {F::of(hn::ConvertTo(d, exponent)), F::of(rest) - F(1.0)};
}

// c[0] + c[1] x + ... + c[n - 1] x^(n - 1).
// In halves (Estrin's scheme), as steps that wait for each other cost more than some more of them.
template <std::size_t first, std::size_t count, std::size_t n>
HWY_INLINE Lanes<float> part_of_polynomial(const Lanes<float> (&powers)[4], const double (&c)[n]) {
  if constexpr (count == 1) {
    return Lanes<float>(c[first]);
  } else {
    constexpr std::size_t kHalf = std::bit_floor(count - 1);
    return multiply_add(part_of_polynomial<first + kHalf, count - kHalf>(powers, c),
                        powers[std::countr_zero(kHalf)], part_of_polynomial<first, kHalf>(powers, c));
  }
}

template <std::size_t n>
HWY_INLINE Lanes<float> polynomial(Lanes<float> x, const double (&c)[n]) {
  static_assert(n <= 16);
  const Lanes<float> x2 = x * x;
  const Lanes<float> x4 = x2 * x2;
  return part_of_polynomial<0, n>({x, x2, x4, x4 * x4}, c);
}

// ln(1 + y) of y in [0, 1e37]. Relative error 2e-7.
HWY_INLINE Lanes<float> log_of_1_plus(Lanes<float> y) {
  using F = Lanes<float>;
  // ln(1 + x) / x
  constexpr double kLog[] = {1.0,          -0.499999971, 0.333336706, -0.250011477, 0.199720497,
                             -0.165884885, 0.148347868,  -0.14159647, 0.0878726548};
  const Parted parts = parted(y + F(1.0));
  const F x = select(parts.exponent > F(0.0), parts.rest, y);
  // Powers of small numbers would be denormal, which is slow; there the line is enough.
  const F base = select(abs(x) > F(1e-4), x, F(0.0));
  const F quotient = multiply_add(F(-0.5), x - base, polynomial(base, kLog));
  return multiply_add(parts.exponent, F(0.693147180559945), x * quotient);
}

// x^(1/12) of x >= 0; that of 1e-28 for what is smaller. Relative error 2e-7.
HWY_INLINE Lanes<float> twelfth_root(Lanes<float> x) {
  using F = Lanes<float>;
  // log2(1 + x) / (12 x), and 2^x for x in [-1/2, 1/2]
  constexpr double kLog[] = {0.120224583,  -0.0601127443, 0.0400763923, -0.0300187652,
                             0.0239407402, -0.0207726518, 0.0193877149, -0.0118966445};
  constexpr double kPower[] = {1.0,           0.693147207,   0.240226509,   0.0555032723,
                               0.00961805668, 0.00134004282, 0.000154614447};
  const F::Tag d;
  const hn::RebindToSigned<F::Tag> whole;
  const Parted parts = parted(larger(x, F(1e-28)));
  const F log = multiply_add(parts.exponent, F(1.0 / 12.0), parts.rest * polynomial(parts.rest, kLog));
  // The sum's low bits are the nearest whole number.
  const F shifter(12582912.0);  // 1.5 * 2^23
  const F shifted = log + shifter;
  const F power = polynomial(log - (shifted - shifter), kPower);
  const auto bits = hn::Add(hn::BitCast(whole, power.v), hn::ShiftLeft<23>(hn::BitCast(whole, shifted.v)));
  return F::of(hn::BitCast(d, bits));
}

}  // namespace brdfit::simd::BRDFIT_SIMD_ISA

#endif  // BRDFIT_FIT_FAST_ROOTS_H_
