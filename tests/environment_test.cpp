// Spheres under an environment against closed forms and against integration over the light's directions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "brdf/albedo.h"
#include "render/sphere.h"
#include "render/view.h"
#include "tests/fit_data.h"
#include "tests/random_parameters.h"

namespace brdfit::render {
namespace {

constexpr double kPi = std::numbers::pi;

Material white_lambert() {
  Material material(Model::kCallisto);
  material.set_effects(Effects().with(Effect::kSpecularFresnelFalloff));
  material.set("base_color", Rgb{1.0, 0.5, 0.02});
  material.set("specular", 0.0);
  material.set("specular_fresnel_falloff", 0.0);
  return material;
}

struct Normal {
  double x;
  double y;
  double z;
};

Normal normal_at(int size, int x, int y) {
  const double px = (2.0 * x + 1.0) / size - 1.0;
  const double py = 1.0 - (2.0 * y + 1.0) / size;
  return {px, py, std::sqrt(1.0 - px * px - py * py)};
}

// Radiance by the midpoint rule over the hemisphere of light, and the share of it that is not held.
struct Expected {
  Rgb radiance{};
  double unmeasured = 0.0;
};

Expected by_light_directions(const Subject& subject, Environment environment, int size, int x, int y,
                             int nodes) {
  const Normal n = normal_at(size, x, y);
  // A frame whose x axis points away from the view.
  const double sin_o = std::sqrt(1.0 - n.z * n.z);
  const Normal t = {n.x * n.z / sin_o, n.y * n.z / sin_o, -sin_o};
  const Normal b = {-n.y / sin_o, n.x / sin_o, 0.0};
  std::vector<Vec3> wi;
  const double step = 1.0 / nodes;
  for (int i = 0; i < nodes; ++i) {
    for (int k = 0; k < 2 * nodes; ++k) {
      const double z = (i + 0.5) * step;
      const double r = std::sqrt(1.0 - z * z);
      const double phi = (k + 0.5) * step * kPi;
      wi.push_back({r * std::cos(phi), r * std::sin(phi), z});
    }
  }
  // The view is (0, 0, 1) in the world.
  const std::vector<Vec3> wo(wi.size(), Vec3{t.z, b.z, n.z});
  std::vector<Rgb> f_cos(wi.size());
  std::vector<PixelState> state(wi.size());
  subject.eval_cos(wi, wo, f_cos, state);
  const double solid_angle = kPi * step * step;
  Expected result;
  for (std::size_t k = 0; k < wi.size(); ++k) {
    const double world_y = wi[k].x * t.y + wi[k].y * b.y + wi[k].z * n.y;
    const double light = environment == Environment::kUniform ? 1.0 : 0.5 * (1.0 + world_y);
    for (std::size_t c = 0; c < 3; ++c) result.radiance[c] += solid_angle * light * f_cos[k][c];
    if (state[k] != PixelState::kValue) result.unmeasured += solid_angle * wi[k].z / kPi;
  }
  return result;
}

double steps(double a, double b) {
  return 255.0 * std::abs(display_value(ViewTransform::kSrgb, a) - display_value(ViewTransform::kSrgb, b));
}

// Compares pixels across the sphere, near its silhouette too.
void expect_integrals(const Subject& subject, const EnvironmentImage& drawn, Environment environment,
                      int nodes, double allowed_steps) {
  const int size = drawn.image.width;
  for (int y = 1; y < size; y += size / 5) {
    for (int x = 1; x < size; x += size / 5) {
      const std::size_t pixel = static_cast<std::size_t>(y * size + x);
      if (drawn.image.state[pixel] == PixelState::kOutside) continue;
      const Expected expected = by_light_directions(subject, environment, size, x, y, nodes);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_LT(steps(drawn.image.rgb[3 * pixel + c], expected.radiance[c]), allowed_steps)
            << x << " " << y << " " << drawn.image.rgb[3 * pixel + c] << " " << expected.radiance[c];
      }
    }
  }
}

TEST(Furnace, IsFlatForALambertMaterial) {
  for (const int size : {1, 2, 33, 256}) {
    const EnvironmentImage drawn = draw_environment(white_lambert(), Environment::kUniform, size);
    EXPECT_TRUE(drawn.converged);
    for (std::size_t k = 0; k < drawn.image.pixel_count(); ++k) {
      if (drawn.image.state[k] == PixelState::kOutside) continue;
      EXPECT_NEAR(drawn.image.rgb[3 * k], 1.0, 1e-4);
      EXPECT_NEAR(drawn.image.rgb[3 * k + 1], 0.5, 0.5e-4);
      EXPECT_NEAR(drawn.image.rgb[3 * k + 2], 0.02, 0.02e-4);
    }
  }
}

TEST(Gradient, OnALambertMaterialIsLinearInTheNormalsHeight) {
  constexpr int kSize = 65;
  const EnvironmentImage drawn = draw_environment(white_lambert(), Environment::kGradient, kSize);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y * kSize + x);
      if (drawn.image.state[pixel] == PixelState::kOutside) continue;
      // The mean of (1 + y) / 2 under a cosine around the normal.
      EXPECT_NEAR(drawn.image.rgb[3 * pixel], 0.5 + normal_at(kSize, x, y).y / 3.0, 1e-4);
    }
  }
}

