// Spheres and patches under one directional light.
#include "render/sphere.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

namespace brdfit::render {
namespace {

constexpr int kLargestSize = 16384;
constexpr double kCameraDistance = 4.0;  // of the pinhole that sees the patch

// The centre of a pixel in units of 1 / size from the middle of the picture; y up.
int offset_x(int x, int size) {
  return 2 * x + 1 - size;
}
int offset_y(int y, int size) {
  return size - 1 - 2 * y;
}

// The lit pixels of one row, side by side.
struct LitRow {
  std::vector<Vec3> wi;
  std::vector<Vec3> wo;
  std::vector<std::size_t> pixel;
};

// Stores a value, or says why there is none that a picture can hold.
void store(const Rgb& f_cos, PixelState state, std::size_t pixel, Image& image) {
  image.state[pixel] = state;
  if (state != PixelState::kValue) return;
  float* to = &image.rgb[3 * pixel];
  bool finite = true;
  for (std::size_t c = 0; c < 3; ++c) {
    to[c] = static_cast<float>(std::numbers::pi * f_cos[c]);
    finite = finite && std::isfinite(to[c]);
  }
  if (finite) return;
  to[0] = to[1] = to[2] = 0.0F;
  image.state[pixel] = PixelState::kNotFinite;
}

// Pixels beside the surface and in shadow are done here; those that are lit are collected.
LitRow sort_out_row(const Scene& scene, int y, Image& image) {
  LitRow lit;
  for (int x = 0; x < image.width; ++x) {
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
    const SurfacePoint point = scene.at(x, y);
    image.state[pixel] = point.inside ? PixelState::kValue : PixelState::kOutside;
    if (!point.inside || point.wi.z <= 0.0) continue;
    lit.wi.push_back(point.wi);
    lit.wo.push_back(point.wo);
    lit.pixel.push_back(pixel);
  }
  return lit;
}

}  // namespace

Scene::Scene(Shape shape, double light_angle_deg, int size) : shape_(shape), size_(size) {
  if (size < 1 || size > kLargestSize) throw std::invalid_argument("the size is not in 1..16384");
  if (!(light_angle_deg >= 0.0 && light_angle_deg < 180.0)) {
    throw std::invalid_argument("the light's angle is not in [0, 180) degrees");
  }
  const double half = 0.5 * light_angle_deg * std::numbers::pi / 180.0;
  half_sin_ = std::sin(half);
  half_cos_ = std::cos(half);
  light_ = {std::sin(2.0 * half), 0.0, std::cos(2.0 * half)};
}

SurfacePoint Scene::at(int x, int y) const {
  return shape_ == Shape::kSphere ? on_sphere(x, y) : on_patch(x, y);
}

SurfacePoint Scene::on_sphere(int x, int y) const {
  const int i = offset_x(x, size_);
  const int j = offset_y(y, size_);
  const int rest = size_ * size_ - i * i - j * j;  // exact
  SurfacePoint point;
  point.inside = rest > 0;
  if (!point.inside) return point;
  const double scale = 1.0 / size_;
  const Vec3 n = {i * scale, j * scale, std::sqrt(static_cast<double>(rest)) * scale};
  // t = (n.z, 0, -n.x) / s, b = n x t.
  const double s = std::sqrt(n.x * n.x + n.z * n.z);
  const Vec3 t = {n.z / s, 0.0, -n.x / s};
  const Vec3 b = {n.y * t.z, s, -n.y * t.x};
  point.wo = {t.z, b.z, n.z};
  const auto along_light = [this](const Vec3& axis) { return axis.x * light_.x + axis.z * light_.z; };
  point.wi = {along_light(t), along_light(b), along_light(n)};
  return point;
}

SurfacePoint Scene::on_patch(int x, int y) const {
  // n = (half_sin, 0, half_cos), t = (half_cos, 0, -half_sin), b = y. The picture is a window in the plane
  // z = 0, as high as the patch's nearer edge appears there.
  const double scale = kCameraDistance / (kCameraDistance - half_sin_) / size_;
  const double window_x = offset_x(x, size_) * scale;
  const double window_y = offset_y(y, size_) * scale;
  const double descent = kCameraDistance * half_cos_ - window_x * half_sin_;  // of a ray towards the plane
  SurfacePoint point;
  if (descent <= 0.0) return point;
  const double steps = kCameraDistance * half_cos_ / descent;
  const double u = steps * window_x * half_cos_ - kCameraDistance * (1.0 - steps) * half_sin_;
  const double v = steps * window_y;
  point.inside = std::abs(u) <= 1.0 && std::abs(v) <= 1.0;
  if (!point.inside) return point;
  const double to_x = -kCameraDistance * half_sin_ - u;
  const double to_z = kCameraDistance * half_cos_;
  const double length = std::sqrt(to_x * to_x + v * v + to_z * to_z);
  point.wo = {to_x / length, -v / length, to_z / length};
  point.wi = {half_sin_, 0.0, half_cos_};
  return point;
}

SurfacePoint surface_point(Shape shape, double light_angle_deg, int size, int x, int y) {
  return Scene(shape, light_angle_deg, size).at(x, y);
}

Image draw_lit(const Subject& subject, Shape shape, double light_angle_deg, int size) {
  const Scene scene(shape, light_angle_deg, size);
  Image image(size, size);
  tbb::parallel_for(0, size, [&](int y) {
    const LitRow lit = sort_out_row(scene, y, image);
    std::vector<Rgb> f_cos(lit.pixel.size());
    std::vector<PixelState> state(lit.pixel.size());
    subject.eval_cos(lit.wi, lit.wo, f_cos, state);
    for (std::size_t k = 0; k < lit.pixel.size(); ++k) store(f_cos[k], state[k], lit.pixel[k], image);
  });
  return image;
}

}  // namespace brdfit::render
