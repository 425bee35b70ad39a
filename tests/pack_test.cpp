// Packing: every code comes back, whatever the layout.
#include "bake/pack.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <stdexcept>
#include <vector>

#include "brdf/realis.h"

namespace brdfit::bake {
namespace {

// A mask of `dominant` lobes at random.
std::uint32_t random_mask(int lobes, int dominant, std::mt19937& engine) {
  std::uint32_t mask = 0;
  while (__builtin_popcount(mask) < dominant) mask |= 1U << (engine() % static_cast<unsigned>(lobes));
  return mask;
}

TEST(Pack, CodesComeBack) {
  std::mt19937 engine(5);
  for (const int bits : {4, 8}) {
    for (const int channels : {1, 3}) {
      for (const int lobes : {1, 4, 7, 8, 12, 16}) {
        for (const int dominant : {1, lobes / 2, lobes}) {
          const int top = realis_top_code(bits);
          PackLayout layout{lobes, channels, bits, dominant, {}};
          for (int plane = 0; plane < lobes * channels; ++plane) {
            layout.zeros.push_back(static_cast<int>(engine() % static_cast<unsigned>(top + 1)));
          }
          const std::size_t texels = 19;
          std::vector<std::uint32_t> masks(texels);
          std::vector<int> codes(static_cast<std::size_t>(lobes * channels) * texels, 0);
          for (std::size_t texel = 0; texel < texels; ++texel) {
            masks[texel] = random_mask(lobes, dominant, engine);
            for (int plane = 0; plane < lobes * channels; ++plane) {
              if ((masks[texel] >> (plane / channels) & 1U) == 0) continue;
              codes[static_cast<std::size_t>(plane) * texels + texel] =
                  static_cast<int>(engine() % static_cast<unsigned>(top + 1)) -
                  layout.zeros[static_cast<std::size_t>(plane)];
            }
          }
          const PackedTexels packed = pack(layout, codes, masks);
          std::vector<std::uint32_t> found;
          EXPECT_EQ(unpack(layout, packed, texels, &found), codes) << lobes << ' ' << dominant << ' ' << bits;
          EXPECT_EQ(found, masks);
        }
      }
    }
  }
}

TEST(Pack, TakesTheBytesThatItSays) {
  const PackLayout small{8, 1, 4, 4, std::vector<int>(8, 7)};
  const PackedTexels packed = pack(small, std::vector<int>(8, 0), std::vector<std::uint32_t>{0x0F});
  EXPECT_EQ(packed.textures.size(), 1U);
  EXPECT_EQ(packed.mask.size(), 1U);
  EXPECT_EQ((PackLayout{8, 1, 8, 8, {}}.textures()), 2);
  EXPECT_EQ((PackLayout{8, 3, 8, 8, {}}.textures()), 6);
  EXPECT_EQ((PackLayout{16, 1, 8, 4, {}}.mask_channels()), 3);
}

TEST(Pack, RefusesWhatDoesNotFit) {
  const PackLayout layout{4, 1, 8, 2, {128, 0, 255, 128}};
  const std::vector<int> codes(4, 0);
  EXPECT_THROW(pack(layout, codes, std::vector<std::uint32_t>{0b111}), std::invalid_argument);
  EXPECT_THROW(pack(layout, std::vector<int>(3, 0), std::vector<std::uint32_t>{1}), std::invalid_argument);
  EXPECT_THROW(pack(layout, std::vector<int>{128, 0, 0, 0}, std::vector<std::uint32_t>{1}),
               std::invalid_argument);
  EXPECT_THROW(pack(layout, std::vector<int>{-129, 0, 0, 0}, std::vector<std::uint32_t>{1}),
               std::invalid_argument);
  EXPECT_THROW(pack({4, 2, 8, 2, std::vector<int>(8, 128)}, codes, std::vector<std::uint32_t>{1}),
               std::invalid_argument);
  EXPECT_THROW(pack({4, 1, 8, 2, {128}}, codes, std::vector<std::uint32_t>{1}), std::invalid_argument);
  EXPECT_THROW(pack({4, 1, 4, 2, {8, 8, 8, 16}}, codes, std::vector<std::uint32_t>{1}),
               std::invalid_argument);
  EXPECT_THROW(unpack(layout, {}, 1), std::invalid_argument);
}

TEST(Pack, DamagedBytesGiveCodesInRange) {
  // All bytes at their largest: more lobes in the mask than slots, every code at its largest.
  const PackLayout layout{8, 1, 4, 4, std::vector<int>(8, 8)};
  PackedTexels packed;
  packed.textures.assign(1, std::vector<std::uint8_t>(4, 0xFF));
  packed.mask.assign(1, 0xFF);
  const std::vector<int> codes = unpack(layout, packed, 1);
  for (int lobe = 0; lobe < 8; ++lobe) EXPECT_EQ(codes[static_cast<std::size_t>(lobe)], lobe < 4 ? 7 : 0);
}

}  // namespace
}  // namespace brdfit::bake
