// Waves, spheres and planes, and their shadows.
#include "data/synthetic/relief.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "data/synthetic/streams.h"

namespace brdfit::synthetic {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kWaves = 6;

}  // namespace

double smooth_wave(double x, double y, double wavelength_px, const CounterRandom& random,
                   std::size_t number) {
  double product = 1.0;
  for (std::uint64_t k = 0; k < 2; ++k) {
    const std::uint64_t counter = (number * 2 + k) * 3;
    const double angle = kTurn * random.uniform(counter);
    const double length = wavelength_px * (1.0 + random.uniform(counter + 1));
    product *= std::cos(kTurn *
                        ((x * std::cos(angle) + y * std::sin(angle)) / length + random.uniform(counter + 2)));
  }
  return product;
}

ReliefSurface::ReliefSurface(const ShapeRecipe& shape, int width, int height, std::uint64_t seed)
    : shape_(shape), width_(width), height_(height) {
  if (shape.relief != Relief::kBumps) return;
  const CounterRandom random(seed, kReliefStream);
  // The steepest slope possible is the sum over waves of amplitude times wave number.
  for (std::uint64_t k = 0; k < kWaves; ++k) {
    const double angle = kTurn * random.uniform(3 * k);
    const double length = shape.wavelength_px / (1.0 + 0.5 * static_cast<double>(k));
    const double number = kTurn / length;
    waves_.push_back({number * std::cos(angle), number * std::sin(angle), kTurn * random.uniform(3 * k + 1),
                      shape.slope / (kWaves * number)});
    highest_ += waves_.back().amplitude;
  }
}

double ReliefSurface::height_at(double x, double y) const {
  double height = 0.0;
  for (const Wave& wave : waves_) height += wave.amplitude * std::cos(wave.kx * x + wave.ky * y + wave.phase);
  return height;
}

bool ReliefSurface::is_outside(std::uint32_t texel) const {
  if (shape_.relief != Relief::kSphere) return false;
  const Point p = on_sphere(texel);
  return p.x * p.x + p.y * p.y >= 1.0;
}

ReliefSurface::Point ReliefSurface::on_sphere(std::uint32_t texel) const {
  const auto width = static_cast<std::uint32_t>(width_);
  const double radius = 0.5 * std::min(width_, height_);
  return {(texel % width - 0.5 * (width_ - 1)) / radius, (0.5 * (height_ - 1) - texel / width) / radius};
}

Vec3 ReliefSurface::normal(std::uint32_t texel) const {
  const auto width = static_cast<std::uint32_t>(width_);
  const double x = texel % width;
  const double y = height_ - 1.0 - texel / width;  // up
  switch (shape_.relief) {
    case Relief::kPlane:
      return {0.0, 0.0, 1.0};
    case Relief::kSphere: {
      const Point p = on_sphere(texel);
      const double squared = 1.0 - p.x * p.x - p.y * p.y;
      return squared > 0.0 ? Vec3{p.x, p.y, std::sqrt(squared)} : Vec3{0.0, 0.0, 1.0};
    }
    case Relief::kBumps:
      break;
  }
  double slope_x = 0.0;
  double slope_y = 0.0;
  for (const Wave& wave : waves_) {
    const double falling = wave.amplitude * std::sin(wave.kx * x + wave.ky * y + wave.phase);
    slope_x -= falling * wave.kx;
    slope_y -= falling * wave.ky;
  }
  const double length = std::sqrt(1.0 + slope_x * slope_x + slope_y * slope_y);
  return {-slope_x / length, -slope_y / length, 1.0 / length};
}

bool ReliefSurface::is_shadowed(std::uint32_t texel, const Vec3& direction) const {
  const double across = std::hypot(direction.x, direction.y);
  // A light straight above is hidden by nothing; steeper than the surface can be, neither.
  if (waves_.empty() || direction.z >= shape_.slope * across) return false;
  const auto width = static_cast<std::uint32_t>(width_);
  const double x = texel % width;
  const double y = height_ - 1.0 - texel / width;
  const double start = height_at(x, y);
  const double rise = direction.z / across;  // per pixel
  for (double step = 1.0; start + rise * step < highest_; step += 1.0) {
    const double there_x = x + step * direction.x / across;
    const double there_y = y + step * direction.y / across;
    if (there_x < 0.0 || there_x > width_ - 1.0 || there_y < 0.0 || there_y > height_ - 1.0) return false;
    if (height_at(there_x, there_y) > start + rise * step) return true;
  }
  return false;
}

}  // namespace brdfit::synthetic
