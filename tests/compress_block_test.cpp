// Compression of blocks: texels without amplitudes stay so, and cutting a block in two changes nothing.
#include "bake/compress_block.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "bake/pack.h"
#include "tests/lobe_data.h"

namespace brdfit::bake {
namespace {

constexpr std::size_t kTexels = 48;
constexpr int kWidth = 8;

// Texels of which every third is not corrected.
struct Block {
  std::vector<Vec3> directions = bake_data::dome(40);
  TexelProblem problem = bake_data::lit_texels(directions, kTexels, 0.4, 3);
  LobeSet lobes = uniform_lobes(6, cap_of(directions));
  std::vector<float> amplitudes;
  std::vector<std::uint32_t> texels = std::vector<std::uint32_t>(kTexels);

  Block() {
    amplitudes = bake_data::add_lobes(problem, directions, lobes, 0.5, 11);
    for (std::size_t at = 0; at < amplitudes.size(); ++at) {
      if (at % kTexels % 3 == 0) amplitudes[at] = 0.0F;
    }
    std::iota(texels.begin(), texels.end(), 0U);
  }
  LobeSystem system() const { return LobeSystem(lobes, directions, mean_squared_modulation(problem), 1e-6); }
};

TEST(CompressBlock, TexelsWithoutAmplitudesStayExactlySoThroughThePackedBytes) {
  const Block block;
  const LobeSystem system = block.system();
  for (const int bits : {4, 8}) {
    for (const int dominant : {3, 6}) {
      const CompressOptions options{bits, dominant, true};
      const std::vector<RealisRange> ranges = code_ranges(system, block.problem, block.amplitudes, options);
      const Compressed out =
          compress_block(system, block.problem, block.amplitudes, block.texels, kWidth, ranges, options);
      PackLayout layout{6, 1, bits, dominant, {}};
      for (const RealisRange& range : ranges) layout.zeros.push_back(range.zero);
      const std::vector<int> codes = unpack(layout, pack(layout, out.codes, out.masks), kTexels);
      EXPECT_EQ(codes, out.codes);
      const Quantiser quantiser{bits, ranges};
      for (std::size_t at = 0; at < codes.size(); ++at) {
        EXPECT_EQ(static_cast<float>(quantiser.amplitude(at / kTexels, codes[at])), out.amplitudes[at]);
        if (at % kTexels % 3 == 0) {
          EXPECT_EQ(out.amplitudes[at], 0.0F);
        }
      }
    }
  }
}

TEST(CompressBlock, MoreBitsAreCloser) {
  const Block block;
  const LobeSystem system = block.system();
  double before = 1e300;
  for (const int bits : {3, 4, 6, 8, 12}) {
    const CompressOptions options{bits, 6, true};
    const Compressed out =
        compress_block(system, block.problem, block.amplitudes, block.texels, kWidth,
                       code_ranges(system, block.problem, block.amplitudes, options), options);
    const std::vector<float> sums = lobe_sums(block.lobes, block.directions, {}, out.amplitudes, kTexels);
    double error = 0.0;
    for (std::size_t at = 0; at < sums.size(); ++at) {
      if (at % kTexels % 3 == 0) continue;
      const double left = static_cast<double>(block.problem.residual[at]) -
                          static_cast<double>(block.problem.modulation[at]) * static_cast<double>(sums[at]);
      error += left * left;
    }
    EXPECT_LT(error, before) << bits;
    before = error;
  }
}

TEST(CompressBlock, IsTheSameHoweverTheBlockIsCut) {
  const Block block;
  const LobeSystem system = block.system();
  const CompressOptions options{4, 6, true};
  const std::vector<RealisRange> ranges = code_ranges(system, block.problem, block.amplitudes, options);
  const Compressed whole =
      compress_block(system, block.problem, block.amplitudes, block.texels, kWidth, ranges, options);
  std::vector<std::size_t> second(kTexels / 2);
  std::iota(second.begin(), second.end(), kTexels / 2);
  std::vector<float> amplitudes;
  for (std::size_t lobe = 0; lobe < 6; ++lobe) {
    for (const std::size_t k : second) amplitudes.push_back(block.amplitudes[lobe * kTexels + k]);
  }
  const Compressed half =
      compress_block(system, with_texels(block.problem, second), amplitudes,
                     std::span(block.texels).subspan(kTexels / 2), kWidth, ranges, options);
  for (std::size_t lobe = 0; lobe < 6; ++lobe) {
    for (std::size_t k = 0; k < second.size(); ++k) {
      EXPECT_EQ(half.codes[lobe * second.size() + k], whole.codes[lobe * kTexels + second[k]]);
    }
  }
}

}  // namespace
}  // namespace brdfit::bake
