// Synthetic stacks: the answers are known, and every fault does what it says.
#include "data/synthetic/stack.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "brdf/models.h"
#include "io/error.h"

namespace brdfit::synthetic {
namespace {

Material matte(double albedo) {
  Material material(Model::kLambertGgx);
  material.set("base_color", albedo);
  material.set("specular", 0.0);
  return material;
}

StackRecipe recipe_of(Relief relief) {
  StackRecipe recipe;
  recipe.name = "test";
  recipe.width = 24;
  recipe.height = 16;
  recipe.shape.relief = relief;
  recipe.shape.wavelength_px = 12;
  recipe.lights.count = 12;
  recipe.materials = {matte(0.5)};
  recipe.cast_shadows = false;
  return recipe;
}

TexelBlock whole(SyntheticStack& stack) {
  return stack.read_rows(0, stack.info().height);
}

double dot(const Vec3& a, const Vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

TEST(SyntheticStack, AFlatSurfaceIsTheMaterialUnderItsLights) {
  SyntheticStack stack(recipe_of(Relief::kPlane));
  const TexelBlock block = whole(stack);
  for (std::size_t light = 0; light < block.lights; ++light) {
    const Rgb f = eval_cos(matte(0.5), stack.info().lights[light].direction, {0.0, 0.0, 1.0});
    for (std::size_t k = 0; k < block.count(); ++k) {
      EXPECT_NEAR(block.plane(light, 0)[k], M_PI * f[0], 1e-6);
    }
  }
}

TEST(SyntheticStack, ACurvedSurfaceIsTheMaterialInEachTexelsFrame) {
  for (const Relief relief : {Relief::kSphere, Relief::kBumps}) {
    SyntheticStack stack(recipe_of(relief));
    const TexelBlock block = whole(stack);
    for (std::size_t light = 0; light < block.lights; ++light) {
      const Vec3& towards = stack.info().lights[light].direction;
      for (std::size_t k = 0; k < block.count(); ++k) {
        const Vec3 n = stack.normal(block.texels[k]);
        // A frame made another way than the generator's: x within the plane of normal and view.
        const double sine = std::sqrt(1.0 - n.z * n.z);
        if (stack.is_masked(block.texels[k]) || sine < 1e-6) continue;
        const Vec3 y{-n.y / sine, n.x / sine, 0.0};
        const Vec3 x{y.y * n.z, -y.x * n.z, y.x * n.y - y.y * n.x};
        const Rgb f = eval_cos(matte(0.5), {dot(x, towards), dot(y, towards), dot(n, towards)},
                               {dot(x, Vec3{0.0, 0.0, 1.0}), 0.0, n.z});
        EXPECT_NEAR(block.plane(light, 0)[k], M_PI * f[0], 1e-6) << k;
      }
    }
  }
}

TEST(SyntheticStack, NormalsAreUnitAndFaceTheCamera) {
  for (const Relief relief : {Relief::kPlane, Relief::kSphere, Relief::kBumps}) {
    const SyntheticStack stack(recipe_of(relief));
    for (std::uint32_t texel = 0; texel < stack.info().texel_count(); ++texel) {
      const Vec3 n = stack.normal(texel);
      EXPECT_NEAR(dot(n, n), 1.0, 1e-12);
      EXPECT_GT(n.z, 0.0);
    }
  }
}

TEST(SyntheticStack, ASphereLeansOutwardsAndUpwardsAtTheTop) {
  const SyntheticStack stack(recipe_of(Relief::kSphere));
  EXPECT_GT(stack.normal(24 * 2 + 12).y, 0.5);
  EXPECT_LT(stack.normal(24 * 13 + 12).y, -0.5);
  EXPECT_GT(stack.normal(24 * 8 + 17).x, 0.5);
  EXPECT_TRUE(stack.is_masked(0));
}

TEST(SyntheticStack, TheResidualIsTheKnownAmplitudesOnTheKnownLobes) {
  StackRecipe with = recipe_of(Relief::kBumps);
  with.residual = {4, 6.0, 120.0, 0.3};
  SyntheticStack stack(with);
  StackRecipe without = with;
  without.residual.lobes = 0;
  SyntheticStack plain(without);
  const TexelBlock block = whole(stack);
  const TexelBlock base = whole(plain);
  double largest = 0.0;
  for (std::size_t light = 0; light < block.lights; ++light) {
    const Vec3& direction = stack.info().lights[light].direction;
    for (std::size_t k = 0; k < block.count(); ++k) {
      double sum = 0.0;
      for (std::size_t lobe = 0; lobe < 4; ++lobe) {
        sum += stack.amplitude(block.texels[k], lobe) * eval(stack.lobes()[lobe], direction);
      }
      const double expected = sum * std::max(0.0, dot(stack.normal(block.texels[k]), direction));
      EXPECT_NEAR(block.plane(light, 1)[k] - base.plane(light, 1)[k], expected, 1e-6);
      largest = std::max(largest, std::abs(expected));
    }
  }
  EXPECT_GT(largest, 0.05);
}

TEST(SyntheticStack, ReadsTheSameInAnyOrderAndOnAnyNumberOfThreads) {
  StackRecipe recipe = recipe_of(Relief::kBumps);
  recipe.noise = {0.05, 0.01};
  recipe.faults.hot_pixels = 5;
  recipe.cast_shadows = true;
  SyntheticStack stack(recipe);
  const TexelBlock block = whole(stack);
  const std::vector<std::uint32_t> some{3, 77, 200};
  const TexelBlock chosen = stack.read_texels(some);
  for (std::size_t light = 0; light < block.lights; ++light) {
    for (std::size_t k = 0; k < some.size(); ++k) {
      EXPECT_EQ(chosen.plane(light, 2)[k], block.plane(light, 2)[some[k]]);
    }
  }
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(whole(stack).rgb, block.rgb);
}

TEST(SyntheticStack, LowLightsCastShadowsAndHighOnesDoNot) {
  StackRecipe recipe = recipe_of(Relief::kBumps);
  recipe.width = 64;
  recipe.height = 64;
  recipe.shape.slope = 2.0;
  recipe.cast_shadows = true;
  const SyntheticStack stack(recipe);
  int low = 0;
  for (std::uint32_t texel = 0; texel < stack.info().texel_count(); ++texel) {
    low += stack.in_cast_shadow(texel, {0.995, 0.0, 0.0998749}) ? 1 : 0;
    EXPECT_FALSE(stack.in_cast_shadow(texel, {0.0, 0.0, 1.0}));
  }
  EXPECT_GT(low, 64 * 64 / 5);
  EXPECT_LT(low, 64 * 64);
}

TEST(SyntheticStack, FaultsChangeWhatTheySay) {
  const StackRecipe clean = recipe_of(Relief::kBumps);
  SyntheticStack good(clean);
  const TexelBlock block = whole(good);
  StackRecipe recipe = clean;
  recipe.faults.gains = {{2, 1.3}};
  recipe.faults.swapped = {{0, 5}};
  recipe.faults.upside_down = true;
  SyntheticStack bad(recipe);
  const TexelBlock faulty = whole(bad);
  for (std::size_t k = 0; k < block.count(); ++k) {
    EXPECT_NEAR(faulty.plane(2, 0)[k], 1.3F * block.plane(2, 0)[k], 1e-6);
    EXPECT_EQ(faulty.plane(3, 0)[k], block.plane(3, 0)[k]);
  }
  // The surface is lit as before; what the manifest says of it is wrong.
  EXPECT_EQ(bad.info().lights[0].direction.y, -good.info().lights[5].direction.y);
  EXPECT_EQ(bad.info().lights[0].name, good.info().lights[0].name);
}

TEST(SyntheticStack, HotPixelsAreHotUnderSomeLights) {
  StackRecipe recipe = recipe_of(Relief::kPlane);
  recipe.faults.hot_pixels = 3;
  SyntheticStack stack(recipe);
  const TexelBlock block = whole(stack);
  const auto hot = std::count_if(block.rgb.begin(), block.rgb.end(), [](float v) { return v > 100.0F; });
  EXPECT_GT(hot, 0);
  EXPECT_LT(hot, 3 * 3 * 12);
}

TEST(SyntheticStack, NoiseHasItsSize) {
  StackRecipe recipe = recipe_of(Relief::kPlane);
  recipe.noise = {0.0, 0.02};
  SyntheticStack noisy(recipe);
  recipe.noise = {};
  SyntheticStack clean(recipe);
  const TexelBlock a = whole(noisy);
  const TexelBlock b = whole(clean);
  double squares = 0.0;
  for (std::size_t k = 0; k < a.rgb.size(); ++k) squares += std::pow(a.rgb[k] - b.rgb[k], 2);
  // 13824 draws: the estimate's standard deviation is 0.6% of it.
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(a.rgb.size())), 0.02, 0.0006);
}

TEST(SyntheticStack, NearLightsFallOff) {
  StackRecipe recipe = recipe_of(Relief::kPlane);
  recipe.lights.distance = 1.0;
  SyntheticStack stack(recipe);
  EXPECT_TRUE(has_near_lights(stack.info()));
  const TexelBlock block = whole(stack);
  const Incidence from = incidence(stack.info(), 4, 9);
  EXPECT_NE(from.falloff, 1.0);
  const Rgb f = eval_cos(recipe.materials[0], from.direction, {0.0, 0.0, 1.0});
  EXPECT_NEAR(block.plane(4, 0)[9], M_PI * f[0] * from.falloff, 1e-6);
}

TEST(SyntheticStack, AlbedoVariesOverTexelsAndIsKnown) {
  StackRecipe recipe = recipe_of(Relief::kPlane);
  recipe.albedo_variation = 0.6;
  recipe.materials = {matte(0.8), matte(0.3)};
  recipe.patch_px = 4;
  SyntheticStack stack(recipe);
  double least = 1.0;
  double most = 0.0;
  for (std::uint32_t texel = 0; texel < stack.info().texel_count(); ++texel) {
    least = std::min(least, stack.albedo(texel)[0]);
    most = std::max(most, stack.albedo(texel)[0]);
  }
  EXPECT_LT(least, 0.25);
  EXPECT_GT(most, 0.6);
  EXPECT_LE(most, 0.8);
}

TEST(StackRecipe, RoundTripsThroughJson) {
  StackRecipe recipe = recipe_of(Relief::kSphere);
  recipe.residual = {4, 6.0, 120.0, 0.3};
  recipe.faults = {{{1, 0.7}}, {{2, 3}}, true, 4};
  recipe.files = {"jpg", "srgb", 95, "4:2:0", "lp", true, true};
  recipe.noise = {0.1, 0.2};
  recipe.seed = 0xffffffffffffffffU;
  EXPECT_EQ(stack_recipe_from_json(stack_recipe_to_json(recipe), "here"), recipe);
}

TEST(StackRecipe, RefusesWhatIsUnknownOrDoesNotAgree) {
  const io::Json good = stack_recipe_to_json(recipe_of(Relief::kPlane));
  const auto expect_refused = [&](auto&& change) {
    io::Json json = good;
    change(json);
    EXPECT_THROW(stack_recipe_from_json(json, "here"), io::IoError) << json.dump();
  };
  expect_refused([](io::Json& json) { json["colour"] = 1; });
  expect_refused([](io::Json& json) { json["materials"] = io::Json::array(); });
  expect_refused([](io::Json& json) { json["shape"]["relief"] = "cube"; });
  expect_refused([](io::Json& json) {
    json["faults"]["gains"] = io::Json::array({io::Json::array({99, 1.0})});
  });
  expect_refused([](io::Json& json) { json["faults"]["swapped"] = io::Json::array({io::Json::array({1})}); });
  expect_refused([](io::Json& json) { json["cast_shadows"] = 1; });
  expect_refused([](io::Json& json) { json["files"]["transfer"] = "log"; });
  for (const char* format : {"", "/../exr", "exr/", "e.xr"}) {
    expect_refused([format](io::Json& json) { json["files"]["format"] = format; });
  }
  expect_refused([](io::Json& json) { json["name"] = "a/b"; });
  expect_refused([](io::Json& json) { json["lights"]["count"] = 0; });
}

}  // namespace
}  // namespace brdfit::synthetic
