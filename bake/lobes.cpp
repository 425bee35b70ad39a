// Points on caps, uniform sets, values under lights.
#include "bake/lobes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace brdfit::bake {
namespace {

constexpr double kGoldenAngle = 2.399963229728653;

double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

Vec3 normalised(const Vec3& v) {
  const double length = std::sqrt(dot(v, v));
  if (length < 1e-12) return {0.0, 0.0, 1.0};
  return {v.x / length, v.y / length, v.z / length};
}

// The point at polar angle (as a cosine) and azimuth around an axis. Duff et al. 2017 for the frame.
Vec3 around(const Vec3& axis, double cos_theta, double phi) {
  const double sign = std::copysign(1.0, axis.z);
  const double a = -1.0 / (sign + axis.z);
  const double b = axis.x * axis.y * a;
  const Vec3 s = {1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
  const Vec3 t = {b, sign + axis.y * axis.y * a, -axis.y};
  const double sin_theta = std::sqrt(std::max(0.0, 1.0 - cos_theta * cos_theta));
  const double u = sin_theta * std::cos(phi);
  const double v = sin_theta * std::sin(phi);
  return normalised({s.x * u + t.x * v + axis.x * cos_theta, s.y * u + t.y * v + axis.y * cos_theta,
                     s.z * u + t.z * v + axis.z * cos_theta});
}

}  // namespace

Eigen::MatrixXd lobe_values(const LobeSet& lobes, std::span<const Vec3> directions) {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(directions.size()),
                         static_cast<Eigen::Index>(lobes.size()));
  for (Eigen::Index k = 0; k < values.cols(); ++k) {
    for (Eigen::Index i = 0; i < values.rows(); ++i) {
      values(i, k) = eval(lobes[static_cast<std::size_t>(k)], directions[static_cast<std::size_t>(i)]);
    }
  }
  return values;
}

Cap cap_of(std::span<const Vec3> directions) {
  Vec3 sum{0.0, 0.0, 0.0};
  for (const Vec3& d : directions) sum = {sum.x + d.x, sum.y + d.y, sum.z + d.z};
  Cap cap;
  cap.axis = normalised(sum);
  for (const Vec3& d : directions) {
    cap.angle = std::max(cap.angle, std::acos(std::clamp(dot(cap.axis, d), -1.0, 1.0)));
  }
  return cap;
}

Vec3 cap_point(const Cap& cap, int k, int count) {
  const double cos_theta = 1.0 - (1.0 - std::cos(cap.angle)) * (k + 0.5) / count;
  return around(cap.axis, cos_theta, kGoldenAngle * k);
}

double spacing(const Cap& cap, std::size_t count) {
  const double area = 2.0 * std::numbers::pi * (1.0 - std::cos(cap.angle));
  return std::max(1e-3, std::sqrt(area / static_cast<double>(count)));
}

LobeSet uniform_lobes(int count, const Cap& cap, double overlap) {
  if (count < 1 || count > kMaxLobes) throw std::invalid_argument("uniform_lobes: 1 to 16 lobes");
  if (!(overlap > 0.0 && overlap < 1.0)) {
    throw std::invalid_argument("uniform_lobes: overlap must lie between 0 and 1");
  }
  const double distance = std::min(spacing(cap, static_cast<std::size_t>(count)), std::numbers::pi);
  const double sharpness = -std::log(overlap) / (1.0 - std::cos(distance));
  LobeSet lobes;
  for (int k = 0; k < count; ++k) {
    lobes.push_back({cap_point(cap, k, count), sharpness, -1.0});
  }
  return lobes;
}

}  // namespace brdfit::bake
