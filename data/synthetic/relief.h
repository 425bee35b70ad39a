// The surface of a synthetic stack: heights, normals and what stands in whose light.
#ifndef BRDFIT_DATA_SYNTHETIC_RELIEF_H_
#define BRDFIT_DATA_SYNTHETIC_RELIEF_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "brdf/vec3.h"
#include "data/synthetic/counter_random.h"
#include "data/synthetic/stack_recipe.h"

namespace brdfit::synthetic {

// A smooth function of the pixel in [-1, 1], another for each `number`: a product of waves of random
// directions.
double smooth_wave(double x, double y, double wavelength_px, const CounterRandom& random, std::size_t number);

class ReliefSurface {
 public:
  ReliefSurface(const ShapeRecipe& shape, int width, int height, std::uint64_t seed);

  // Beside the sphere, where there is no surface.
  bool is_outside(std::uint32_t texel) const;
  // Unit; z where there is no surface.
  Vec3 normal(std::uint32_t texel) const;
  // Whether the bumps hide a light in that direction (unit) from the texel. The side of a surface that is
  // turned away from the light is not what is meant here.
  bool is_shadowed(std::uint32_t texel, const Vec3& direction) const;

 private:
  struct Wave {
    double kx, ky, phase, amplitude;
  };
  struct Point {
    double x, y;
  };
  Point on_sphere(std::uint32_t texel) const;  // in units of the radius, from its centre
  double height_at(double x, double y) const;  // in pixels; between pixels too

  ShapeRecipe shape_;
  int width_;
  int height_;
  std::vector<Wave> waves_;
  double highest_ = 0.0;
};

}  // namespace brdfit::synthetic

#endif  // BRDFIT_DATA_SYNTHETIC_RELIEF_H_
