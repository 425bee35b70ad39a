// What the reference models of the tests know of a pair of directions. Written from the published formulas in
// extended precision, by other formulas than the kernels'.
#ifndef BRDFIT_TESTS_REFERENCE_GEOMETRY_H_
#define BRDFIT_TESTS_REFERENCE_GEOMETRY_H_

#include <cmath>
#include <numbers>

#include "brdf/vec3.h"

namespace brdfit::reference {

using Number = long double;
inline constexpr Number kPi = std::numbers::pi_v<Number>;

// A value, and the size of what was added up to give it: rounding is relative to the latter.
struct Expected {
  Number value = 0;
  Number magnitude = 0;
};

struct Geometry {
  Number cos_i;
  Number cos_o;
  Number cos_h;
  Number cos_d;
  Number theta_h;
  Number theta_d;
  Number h_x;
  Number h_y;
  bool above;  // both directions above the horizon
};

inline Number length(Number x, Number y, Number z) {
  return std::sqrt(x * x + y * y + z * z);
}

inline Geometry geometry(const Vec3& wi, const Vec3& wo) {
  const Number sum_x = Number(wi.x) + wo.x;
  const Number sum_y = Number(wi.y) + wo.y;
  const Number sum_z = Number(wi.z) + wo.z;
  const Number sum = length(sum_x, sum_y, sum_z);
  const Number difference = length(Number(wi.x) - wo.x, Number(wi.y) - wo.y, Number(wi.z) - wo.z);
  return {
      .cos_i = wi.z,
      .cos_o = wo.z,
      .cos_h = sum_z / sum,
      .cos_d = sum / std::hypot(sum, difference),
      .theta_h = std::atan2(std::hypot(sum_x, sum_y), sum_z),
      .theta_d = std::atan2(difference, sum),
      .h_x = sum_x / sum,
      .h_y = sum_y / sum,
      .above = wi.z > 0 && wo.z > 0,
  };
}

// 1 - cos(theta), also for small angles.
inline Number one_minus_cos(Number theta) {
  const Number half = std::sin(theta / 2);
  return 2 * half * half;
}

inline Number lerp(Number a, Number b, Number t) {
  return (1 - t) * a + t * b;
}

// x^y for x clamped at 0, with 0^0 = 1.
inline Number power(Number x, Number y) {
  if (y == 0) return 1;
  return x <= 0 ? 0 : std::pow(x, y);
}

inline Number schlick(const Geometry& g) {
  return power(one_minus_cos(g.theta_d), 5);
}

}  // namespace brdfit::reference

#endif  // BRDFIT_TESTS_REFERENCE_GEOMETRY_H_
