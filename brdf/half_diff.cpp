// Half/difference angles to directions and back (Rusinkiewicz 1998).
#include "brdf/half_diff.h"

#include <cmath>
#include <numbers>

namespace brdfit {
namespace {

double length(double x, double y, double z) {
  return std::sqrt(x * x + y * y + z * z);
}

// An angle of atan2, in [0, 2 pi).
double unsigned_angle(double angle_rad) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  if (angle_rad >= 0.0) return angle_rad;
  const double turned = angle_rad + kTurn;
  return turned < kTurn ? turned : 0.0;  // a tiny negative angle rounds up to the full turn
}

}  // namespace

DirectionPair directions_from_half_diff(const HalfDiff& angles) {
  const double sin_h = std::sin(angles.theta_h_rad);
  const double cos_h = std::cos(angles.theta_h_rad);
  const double sin_d = std::sin(angles.theta_d_rad);
  const double cos_d = std::cos(angles.theta_d_rad);
  // wi relative to h is (a, b, cos_d), wo its mirror image (-a, -b, cos_d); both turn with h about the y
  // axis.
  const double a = sin_d * std::cos(angles.phi_d_rad);
  const double b = sin_d * std::sin(angles.phi_d_rad);
  const Vec3 wi{cos_d * sin_h + a * cos_h, b, cos_d * cos_h - a * sin_h};
  const Vec3 wo{cos_d * sin_h - a * cos_h, -b, cos_d * cos_h + a * sin_h};
  return {wi, wo};
}

HalfDiff half_diff_from_directions(const Vec3& wi, const Vec3& wo) {
  // Sum and difference are orthogonal, of lengths 2 cos_d and 2 sin_d: atan2 of them keeps full precision at
  // both ends, where acos would not.
  const Vec3 sum{wi.x + wo.x, wi.y + wo.y, wi.z + wo.z};
  const Vec3 difference{wi.x - wo.x, wi.y - wo.y, wi.z - wo.z};
  const double sum_length = length(sum.x, sum.y, sum.z);
  const double difference_length = length(difference.x, difference.y, difference.z);
  const double sum_tangent = std::hypot(sum.x, sum.y);

  HalfDiff angles;
  angles.theta_h_rad = std::atan2(sum_tangent, sum.z);
  angles.theta_d_rad = std::atan2(difference_length, sum_length);
  if (sum_tangent == 0.0 || difference_length == 0.0) return angles;

  // The difference along the two tangents of h: that of falling inclination, and that of growing azimuth.
  const double radial = (difference.x * sum.x + difference.y * sum.y) / sum_tangent;
  const double along = (radial * sum.z - difference.z * sum_tangent) / sum_length;
  const double across = (difference.y * sum.x - difference.x * sum.y) / sum_tangent;
  angles.phi_d_rad = unsigned_angle(std::atan2(across, along));
  return angles;
}

}  // namespace brdfit
