// Spheres and patches: directions at pixels, radiance, and what a pixel says when it has no value.
#include "render/sphere.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "brdf/models.h"
#include "tests/fit_data.h"
#include "tests/random_parameters.h"

namespace brdfit::render {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vec3 normalized(const Vec3& a) {
  const double length = std::sqrt(dot(a, a));
  return {a.x / length, a.y / length, a.z / length};
}

// The pair of directions on a sphere, from world space by vector algebra.
SurfacePoint expected_on_sphere(double light_deg, int size, int x, int y) {
  const double px = (x + 0.5) / size * 2.0 - 1.0;
  const double py = 1.0 - (y + 0.5) / size * 2.0;
  SurfacePoint point;
  point.inside = px * px + py * py < 1.0;
  if (!point.inside) return point;
  const Vec3 n = {px, py, std::sqrt(1.0 - px * px - py * py)};
  const Vec3 t = normalized(cross({0.0, 1.0, 0.0}, n));
  const Vec3 b = cross(n, t);
  const double a = light_deg * kPi / 180.0;
  const auto local = [&](const Vec3& w) { return Vec3{dot(w, t), dot(w, b), dot(w, n)}; };
  point.wi = local({std::sin(a), 0.0, std::cos(a)});
  point.wo = local({0.0, 0.0, 1.0});
  return point;
}

std::size_t pixel_at(const Image& image, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
}

// Largest difference of two pixels in units of 1 + value.
double gap(const Image& image, std::size_t a, std::size_t b) {
  double largest = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double p = image.rgb[3 * a + c];
    const double q = image.rgb[3 * b + c];
    largest = std::max(largest, std::abs(p - q) / (1.0 + q));
  }
  return largest;
}

Material random_material(Model model, unsigned seed) {
  testing_support::Random random(seed);
  return testing_support::random_material(model, effects_of(model), random);
}

Material isotropic(Material material) {
  if (material.model() == Model::kBurley) material.set("anisotropic", 0.0);
  return material;
}

TEST(SphereDirections, AreThoseOfTheGeometryAndUnitVectors) {
  for (const double light : {0.0, 37.0, 90.0, 120.0, 140.0, 179.0}) {
    for (const int size : {1, 2, 31, 64}) {
      for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
          const SurfacePoint point = surface_point(Shape::kSphere, light, size, x, y);
          const SurfacePoint expected = expected_on_sphere(light, size, x, y);
          ASSERT_EQ(point.inside, expected.inside) << size << " " << x << " " << y;
          if (!point.inside) continue;
          EXPECT_NEAR(dot(point.wi, point.wi), 1.0, 1e-14);
          EXPECT_NEAR(dot(point.wo, point.wo), 1.0, 1e-14);
          EXPECT_NEAR(dot(point.wi, expected.wi), 1.0, 1e-13);
          EXPECT_NEAR(dot(point.wo, expected.wo), 1.0, 1e-13);
          EXPECT_GT(point.wo.z, 0.0);
        }
      }
    }
  }
}

TEST(PatchDirections, AreUnitVectorsWithTheMirrorPairInTheMiddle) {
  for (const double light : {0.0, 60.0, 90.0, 140.0, 170.0}) {
    constexpr int kSize = 41;
    const SurfacePoint middle = surface_point(Shape::kPatch, light, kSize, kSize / 2, kSize / 2);
    ASSERT_TRUE(middle.inside);
    EXPECT_NEAR(middle.wi.x, std::sin(0.5 * light * kPi / 180.0), 1e-14);
    EXPECT_NEAR(middle.wo.x, -middle.wi.x, 1e-14);
    EXPECT_NEAR(middle.wo.z, middle.wi.z, 1e-14);
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const SurfacePoint point = surface_point(Shape::kPatch, light, kSize, x, y);
        const SurfacePoint below = surface_point(Shape::kPatch, light, kSize, x, kSize - 1 - y);
        ASSERT_EQ(point.inside, below.inside);
        if (!point.inside) continue;
        EXPECT_NEAR(dot(point.wo, point.wo), 1.0, 1e-14);
        EXPECT_NEAR(dot(point.wi, point.wi), 1.0, 1e-14);
        EXPECT_GT(point.wo.z, 0.0);
        EXPECT_NEAR(point.wo.y, -below.wo.y, 1e-14);
      }
    }
  }
}

