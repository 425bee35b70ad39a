// Small stacks made in the test: textured spheres and planes under domes of lights, rendered by the scalar
// models.
#ifndef BRDFIT_TESTS_BAKE_DATA_H_
#define BRDFIT_TESTS_BAKE_DATA_H_

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "bake/photometric_stereo.h"
#include "brdf/models.h"
#include "measured/image_stack.h"

namespace brdfit::test_data {

inline Vec3 normalised(const Vec3& v) {
  const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  return {v.x / length, v.y / length, v.z / length};
}

inline double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// count directions spread evenly over the cap of the given half angle about +z.
inline std::vector<Vec3> cap_of_lights(int count, double half_angle_deg) {
  const double lowest = std::cos(half_angle_deg * std::numbers::pi / 180.0);
  std::vector<Vec3> lights;
  for (int k = 0; k < count; ++k) {
    const double z = 1.0 - (1.0 - lowest) * (k + 0.5) / count;
    const double angle = 2.0 * std::numbers::pi * k * 0.618033988749895;
    const double r = std::sqrt(1.0 - z * z);
    lights.push_back({r * std::cos(angle), r * std::sin(angle), z});
  }
  return lights;
}

struct TrueStack {
  StackInfo info;
  TexelBlock block;
  bake::Surface truth;
};

// The part of a sphere that leans at most 60 deg from the viewer, size x size texels, with a base colour that
// varies; the radiance of texel t under light k in channel c comes from value(normal, base colour, light).
template <class Value>
TrueStack make_sphere(int size, const std::vector<Vec3>& lights, const Value& value) {
  TrueStack s;
  s.info.width = size;
  s.info.height = size;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    s.info.lights.push_back({"light " + std::to_string(k), lights[k], {}, {1.0, 1.0, 1.0}});
  }
  const std::size_t count = s.info.texel_count();
  s.block.lights = lights.size();
  for (std::size_t t = 0; t < count; ++t) s.block.texels.push_back(static_cast<std::uint32_t>(t));
  s.block.rgb.resize(lights.size() * 3 * count);
  s.truth.normals.resize(3 * count);
  s.truth.albedo.resize(3 * count);
  s.truth.state.assign(count, bake::TexelState::kOk);
  const double reach = 0.61;  // of the unit sphere, along each axis
  for (std::size_t t = 0; t < count; ++t) {
    const double column = static_cast<double>(t % static_cast<std::size_t>(size));
    const double row = static_cast<double>(t / static_cast<std::size_t>(size));
    const double x = reach * (2.0 * (column + 0.5) / size - 1.0);
    const double y = reach * (1.0 - 2.0 * (row + 0.5) / size);
    const Vec3 normal = {x, y, std::sqrt(1.0 - x * x - y * y)};
    const Rgb base = {0.4 + 0.3 * std::sin(5.0 * x), 0.3 + 0.2 * std::cos(7.0 * y), 0.2 + 0.1 * x};
    const double parts[3] = {normal.x, normal.y, normal.z};
    for (std::size_t c = 0; c < 3; ++c) {
      s.truth.normals[c * count + t] = static_cast<float>(parts[c]);
      s.truth.albedo[c * count + t] = static_cast<float>(base[c]);
    }
    for (std::size_t k = 0; k < lights.size(); ++k) {
      const Rgb shown = value(normal, base, lights[k]);
      for (std::size_t c = 0; c < 3; ++c) s.block.plane(k, c)[t] = static_cast<float>(shown[c]);
    }
  }
  return s;
}

inline Rgb lambert(const Vec3& normal, const Rgb& base, const Vec3& light) {
  const double cosine = std::max(dot(normal, light), 0.0);
  return {base[0] * cosine, base[1] * cosine, base[2] * cosine};
}

inline TrueStack lambert_sphere(int size, const std::vector<Vec3>& lights) {
  return make_sphere(size, lights, lambert);
}

// A sphere of a material, its base colours varying, seen along +z.
inline TrueStack material_sphere(int size, const std::vector<Vec3>& lights, const Material& material) {
  return make_sphere(size, lights, [&](const Vec3& normal, const Rgb& base, const Vec3& light) {
    Material here = material;
    here.set("base_color", base);
    const Vec3 up = std::abs(normal.x) < 0.9 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
    const double along = dot(up, normal);
    const Vec3 x = normalised({up.x - along * normal.x, up.y - along * normal.y, up.z - along * normal.z});
    const Vec3 y = {normal.y * x.z - normal.z * x.y, normal.z * x.x - normal.x * x.z,
                    normal.x * x.y - normal.y * x.x};
    const Vec3 view = {0.0, 0.0, 1.0};
    Rgb shown = eval_cos(here, {dot(x, light), dot(y, light), dot(normal, light)},
                         {dot(x, view), dot(y, view), dot(normal, view)});
    for (double& channel : shown) channel *= std::numbers::pi;
    return shown;
  });
}

inline double normal_error_deg(const bake::Surface& a, const bake::Surface& b, std::size_t t) {
  const std::size_t n = a.count();
  const double d[3] = {a.normals[t] - b.normals[t], a.normals[n + t] - b.normals[n + t],
                       a.normals[2 * n + t] - b.normals[2 * n + t]};
  const double chord = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  return 2.0 * std::asin(std::min(0.5 * chord, 1.0)) * 180.0 / std::numbers::pi;
}

inline double largest_normal_error_deg(const bake::Surface& a, const bake::Surface& b) {
  double largest = 0.0;
  for (std::size_t t = 0; t < a.count(); ++t) largest = std::max(largest, normal_error_deg(a, b, t));
  return largest;
}

inline double mean_normal_error_deg(const bake::Surface& a, const bake::Surface& b) {
  double sum = 0.0;
  for (std::size_t t = 0; t < a.count(); ++t) sum += normal_error_deg(a, b, t);
  return sum / static_cast<double>(a.count());
}

inline double largest_albedo_error(const bake::Surface& a, const bake::Surface& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.albedo.size(); ++k) {
    largest = std::max(largest, static_cast<double>(std::abs(a.albedo[k] - b.albedo[k])));
  }
  return largest;
}

inline bool is_sound(const bake::Surface& s) {
  for (const float x : s.albedo) {
    if (!std::isfinite(x) || x < 0.0F) return false;
  }
  const std::size_t n = s.count();
  for (std::size_t t = 0; t < n; ++t) {
    const double x = s.normals[t];
    const double y = s.normals[n + t];
    const double z = s.normals[2 * n + t];
    if (!(std::abs(x * x + y * y + z * z - 1.0) < 1e-5) || !(z > 0.0)) return false;
  }
  return true;
}

}  // namespace brdfit::test_data

#endif  // BRDFIT_TESTS_BAKE_DATA_H_
