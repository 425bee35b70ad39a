// Small functions that the models share, defined with finite values and derivatives on their closed domains.
#ifndef BRDFIT_BRDF_KERNEL_MATH_H_
#define BRDFIT_BRDF_KERNEL_MATH_H_

#include "lang.h"

#define BRDF_PI 3.14159265358979323846
#define BRDF_INV_PI 0.31830988618379067154
// A denominator below this is taken to be this, and the base of a power to be 0. Smaller than any denominator
// that a direction above the horizon and alpha >= 1e-4 produce in single precision; large enough for what is
// below to be a matter of definition, not of whether a device keeps denormal numbers.
#define BRDF_TINY 1e-30

BRDF_NAMESPACE_BEGIN

BRDF_REAL_FUNCTION
Real square(Real x) {
  return x * x;
}

BRDF_REAL_FUNCTION
Real pow5(Real x) {
  Real x2 = x * x;
  return x2 * x2 * x;
}

BRDF_REAL_FUNCTION
Real lerp_real(Real a, Real b, Real t) {
  // Not a + (b - a) t: where b is small beside a, that loses b.
  return a * (REAL(1.0) - t) + b * t;
}

BRDF_REAL_FUNCTION
Real at_least(Real x, Real lower) {
  return select(x > lower, x, lower);
}

BRDF_REAL_FUNCTION
Real at_most(Real x, Real upper) {
  return select(x < upper, x, upper);
}

// At x = 0 the derivative is the one from inside, so that an optimiser can leave that end.
BRDF_REAL_FUNCTION
Real clamp01(Real x) {
  Real above = select(x < REAL(0.0), REAL(0.0), x);
  return select(above < REAL(1.0), above, REAL(1.0));
}

// log(x), and 0 where x <= BRDF_TINY: the companion of power_from_log.
BRDF_GEO_FUNCTION
Geo log_or_zero(Geo x) {
  return log(select(x > GEO(BRDF_TINY), x, GEO(1.0)));
}

// As log_or_zero, from x and 1 - x, both known to their last digits.
BRDF_GEO_FUNCTION
Geo accurate_log_or_zero(Geo x, Geo one_minus_x) {
  return accurate_log(select(x > GEO(BRDF_TINY), x, GEO(1.0)),
                      select(x > GEO(BRDF_TINY), one_minus_x, GEO(0.0)));
}

// base_1^exponent_1 base_2^exponent_2 for bases in [0, 1] and exponents >= 0, with logs from log_or_zero.
// 0^0 is 1 with derivative 0, 0^positive is 0: chosen explicitly, as GLSL leaves pow(0, 0) undefined.
BRDF_FUNCTION
Real power_product(Geo base_1, Geo log_base_1, Real exponent_1, Geo base_2, Geo log_base_2, Real exponent_2) {
  Real zero_1 = select(exponent_1 > REAL(0.0), REAL(0.0), REAL(1.0));
  Real zero_2 = select(exponent_2 > REAL(0.0), REAL(0.0), REAL(1.0));
  Real power = exp(exponent_1 * log_base_1 + exponent_2 * log_base_2);
  power = select(base_1 > GEO(BRDF_TINY), power, power * zero_1);
  return select(base_2 > GEO(BRDF_TINY), power, power * zero_2);
}

// 1 - power for power = power_product(...) of the same bases, with all digits where the power is close to 1.
BRDF_FUNCTION
Real one_minus_power_product(Real power, Geo log_base_1, Real exponent_1, Geo log_base_2, Real exponent_2) {
  Real exact = one_minus_exp(exponent_1 * log_base_1 + exponent_2 * log_base_2, power);
  // A base of 0 has the log 0.
  return select(power > REAL(0.0), exact, REAL(1.0));
}

// base^exponent, as power_product.
BRDF_FUNCTION
Real power_from_log(Geo base, Geo log_base, Real exponent) {
  Real zero = select(exponent > REAL(0.0), REAL(0.0), REAL(1.0));
  return select(base > GEO(BRDF_TINY), exp(exponent * log_base), zero);
}

// The cubic Hermite step over [0, edge], for x > 0 and edge >= 0. With edge = 0 it is 1 for every x > 0.
BRDF_FUNCTION
Real smoothstep_from_zero(Real edge, Geo x) {
  Real inside = x / select(edge > REAL(0.0), edge, REAL(1.0));
  Real t = select(edge > TO_REAL(x), inside, REAL(1.0));
  return t * t * (REAL(3.0) - REAL(2.0) * t);
}

BRDF_NAMESPACE_END

#endif  // BRDFIT_BRDF_KERNEL_MATH_H_
