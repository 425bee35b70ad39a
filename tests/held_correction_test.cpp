// What a renderer holds gives the correction that the asset means, in every way to store it.
#include "bake/held_correction.h"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <random>
#include <stdexcept>

namespace brdfit::bake {
namespace {

struct Held {
  RealisAsset asset;
  RunTimeTexels texels;
  std::vector<std::uint32_t> masks;
};

// Random amplitudes that the codes hold exactly, so that nothing is lost by storing them.
Held random_asset(int lobes, int dominant, AmplitudeBits bits, RealisColour colour, std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Held held;
  RealisAsset& asset = held.asset;
  asset.colour = colour;
  asset.albedo_in_modulation = lobes % 2 == 1;
  const int code_bits = bits == AmplitudeBits::k4 ? 4 : 8;
  asset.packing = {code_bits, dominant, {}};
  for (int k = 0; k < lobes; ++k) {
    const double z = 0.2 + 0.05 * k;
    asset.lobes.push_back(
        {{std::sqrt(1.0 - z * z) * std::cos(k), std::sqrt(1.0 - z * z) * std::sin(k), z}, 3.0 + k, -1.0});
  }
  for (std::size_t p = 0; p < asset.plane_count(); ++p)
    asset.packing.ranges.push_back({0.01, 1 << (code_bits - 1)});
  held.texels.surface.normals.assign(3 * count, 0.0F);
  held.texels.surface.albedo.assign(3 * count, 0.5F);
  held.texels.surface.state.assign(count, TexelState::kOk);
  held.texels.amplitudes.assign(asset.plane_count() * count, 0.0F);
  if (colour == RealisColour::kScaledChroma) {
    for (std::size_t k = 0; k < 3 * count; ++k)
      held.texels.chroma.push_back(static_cast<float>(1.0 + 0.5 * uniform(random)));
  }
  const auto channels = static_cast<std::size_t>(asset.channels());
  for (std::size_t k = 0; k < count; ++k) {
    const double x = 0.9 * uniform(random);
    held.texels.surface.normals[k] = static_cast<float>(x);
    held.texels.surface.normals[2 * count + k] = static_cast<float>(std::sqrt(1.0 - x * x));
    std::uint32_t mask = 0;
    for (int left = dominant; left > 0;) {
      const std::uint32_t bit = 1U << random() % static_cast<unsigned>(lobes);
      left -= (mask & bit) == 0 ? 1 : 0;
      mask |= bit;
    }
    held.masks.push_back(mask);
    for (std::size_t p = 0; p < asset.plane_count(); ++p) {
      if ((mask >> (p / channels) & 1U) == 0) continue;
      const double code = std::floor(uniform(random) * ((1 << (code_bits - 1)) - 1));
      held.texels.amplitudes[p * count + k] = bits == AmplitudeBits::kHalf
                                                  ? rounded_to_half(static_cast<float>(0.01 * code))
                                                  : static_cast<float>(0.01 * code);
    }
  }
  held.texels.baked = held.texels.surface;
  return held;
}

TEST(HeldCorrection, IsThatOfTheAssetHoweverAmplitudesAreStored) {
  const RealisLight light = {{0.48, 0.36, 0.8}, {1.0, 0.7, 1.3}};
  for (const AmplitudeBits bits :
       {AmplitudeBits::k4, AmplitudeBits::k8, AmplitudeBits::kHalf, AmplitudeBits::kFloat}) {
    for (const RealisColour colour :
         {RealisColour::kLuminance, RealisColour::kScaledChroma, RealisColour::kRgb}) {
      for (const auto& [lobes, dominant] : {std::pair(8, 8), {8, 3}, {5, 5}, {16, 1}}) {
        const Held held = random_asset(lobes, dominant, bits, colour, 300);
        const std::vector<double> expected = correction(held.asset, held.texels, light);
        std::vector<float> found(expected.size());
        held_correction(held.asset, held_texels(held.asset, bits, held.texels, held.masks), light, found);
        for (std::size_t k = 0; k < found.size(); ++k) {
          ASSERT_NEAR(found[k], expected[k], 3e-6) << static_cast<int>(bits) << " bits, " << name_of(colour)
                                                   << ", " << dominant << " of " << lobes;
        }
      }
    }
  }
}

TEST(HeldCorrection, TakesTheBytesThatAreCounted) {
  for (const auto& [bits, bytes] : {std::pair(AmplitudeBits::k4, 4U),
                                    {AmplitudeBits::k8, 8U},
                                    {AmplitudeBits::kHalf, 16U},
                                    {AmplitudeBits::kFloat, 32U}}) {
    const Held held = random_asset(8, 8, bits, RealisColour::kLuminance, 10);
    EXPECT_EQ(held_texels(held.asset, bits, held.texels, {}).bytes.size(), bytes * 10U);
  }
  const Held held = random_asset(8, 3, AmplitudeBits::k8, RealisColour::kLuminance, 10);
  EXPECT_EQ(held_texels(held.asset, AmplitudeBits::k8, held.texels, held.masks).bytes.size(), 30U);
  EXPECT_THROW(held_texels(held.asset, AmplitudeBits::k8, held.texels, {}), std::invalid_argument);
}

TEST(RoundedToHalf, IsTheNearestOfAllHalves) {
  // Every half that is not negative, from its bits.
  std::vector<float> halves;
  for (unsigned bits = 0; bits < 0x7C00U; ++bits) {
    const int exponent = static_cast<int>(bits >> 10U);
    const int digits = static_cast<int>(bits & 1023U);
    halves.push_back(exponent == 0 ? std::ldexp(static_cast<float>(digits), -24)
                                   : std::ldexp(static_cast<float>(1024 + digits), exponent - 25));
    EXPECT_EQ(half_bits(halves.back()), bits);
    EXPECT_EQ(half_bits(-halves.back()), bits | 0x8000U);
    EXPECT_EQ(rounded_to_half(-halves.back()), -halves.back());
  }
  std::mt19937 random(3);
  for (int k = 0; k < 20000; ++k) {
    const std::size_t at = random() % (halves.size() - 1);
    const double share = static_cast<double>(random() % 1000) / 1000.0;
    const auto value = static_cast<float>((1.0 - share) * static_cast<double>(halves[at]) +
                                          share * static_cast<double>(halves[at + 1]));
    const float found = rounded_to_half(value);
    const float best = std::min(value - halves[at], halves[at + 1] - value);
    EXPECT_EQ(std::abs(found - value), best) << value;
  }
  EXPECT_EQ(rounded_to_half(1e9F), 65504.0F);
}

}  // namespace
}  // namespace brdfit::bake
