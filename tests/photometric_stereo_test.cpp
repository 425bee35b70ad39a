// Photometric stereo: exact on Lambert surfaces, robust against outliers, finite on hard cases.
#include "bake/photometric_stereo.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "bake_data.h"

namespace brdfit::bake {
namespace {

using test_data::cap_of_lights;
using test_data::is_sound;
using test_data::lambert_sphere;
using test_data::largest_albedo_error;
using test_data::largest_normal_error_deg;
using test_data::TrueStack;

Surface solve(const TrueStack& s) {
  return photometric_stereo(s.info, s.block, all_lights(s.info));
}

void scale_values(TexelBlock& block, float factor) {
  for (float& x : block.rgb) x *= factor;
}

// 1e-6 of a radian, in degrees.
constexpr double kExactDeg = 1e-6 * 180.0 / std::numbers::pi;

TEST(PhotometricStereo, RecoversALambertSphereExactly) {
  const TrueStack s = lambert_sphere(21, cap_of_lights(40, 70.0));
  const Surface surface = solve(s);
  EXPECT_LT(largest_normal_error_deg(surface, s.truth), kExactDeg);
  EXPECT_LT(largest_albedo_error(surface, s.truth), 1e-6);
  for (const TexelState state : surface.state) EXPECT_EQ(state, TexelState::kOk);
}

TEST(PhotometricStereo, DoesNotDependOnTheUnitOfTheValues) {
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  TrueStack s = lambert_sphere(11, cap_of_lights(12, 20.0));
  for (float& x : s.block.rgb) x += noise(random);
  const Surface one = solve(s);
  scale_values(s.block, 1024.0F);
  const Surface scaled = solve(s);
  EXPECT_LT(largest_normal_error_deg(one, scaled), 1e-3);
  EXPECT_EQ(one.state, scaled.state);
  for (std::size_t k = 0; k < one.albedo.size(); ++k) {
    EXPECT_NEAR(scaled.albedo[k], 1024.0F * one.albedo[k], 0.01F * one.albedo[k] * 1024.0F + 1e-3F);
  }
}

TEST(PhotometricStereo, LightsMayHaveAnyColourAndIntensity) {
  TrueStack s = lambert_sphere(9, cap_of_lights(30, 60.0));
  for (std::size_t k = 0; k < s.info.lights.size(); ++k) {
    const Rgb colour = {0.5 + 0.1 * static_cast<double>(k % 7), 1.0, 2.0 - 0.2 * static_cast<double>(k % 5)};
    s.info.lights[k].intensity = colour;
    for (std::size_t c = 0; c < 3; ++c) {
      for (float& x : s.block.plane(k, c)) x = static_cast<float>(x * colour[c]);
    }
  }
  const Surface surface = solve(s);
  EXPECT_LT(largest_normal_error_deg(surface, s.truth), 2.0 * kExactDeg);
  EXPECT_LT(largest_albedo_error(surface, s.truth), 2e-6);
}

TEST(PhotometricStereo, NearLightsKeepTheirDirectionPerTexel) {
  TrueStack s = lambert_sphere(13, cap_of_lights(24, 50.0));
  s.info.plane = {{-0.6, 0.6, 0.0}, 0.1};
  for (StackLight& light : s.info.lights) {
    const Vec3& d = light.direction;
    light.position = Vec3{1.5 * d.x, 1.5 * d.y, 1.5 * d.z};
  }
  const std::size_t n = s.block.count();
  for (std::size_t k = 0; k < s.info.lights.size(); ++k) {
    for (std::size_t t = 0; t < n; ++t) {
      const Incidence at = incidence(s.info, k, s.block.texels[t]);
      const Vec3 normal = {s.truth.normals[t], s.truth.normals[n + t], s.truth.normals[2 * n + t]};
      const double shown = std::max(test_data::dot(normal, at.direction), 0.0) * at.falloff;
      for (std::size_t c = 0; c < 3; ++c) {
        s.block.plane(k, c)[t] = static_cast<float>(shown * s.truth.albedo[c * n + t]);
      }
    }
  }
  const Surface surface = solve(s);
  EXPECT_LT(largest_normal_error_deg(surface, s.truth), 3.0 * kExactDeg);
  EXPECT_LT(largest_albedo_error(surface, s.truth), 3e-6);
}

TEST(PhotometricStereo, AFifthOfOutliersChangesLittle) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> share(0.0F, 1.0F);
  TrueStack s = lambert_sphere(15, cap_of_lights(50, 60.0));
  for (std::size_t k = 0; k < s.block.lights; ++k) {
    for (std::size_t t = 0; t < s.block.count(); ++t) {
      if (share(random) > 0.2F) continue;
      const float factor = share(random) < 0.5F ? 0.0F : 1.0F + 4.0F * share(random);
      for (std::size_t c = 0; c < 3; ++c) s.block.plane(k, c)[t] *= factor;
    }
  }
  StereoOptions plain;
  plain.absolute_rounds = 0;
  plain.robust_width = 1e6;
  const Surface least_squares = photometric_stereo(s.info, s.block, all_lights(s.info), plain);
  const double error = test_data::mean_normal_error_deg(solve(s), s.truth);
  EXPECT_LT(error, 0.3);
  EXPECT_LT(error, 0.05 * test_data::mean_normal_error_deg(least_squares, s.truth));
}

TEST(PhotometricStereo, ValuesWithoutWeightDoNotCount) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  TrueStack s = lambert_sphere(9, cap_of_lights(20, 60.0));
  s.block.weight.assign(s.block.lights * s.block.count(), 1.0F);
  for (std::size_t t = 0; t < s.block.count(); ++t) {
    const std::size_t k = t % s.block.lights;
    for (std::size_t c = 0; c < 3; ++c) s.block.plane(k, c)[t] = t % 2 == 0 ? 1e6F : nan;
    s.block.weight[k * s.block.count() + t] = 0.0F;
  }
  const Surface surface = solve(s);
  EXPECT_LT(largest_normal_error_deg(surface, s.truth), kExactDeg);
  EXPECT_LT(largest_albedo_error(surface, s.truth), 1e-6);
}