// A ray through each pixel, met with the plane by its parameter: the same point as the local directions say.
TEST(PatchDirections, AreThoseOfAPinholeFourUnitsAway) {
  constexpr int kSize = 24;
  for (const double light : {0.0, 90.0, 140.0}) {
    const double half = 0.5 * light * kPi / 180.0;
    const Vec3 n = {std::sin(half), 0.0, std::cos(half)};
    const Vec3 t = {std::cos(half), 0.0, -std::sin(half)};
    const double window = 4.0 / (4.0 - std::sin(half));
    std::size_t inside = 0;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const Vec3 ray = normalized(
            {window * ((x + 0.5) / kSize * 2.0 - 1.0), window * (1.0 - (y + 0.5) / kSize * 2.0), -4.0});
        const double distance = -4.0 * n.z / dot(ray, n);
        const Vec3 hit = {distance * ray.x, distance * ray.y, 4.0 + distance * ray.z};
        const bool expected = distance > 0.0 && std::abs(dot(hit, t)) <= 1.0 && std::abs(hit.y) <= 1.0;
        const SurfacePoint point = surface_point(Shape::kPatch, light, kSize, x, y);
        ASSERT_EQ(point.inside, expected) << light << " " << x << " " << y;
        if (!expected) continue;
        ++inside;
        EXPECT_NEAR(point.wo.x, -dot(ray, t), 1e-13);
        EXPECT_NEAR(point.wo.y, -ray.y, 1e-13);
        EXPECT_NEAR(point.wo.z, -dot(ray, n), 1e-13);
      }
    }
    // Seen head-on, it fills the picture.
    EXPECT_TRUE(light > 0.0 || inside == static_cast<std::size_t>(kSize * kSize));
    EXPECT_GT(inside, 20U);
  }
}

TEST(LitPicture, HoldsPiTimesTheMaterialsValueAtEveryPixel) {
  constexpr int kSize = 48;
  unsigned seed = 1;
  for (const Model model : all_models()) {
    for (const double light : kLightAnglesDeg) {
      for (const Shape shape : {Shape::kSphere, Shape::kPatch}) {
        const Material material = random_material(model, seed++);
        const Image image = draw_lit(material, shape, light, kSize);
        for (int y = 0; y < kSize; ++y) {
          for (int x = 0; x < kSize; ++x) {
            const std::size_t pixel = pixel_at(image, x, y);
            const SurfacePoint point = surface_point(shape, light, kSize, x, y);
            ASSERT_EQ(image.state[pixel], point.inside ? PixelState::kValue : PixelState::kOutside);
            const Rgb expected = point.inside ? eval_cos(material, point.wi, point.wo) : Rgb{};
            for (std::size_t c = 0; c < 3; ++c) {
              EXPECT_NEAR(image.rgb[3 * pixel + c], kPi * expected[c], 1e-6 * kPi * expected[c]);
            }
          }
        }
      }
    }
  }
}

TEST(LitPicture, OfATableHoldsItsInterpolation) {
  const MeasuredTable table = testing_support::table_of(isotropic(random_material(Model::kCallisto, 3)));
  constexpr int kSize = 40;
  std::size_t compared = 0;
  for (const double light : kLightAnglesDeg) {
    const Image image = draw_lit(table, Shape::kSphere, light, kSize);
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const SurfacePoint point = surface_point(Shape::kSphere, light, kSize, x, y);
        if (!point.inside || point.wi.z <= 0.0) continue;
        const std::optional<Rgb> f = table.interpolate(point.wi, point.wo);
        const std::size_t pixel = pixel_at(image, x, y);
        ASSERT_EQ(image.state[pixel] == PixelState::kValue, f.has_value());
        if (!f) continue;
        ++compared;
        for (std::size_t c = 0; c < 3; ++c) {
          const double expected = kPi * (*f)[c] * point.wi.z;
          EXPECT_NEAR(image.rgb[3 * pixel + c], expected, 1e-6 * expected);
        }
      }
    }
  }
  EXPECT_GT(compared, 1000U);
}

TEST(LitPicture, IsTheSameFromAllSidesWhenTheLightIsBehindTheCamera) {
  constexpr int kSize = 65;
  for (const Model model : all_models()) {
    const Image image = draw_lit(isotropic(random_material(model, 7)), Shape::kSphere, 0.0, kSize);
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const std::size_t pixel = pixel_at(image, x, y);
        EXPECT_LT(gap(image, pixel, pixel_at(image, kSize - 1 - y, x)), 1e-6);
        EXPECT_LT(gap(image, pixel, pixel_at(image, y, x)), 1e-6);
      }
    }
  }
}

TEST(LitPicture, OfAMaterialMirrorsItsUpperHalf) {
  constexpr int kSize = 64;
  for (const Model model : all_models()) {
    for (const double light : kLightAnglesDeg) {
      const Image image = draw_lit(random_material(model, 9), Shape::kSphere, light, kSize);
      for (int y = 0; y < kSize / 2; ++y) {
        for (int x = 0; x < kSize; ++x) {
          EXPECT_LT(gap(image, pixel_at(image, x, y), pixel_at(image, x, kSize - 1 - y)), 1e-6);
        }
      }
    }
  }
}