TEST(EnvironmentPicture, AgreesWithIntegrationOverLightDirectionsForMaterials) {
  testing_support::Random random(5);
  for (int k = 0; k < 9; ++k) {
    const Model model = all_models()[static_cast<std::size_t>(k % 3)];
    Material material =
        testing_support::interior_material(model, effects_of(model).without(Effect::kAnisotropic), random);
    // Wide enough for the midpoint rule.
    material.set("roughness", testing_support::uniform(random, 0.4, 1.0));
    if (model == Model::kBurley) material.set_effects(material.effects().without(Effect::kClearcoat));
    for (const Environment environment : {Environment::kUniform, Environment::kGradient}) {
      const EnvironmentImage drawn = draw_environment(material, environment, 41);
      EXPECT_TRUE(drawn.converged);
      EXPECT_EQ(drawn.unmeasured_fraction, 0.0);
      expect_integrals(material, drawn, environment, 200, 0.5);
    }
  }
}

TEST(EnvironmentPicture, OfAnyMaterialHasItsDirectionalAlbedoToOnePercent) {
  constexpr int kSize = 101;
  testing_support::Random random(8);
  for (int k = 0; k < 30; ++k) {
    const Model model = all_models()[static_cast<std::size_t>(k % 3)];
    Material material =
        testing_support::random_material(model, effects_of(model).without(Effect::kAnisotropic), random);
    if (k % 2 == 0) material.set("roughness", k % 4 == 0 ? 0.03 : 0.1);
    const EnvironmentImage drawn = draw_environment(material, Environment::kUniform, kSize);
    EXPECT_TRUE(drawn.converged) << drawn.error_steps;
    for (const int x : {50, 60, 80, 95}) {
      const Rgb albedo = directional_albedo(material, std::acos(normal_at(kSize, x, 50).z));
      for (std::size_t c = 0; c < 3; ++c) {
        const double radiance = drawn.image.rgb[3 * static_cast<std::size_t>(50 * kSize + x) + c];
        EXPECT_NEAR(radiance, albedo[c], 0.01 * albedo[c]) << name_of(model) << " " << x;
      }
    }
  }
}

TEST(EnvironmentPicture, ResolvesTheNarrowestHighlight) {
  // A perfect mirror but for its width: single scattering in a lobe of alpha = 1e-4 loses nothing.
  Material mirror(Model::kLambertGgx);
  mirror.set("base_color", 1.0);
  mirror.set("metallic", 1.0);
  mirror.set("roughness", 0.01);
  constexpr int kSize = 256;
  const EnvironmentImage drawn = draw_environment(mirror, Environment::kGradient, kSize);
  EXPECT_TRUE(drawn.converged);
  for (int y = 20; y < kSize; y += 36) {
    for (int x = 20; x < kSize; x += 36) {
      const std::size_t pixel = static_cast<std::size_t>(y * kSize + x);
      if (drawn.image.state[pixel] == PixelState::kOutside) continue;
      // The mirror direction of the view (0, 0, 1) has the height 2 n.z n.y.
      const Normal n = normal_at(kSize, x, y);
      EXPECT_NEAR(drawn.image.rgb[3 * pixel], 0.5 * (1.0 + 2.0 * n.z * n.y), 1e-3);
    }
  }
}