TEST(PhotometricStereo, LeavesOutLightsThatAreNotChosen) {
  TrueStack s = lambert_sphere(9, cap_of_lights(20, 60.0));
  const LightChoice held_out = {3, 11};
  for (const std::uint32_t k : held_out) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (float& x : s.block.plane(k, c)) x = 5.0F;
    }
  }
  const Surface surface = photometric_stereo(s.info, s.block, without(s.info, held_out));
  EXPECT_LT(largest_normal_error_deg(surface, s.truth), kExactDeg);
}

TEST(PhotometricStereo, EstimatesAlbedoAloneWhereNormalsAreGiven) {
  TrueStack s = lambert_sphere(9, cap_of_lights(20, 60.0));
  s.info.has_normals = true;
  s.block.normals = s.truth.normals;
  const Surface surface = solve(s);
  EXPECT_EQ(surface.normals, s.truth.normals);
  EXPECT_LT(largest_albedo_error(surface, s.truth), 1e-6);
  s.info.has_albedo = true;
  s.block.albedo.assign(3 * s.block.count(), 0.25F);
  EXPECT_EQ(solve(s).albedo, s.block.albedo);
}

TEST(PhotometricStereo, NarrowSetsOfLightsAreExactWithoutNoise) {
  const TrueStack s = lambert_sphere(9, cap_of_lights(16, 10.0));
  const Surface surface = solve(s);
  EXPECT_TRUE(is_sound(surface));
  EXPECT_LT(largest_normal_error_deg(surface, s.truth), 0.05);
}

TEST(PhotometricStereo, NarrowSetsOfLightsWithNoiseLeanTowardsTheView) {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0.0F, 0.1F);
  TrueStack s = lambert_sphere(25, cap_of_lights(12, 5.0));
  for (float& x : s.block.rgb) x += noise(random);
  const Surface surface = solve(s);
  EXPECT_TRUE(is_sound(surface));
  std::size_t weak = 0;
  double slope = 0.0;
  for (std::size_t t = 0; t < surface.count(); ++t) {
    if (surface.state[t] == TexelState::kWeakNormal) ++weak;
    slope += 1.0 - surface.normals[2 * surface.count() + t];
  }
  EXPECT_GT(weak, surface.count() / 2);
  EXPECT_LT(slope / static_cast<double>(surface.count()), 0.2);
}

TEST(PhotometricStereo, OneDirectionOrOnePlaneOfLightsIsAWeakNormal) {
  TrueStack plane = lambert_sphere(9, {{0.0, 0.0, 1.0},
                                       {0.5, 0.0, std::sqrt(0.75)},
                                       {-0.5, 0.0, std::sqrt(0.75)},
                                       {0.3, 0.0, std::sqrt(0.91)}});
  const Surface surface = solve(plane);
  EXPECT_TRUE(is_sound(surface));
  for (const TexelState state : surface.state) EXPECT_EQ(state, TexelState::kWeakNormal);
  const TrueStack same = lambert_sphere(9, std::vector<Vec3>(6, Vec3{0.3, 0.0, std::sqrt(0.91)}));
  const Surface flat = solve(same);
  EXPECT_TRUE(is_sound(flat));
  for (std::size_t t = 0; t < flat.count(); ++t) EXPECT_GT(flat.normals[2 * flat.count() + t], 0.999F);
}