TEST(LitPicture, ShowsACrescentOnTheRightUnderALightFromBehind) {
  constexpr int kSize = 256;
  const Image image = draw_lit(Material(Model::kCallisto), Shape::kSphere, 140.0, kSize);
  std::size_t lit = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const std::size_t pixel = pixel_at(image, x, y);
      if (image.rgb[3 * pixel] <= 0.0F) continue;
      ++lit;
      EXPECT_GT(x, kSize / 2);
    }
  }
  // The terminator is a half ellipse: a lit share of (1 + cos 140 deg) / 2 of the disk.
  const double disk = kPi / 4.0 * kSize * kSize;
  EXPECT_NEAR(static_cast<double>(lit) / disk, 0.5 * (1.0 + std::cos(140.0 * kPi / 180.0)), 0.002);
  const auto counts = image.counts();
  EXPECT_NEAR(static_cast<double>(counts[static_cast<std::size_t>(PixelState::kValue)]) / disk, 1.0, 0.001);
}

TEST(LitPicture, GivesAWhiteLambertSurfaceThatFacesTheLightRadianceOne) {
  Material white(Model::kCallisto);
  white.set_effects(Effects().with(Effect::kSpecularFresnelFalloff));
  white.set("base_color", 1.0);
  white.set("specular", 0.0);
  white.set("specular_fresnel_falloff", 0.0);
  const Image sphere = draw_lit(white, Shape::kSphere, 0.0, 33);
  EXPECT_NEAR(sphere.rgb[3 * pixel_at(sphere, 16, 16)], 1.0, 1e-6);
  const Image patch = draw_lit(white, Shape::kPatch, 120.0, 33);
  EXPECT_NEAR(patch.rgb[3 * pixel_at(patch, 16, 16)], 0.5, 1e-6);
}

// A table of f = 1, with one corner of the grid (all theta_h, theta_d from a row on) put to another value.
MeasuredTable table_with(float outer, float outer_blue) {
  Grid grid = testing_support::kSmallGrid;
  const std::size_t cells = grid.cell_count();
  std::vector<float> planes(3 * cells, 1.0F);
  for (int h = 0; h < grid.n_theta_h; ++h) {
    for (int d = grid.n_theta_d / 4; d < grid.n_theta_d; ++d) {
      for (int p = 0; p < grid.n_phi_d; ++p) {
        const std::size_t cell = grid.index(h, d, p);
        planes[cell] = planes[cell + cells] = outer;
        planes[cell + 2 * cells] = outer_blue;
      }
    }
  }
  return MeasuredTable(grid, std::move(planes));
}

TEST(LitPicture, SaysWhyAPixelHasNoValueAndNeverShowsItInShadowOrBeside) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const struct {
    float outer;
    float blue;
    PixelState state;
  } cases[] = {{-1.0F, -1.0F, PixelState::kUnmeasured},
               {0.5F, -0.1F, PixelState::kNegative},
               {0.5F, nan, PixelState::kNotFinite},
               {3e38F, 3e38F, PixelState::kNotFinite}};  // pi times that is more than a float holds
  constexpr int kSize = 64;
  for (const auto& a_case : cases) {
    const MeasuredTable table = table_with(a_case.outer, a_case.blue);
    const Image image = draw_lit(table, Shape::kSphere, 90.0, kSize);
    std::size_t found = 0;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const std::size_t pixel = pixel_at(image, x, y);
        const SurfacePoint point = surface_point(Shape::kSphere, 90.0, kSize, x, y);
        for (std::size_t c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(image.rgb[3 * pixel + c]));
        if (!point.inside || point.wi.z <= 0.0) {
          EXPECT_EQ(image.state[pixel], point.inside ? PixelState::kValue : PixelState::kOutside);
          EXPECT_EQ(image.rgb[3 * pixel], 0.0F);
        } else if (image.state[pixel] != PixelState::kValue) {
          EXPECT_EQ(image.state[pixel], a_case.state);
          EXPECT_EQ(image.rgb[3 * pixel], 0.0F);
          ++found;
        }
      }
    }
    // Camera and light are 90 deg apart, so theta_d is 45 deg everywhere.
    EXPECT_GT(found, 500U);
  }
}

TEST(LitPicture, DoesNotDependOnThreads) {
  const Material material = random_material(Model::kCallisto, 11);
  const Image many = draw_lit(material, Shape::kSphere, 90.0, 100);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(draw_lit(material, Shape::kSphere, 90.0, 100).rgb, many.rgb);
}

TEST(LitPicture, RefusesSizesAndAnglesOutOfRange) {
  const Material material;
  for (const int size : {0, -1, 16385}) {
    EXPECT_THROW(draw_lit(material, Shape::kSphere, 0.0, size), std::invalid_argument) << size;
  }
  for (const double angle : {-1.0, 180.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(draw_lit(material, Shape::kPatch, angle, 8), std::invalid_argument) << angle;
  }
}

}  // namespace
}  // namespace brdfit::render