// Values that differ between phi_d and pi - phi_d; nothing beyond some theta_d if that is asked for.
MeasuredTable lopsided_table(bool with_hole) {
  const Grid grid = {20, 20, 24, CellAnchor::kLowerEdge};
  std::vector<float> planes(3 * grid.cell_count());
  for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
    const HalfDiff angles = grid.angles_of(cell);
    const bool hole = with_hole && angles.theta_d_rad > 0.8;
    for (std::size_t c = 0; c < 3; ++c) {
      const double f = 0.1 + 0.05 * static_cast<double>(c) + 0.08 * std::sin(2.0 * angles.phi_d_rad) +
                       0.2 * std::exp(-10.0 * angles.theta_h_rad);
      planes[cell + c * grid.cell_count()] = hole ? -1.0F : static_cast<float>(f);
    }
  }
  return MeasuredTable(grid, std::move(planes));
}

TEST(EnvironmentPicture, AgreesWithIntegrationOverLightDirectionsForTables) {
  const MeasuredTable table = lopsided_table(false);
  for (const Environment environment : {Environment::kUniform, Environment::kGradient}) {
    const EnvironmentImage drawn = draw_environment(table, environment, 41);
    EXPECT_TRUE(drawn.converged) << drawn.error_steps;
    EXPECT_EQ(drawn.unmeasured_fraction, 0.0);
    expect_integrals(table, drawn, environment, 200, 0.5);
  }
}

TEST(EnvironmentPicture, SaysHowMuchOfTheHemisphereATableLacks) {
  const MeasuredTable table = lopsided_table(true);
  const EnvironmentImage drawn = draw_environment(table, Environment::kUniform, 41);
  // What is missing contributes nothing, and ends at an edge that integration finds slowly.
  expect_integrals(table, drawn, Environment::kUniform, 200, 1.0);
  double unmeasured = 0.0;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x) {
      // Most is missing near the silhouette.
      if (!(normal_at(41, x, y).z < 0.25)) continue;
      const Expected at_pixel = by_light_directions(table, Environment::kUniform, 41, x, y, 150);
      unmeasured = std::max(unmeasured, at_pixel.unmeasured);
    }
  }
  EXPECT_GT(unmeasured, 0.1);
  EXPECT_NEAR(drawn.unmeasured_fraction, unmeasured, 0.01);
  EXPECT_EQ(drawn.image.counts()[static_cast<std::size_t>(PixelState::kUnmeasured)], 0U);
}

TEST(EnvironmentPicture, DoesNotClaimToHaveConvergedOnATableOfNoise) {
  const Grid grid = {90, 90, 180, CellAnchor::kLowerEdge};
  std::vector<float> planes(3 * grid.cell_count(), 0.01F);
  testing_support::Random random(2);
  for (std::size_t k = 0; k < 100; ++k) {
    const std::size_t cell = random() % grid.cell_count();
    for (std::size_t c = 0; c < 3; ++c) planes[cell + c * grid.cell_count()] = 300.0F;
  }
  const MeasuredTable table(grid, std::move(planes));
  const EnvironmentImage drawn = draw_environment(table, Environment::kUniform, 41);
  EXPECT_GE(drawn.error_steps, 0.5);
  EXPECT_FALSE(drawn.converged);
}

TEST(EnvironmentPicture, StatesErrorsThatCoverThoseFound) {
  Material material(Model::kCallisto);
  material.set("roughness", 0.5);
  const EnvironmentImage drawn = draw_environment(material, Environment::kGradient, 41);
  expect_integrals(material, drawn, Environment::kGradient, 400, drawn.error_steps + 0.02);
  EXPECT_GT(drawn.evaluations, 1000);
}

TEST(EnvironmentPicture, DoesNotDependOnThreads) {
  const MeasuredTable table = lopsided_table(true);
  const EnvironmentImage many = draw_environment(table, Environment::kGradient, 50);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const EnvironmentImage one = draw_environment(table, Environment::kGradient, 50);
  EXPECT_EQ(one.image.rgb, many.image.rgb);
  EXPECT_EQ(one.error_steps, many.error_steps);
  EXPECT_EQ(one.evaluations, many.evaluations);
}

TEST(EnvironmentPicture, RefusesWhatItCannotDraw) {
  Material brushed(Model::kBurley);
  EXPECT_THROW(draw_environment(brushed, Environment::kUniform, 0), std::invalid_argument);
  brushed.set_effects(effects_of(Model::kBurley));
  brushed.set("anisotropic", 0.5);
  EXPECT_THROW(draw_environment(brushed, Environment::kUniform, 8), std::invalid_argument);
  brushed.set("anisotropic", 0.0);
  EXPECT_NO_THROW(draw_environment(brushed, Environment::kUniform, 8));
}

}  // namespace
}  // namespace brdfit::render