TEST(PhotometricStereo, FewerThanThreeLightsGiveTheAlbedoAlone) {
  const TrueStack s = lambert_sphere(9, {{0.0, 0.0, 1.0}, {0.6, 0.0, 0.8}});
  const Surface surface = solve(s);
  EXPECT_TRUE(is_sound(surface));
  for (std::size_t t = 0; t < surface.count(); ++t) {
    EXPECT_EQ(surface.state[t], TexelState::kFewLights);
    EXPECT_EQ(surface.normals[2 * surface.count() + t], 1.0F);
    EXPECT_GT(surface.albedo[t], 0.0F);
  }
  const Surface none = photometric_stereo(s.info, s.block, {});
  EXPECT_TRUE(is_sound(none));
  for (const TexelState state : none.state) EXPECT_EQ(state, TexelState::kUnlit);
}

TEST(PhotometricStereo, HardTexelsAreFiniteAndHaveAState) {
  TrueStack s = lambert_sphere(8, cap_of_lights(20, 60.0));
  const std::size_t n = s.block.count();
  s.block.weight.assign(s.block.lights * n, 1.0F);
  for (std::size_t k = 0; k < s.block.lights; ++k) {
    s.block.weight[k * n + 1] = 0.0F;
    for (std::size_t c = 0; c < 3; ++c) {
      s.block.plane(k, c)[0] = 0.0F;
      s.block.plane(k, c)[2] = 1e8F * s.block.plane(k, c)[2];
      s.block.plane(k, c)[3] = -0.01F;
      s.block.plane(k, c)[4] = k == 4 ? 1e4F : 0.0F;
      s.block.plane(k, c)[5] = 1e-12F * s.block.plane(k, c)[5];
      // As if it looked away from the viewer: bright where the light is low.
      s.block.plane(k, c)[6] = static_cast<float>(
          std::max(0.0, -s.info.lights[k].direction.x - 0.8 * s.info.lights[k].direction.z + 0.3));
    }
  }
  const Surface surface = solve(s);
  EXPECT_TRUE(is_sound(surface));
  EXPECT_EQ(surface.state[0], TexelState::kBlack);
  EXPECT_EQ(surface.state[1], TexelState::kUnlit);
  EXPECT_EQ(surface.state[2], TexelState::kOk);
  EXPECT_EQ(surface.state[3], TexelState::kBlack);
  EXPECT_EQ(surface.state[4], TexelState::kFewLights);
  EXPECT_EQ(surface.state[5], TexelState::kOk);
  EXPECT_LT(test_data::normal_error_deg(surface, s.truth, 2), 1e-3);
  EXPECT_LT(test_data::normal_error_deg(surface, s.truth, 5), 1e-3);
}

TEST(PhotometricStereo, ALightOnTheHorizonWithNoiseDoesLittle) {
  std::mt19937 random(9);
  std::normal_distribution<float> noise(0.0F, 0.02F);
  std::vector<Vec3> lights = cap_of_lights(20, 60.0);
  lights.push_back({1.0, 0.0, 0.0});
  lights.push_back({-std::sqrt(1.0 - 1e-8), 0.0, 1e-4});
  lights.push_back(lights[2]);  // twice
  TrueStack s = lambert_sphere(15, lights);
  for (float& x : s.block.rgb) x += noise(random);
  const Surface surface = solve(s);
  EXPECT_TRUE(is_sound(surface));
  double squares = 0.0;
  for (std::size_t t = 0; t < surface.count(); ++t) {
    squares += std::pow(test_data::normal_error_deg(surface, s.truth, t), 2.0);
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(surface.count())), 3.0);
}

TEST(PhotometricStereo, NoiseUnderGrazingLightsIsNoAlbedo) {
  TrueStack s = lambert_sphere(8, {{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, -1.0, 0.0}});
  s.info.has_normals = true;
  s.block.normals.assign(3 * s.block.count(), 0.0F);
  for (std::size_t t = 0; t < s.block.count(); ++t) {
    s.block.normals[t] = 1e-5F;
    s.block.normals[2 * s.block.count() + t] = 1.0F;
  }
  std::ranges::fill(s.block.rgb, 0.01F);
  for (const float albedo : solve(s).albedo) EXPECT_LT(albedo, 0.1F);
}

TEST(PhotometricStereo, IsTheSameForAnyNumberOfThreads) {
  const TrueStack s = lambert_sphere(40, cap_of_lights(15, 60.0));
  const Surface many = solve(s);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Surface single = solve(s);
  EXPECT_EQ(many.normals, single.normals);
  EXPECT_EQ(many.albedo, single.albedo);
}

TEST(PhotometricStereo, RefusesWhatDoesNotFit) {
  TrueStack s = lambert_sphere(4, cap_of_lights(5, 60.0));
  EXPECT_THROW(photometric_stereo(s.info, s.block, {7}), std::invalid_argument);
  StereoOptions options;
  options.slope_deviation = 0.0;
  EXPECT_THROW(photometric_stereo(s.info, s.block, all_lights(s.info), options), std::invalid_argument);
  s.block.rgb.pop_back();
  EXPECT_THROW(solve(s), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::bake
