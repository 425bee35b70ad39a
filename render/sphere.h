// Orthographic spheres and flat patches under a directional light, and spheres under an environment.
//
// The camera looks along -z at a sphere of radius 1 that touches the picture's borders; x is to the right, y
// up. A light at angle a shines from (sin a, 0, cos a): 0 deg behind the camera, 90 deg from the right, 140
// deg from behind. Its irradiance on a surface facing it is pi, so that a white Lambert surface facing it has
// radiance 1.
#ifndef BRDFIT_RENDER_SPHERE_H_
#define BRDFIT_RENDER_SPHERE_H_

#include <array>
#include <string>

#include "brdf/vec3.h"
#include "render/image.h"
#include "render/subject.h"

namespace brdfit::render {

// The light angles of the Callisto talk (Jimenez et al. 2023), in degrees.
inline constexpr std::array<double, 4> kLightAnglesDeg = {0.0, 90.0, 120.0, 140.0};

enum class Shape {
  kSphere,
  // A square of side 2 around the origin whose normal halves the angle between camera and light, seen from a
  // pinhole 4 units away: its centre mirrors the light into the camera at half the light's angle.
  kPatch,
};

// The pair of directions at a pixel's centre in the local frame of the surface. inside: the pixel shows the
// surface; if not, the directions mean nothing. The light is above the horizon where wi.z > 0.
struct SurfacePoint {
  bool inside = false;
  Vec3 wi;
  Vec3 wo;
};

// A shape under a light, seen on size x size pixels. The tangent of a sphere runs around the y axis; that of
// the patch lies in the plane of camera and light. The patch's nearer edge touches the picture's borders.
class Scene {
 public:
  // Throws std::invalid_argument unless size is in 1..16384 and the angle in [0, 180).
  Scene(Shape shape, double light_angle_deg, int size);

  SurfacePoint at(int x, int y) const;

 private:
  SurfacePoint on_sphere(int x, int y) const;
  SurfacePoint on_patch(int x, int y) const;

  Shape shape_;
  int size_;
  Vec3 light_;       // in the world
  double half_sin_;  // of half the light's angle
  double half_cos_;
};

// One pixel of a scene.
SurfacePoint surface_point(Shape shape, double light_angle_deg, int size, int x, int y);

// Radiance, size x size pixels, each at its centre. Where the light is below the horizon it is 0 (state
// kValue: a surface in its own shadow is black). Parallel over rows. Throws std::invalid_argument unless size
// is in 1..16384 and the angle in [0, 180).
Image draw_lit(const Subject& subject, Shape shape, double light_angle_deg, int size);

enum class Environment {
  kUniform,   // radiance 1 from everywhere (a furnace)
  kGradient,  // radiance (1 + y) / 2: 1 from above, 0 from below
};

struct EnvironmentImage {
  Image image;
  // Estimate of the largest error of the quadrature over pixels and channels, in steps of 8-bit sRGB, from
  // the difference to half the resolution; below 0.5 unless converged is false.
  double error_steps = 0.0;
  bool converged = false;
  int evaluations = 0;  // of f, in all
  double unmeasured_fraction =
      0.0;  // largest share of the hemisphere (by solid angle times cosine) that a table does not hold
};

// A sphere under an environment. For isotropic materials radiance depends only on the inclination of the view
// (and linearly on two vectors for the gradient), so the quadrature is done once per inclination: Gauss-
// Legendre over half vectors up to the horizon, doubled until the error estimate is below half an 8-bit step.
// Deterministic. Directions that a table does not hold contribute nothing. Throws std::invalid_argument for a
// size that is not in 1..16384, and for an anisotropic material (Burley with anisotropic > 0).
EnvironmentImage draw_environment(const Subject& subject, Environment environment, int size);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_SPHERE_H_
