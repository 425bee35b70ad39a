// The Realis correction on a device, from packed bytes, against the reconstruction on the processor.
#include "gpu/realis_pass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "bake/pack.h"
#include "bake/reconstruct.h"
#include "brdf/kernel/realis.h"
#include "tests/gpu_device.h"

namespace brdfit {
namespace {

constexpr std::size_t kTexels = 1000;

using Random = std::mt19937_64;

float uniform(Random& random, double lower, double upper) {
  return static_cast<float>(std::uniform_real_distribution<double>(lower, upper)(random));
}

Vec3 direction(Random& random, double lowest_z) {
  const double z = uniform(random, lowest_z, 1.0);
  const double phi = uniform(random, 0.0, 6.2831853);
  const double s = std::sqrt(1.0 - z * z);
  return {s * std::cos(phi), s * std::sin(phi), z};
}

RealisAsset random_asset(int lobes, int dominant, int bits, RealisColour colour, Random& random) {
  RealisAsset asset;
  asset.name = "made up";
  asset.width = 40;
  asset.height = static_cast<int>(kTexels / 40);
  asset.colour = colour;
  asset.albedo_in_modulation = random() % 2 == 0;
  for (int k = 0; k < lobes; ++k) {
    // Of floats, as the device has them.
    const Vec3 axis = direction(random, 0.0);
    asset.lobes.push_back(
        {{static_cast<float>(axis.x), static_cast<float>(axis.y), static_cast<float>(axis.z)},
         uniform(random, 0.0, 8.0),
         uniform(random, -1.0, -0.2)});
  }
  asset.packing.bits = bits;
  asset.packing.dominant = dominant;
  for (std::size_t plane = 0; plane < asset.plane_count(); ++plane) {
    const int top = realis_top_code(bits);
    asset.packing.ranges.push_back({uniform(random, 0.2, 1.0) / static_cast<float>(top),
                                    static_cast<int>(random() % static_cast<unsigned>(top))});
  }
  return asset;
}

// Texels of an asset, as the device and as the processor take them.
struct Texels {
  bake::RunTimeTexels run_time;
  std::vector<std::uint32_t> codes;
  std::vector<std::uint32_t> masks;

  RealisTexels view() const {
    return {kTexels,
            codes,
            masks,
            run_time.surface.normals,
            run_time.surface.albedo,
            run_time.baked.normals,
            run_time.baked.albedo,
            run_time.chroma};
  }
};

bake::Surface random_surface(Random& random) {
  bake::Surface surface;
  surface.normals.resize(3 * kTexels);
  surface.albedo.resize(3 * kTexels);
  surface.state.assign(kTexels, bake::TexelState::kOk);
  for (std::size_t k = 0; k < kTexels; ++k) {
    const Vec3 n = direction(random, 0.3);
    const double parts[3] = {n.x, n.y, n.z};
    for (std::size_t c = 0; c < 3; ++c) {
      surface.normals[c * kTexels + k] = static_cast<float>(parts[c]);
      surface.albedo[c * kTexels + k] = uniform(random, 0.0, 0.9);
    }
  }
  return surface;
}

std::uint32_t random_mask(int lobes, int kept, Random& random) {
  std::uint32_t mask = 0;
  while (__builtin_popcount(mask) < kept) mask |= 1U << (random() % static_cast<unsigned>(lobes));
  return mask;
}

Texels random_texels(const RealisAsset& asset, Random& random) {
  Texels texels;
  texels.run_time.surface = random_surface(random);
  texels.run_time.baked = texels.run_time.surface;
  // Some are as they were, some have moved within the fade, some beyond it.
  for (std::size_t k = 0; k < 3 * kTexels; ++k) {
    if (k % 3 == 0) texels.run_time.surface.albedo[k] += uniform(random, 0.0, 0.3);
  }
  if (asset.colour == RealisColour::kScaledChroma) {
    for (std::size_t k = 0; k < 3 * kTexels; ++k)
      texels.run_time.chroma.push_back(uniform(random, -1.0, 2.0));
  }
  const int lobes = static_cast<int>(asset.lobes.size());
  const int channels = asset.colour == RealisColour::kRgb ? 3 : 1;
  bake::PackLayout layout{lobes, channels, asset.packing.bits, asset.packing.dominant, {}};
  for (const RealisRange& range : asset.packing.ranges) layout.zeros.push_back(range.zero);
  std::vector<std::uint32_t> masks(kTexels);
  for (std::uint32_t& mask : masks) mask = random_mask(lobes, asset.packing.dominant, random);
  std::vector<int> codes(asset.plane_count() * kTexels, 0);
  texels.run_time.amplitudes.assign(codes.size(), 0.0F);
  for (std::size_t plane = 0; plane < asset.plane_count(); ++plane) {
    const RealisRange& range = asset.packing.ranges[plane];
    for (std::size_t k = 0; k < kTexels; ++k) {
      if ((masks[k] >> (plane / static_cast<std::size_t>(channels)) & 1U) == 0) continue;
      const int stored =
          static_cast<int>(random() % static_cast<unsigned>(realis_top_code(asset.packing.bits) + 1));
      codes[plane * kTexels + k] = stored - range.zero;
      texels.run_time.amplitudes[plane * kTexels + k] =
          static_cast<float>(kernel::realis_amplitude<double>(stored, range.zero, range.step));
    }
  }
  const bake::PackedTexels packed = bake::pack(layout, codes, masks);
  for (const std::vector<std::uint8_t>& texture : packed.textures) {
    for (std::size_t k = 0; k < kTexels; ++k) {
      texels.codes.push_back(texture[4 * k] | texture[4 * k + 1] << 8U | texture[4 * k + 2] << 16U |
                             static_cast<std::uint32_t>(texture[4 * k + 3]) << 24U);
    }
  }
  if (asset.packing.dominant < lobes) texels.masks = masks;
  return texels;
}

void expect_parity(RealisPass& pass, const RealisAsset& asset, Random& random) {
  const Texels texels = random_texels(asset, random);
  double largest = 0.0;
  for (int k = 0; k < 4; ++k) {
    const Vec3 towards = direction(random, 0.05);
    const Rgb intensity = {uniform(random, 0.1, 4.0), uniform(random, 0.1, 4.0), uniform(random, 0.1, 4.0)};
    const bake::Relit relit = bake::relight(asset, texels.run_time, {towards, intensity});
    std::vector<float> found(3 * kTexels);
    pass.correction(asset, texels.view(), {towards, intensity}, found);
    for (std::size_t at = 0; at < found.size(); ++at) {
      const double expected = static_cast<double>(relit.corrected[at]) - relit.render[at];
      ASSERT_NEAR(found[at], expected, 4e-6 + 2e-5 * std::abs(expected)) << at;
      largest = std::max(largest, std::abs(expected));
    }
  }
  EXPECT_GT(largest, 0.05);  // there was something to compare
}

TEST(RealisPass, EqualsTheProcessorForEveryLayout) {
  Random random(11);
  RealisPass pass(tests::test_device());
  for (const RealisColour colour :
       {RealisColour::kLuminance, RealisColour::kScaledChroma, RealisColour::kRgb}) {
    for (const int bits : {4, 8}) {
      for (const auto& [lobes, dominant] : {std::pair{8, 8}, {8, 4}, {1, 1}, {12, 5}, {16, 16}}) {
        expect_parity(pass, random_asset(lobes, dominant, bits, colour, random), random);
      }
    }
  }
}

TEST(RealisPass, BatchesChangeNothing) {
  Random random(12);
  const RealisAsset asset = random_asset(8, 4, 8, RealisColour::kScaledChroma, random);
  const Texels texels = random_texels(asset, random);
  const RealisLight light = {direction(random, 0.3), {1.0, 2.0, 3.0}};
  std::vector<float> whole(3 * kTexels);
  std::vector<float> parts(3 * kTexels);
  RealisPass(tests::test_device()).correction(asset, texels.view(), light, whole);
  RealisPass(tests::test_device(), 137).correction(asset, texels.view(), light, parts);
  EXPECT_EQ(whole, parts);
}

TEST(RealisPass, OfNoLobesIsNothing) {
  RealisAsset asset;
  asset.packing.dominant = 0;
  Random random(13);
  const Texels texels = random_texels(random_asset(1, 1, 8, RealisColour::kLuminance, random), random);
  RealisTexels view = texels.view();
  view.codes = {};
  std::vector<float> found(3 * kTexels, 1.0F);
  RealisPass(tests::test_device()).correction(asset, view, {{0.0, 0.0, 1.0}}, found);
  EXPECT_EQ(found, std::vector<float>(3 * kTexels, 0.0F));
}

TEST(RealisPass, RefusesSizesThatDisagree) {
  Random random(14);
  const RealisAsset asset = random_asset(8, 4, 4, RealisColour::kLuminance, random);
  const Texels texels = random_texels(asset, random);
  RealisTexels view = texels.view();
  view.masks = {};
  std::vector<float> found(3 * kTexels);
  EXPECT_THROW(RealisPass(tests::test_device()).correction(asset, view, {{0.0, 0.0, 1.0}}, found),
               std::invalid_argument);
}

}  // namespace
}  // namespace brdfit
