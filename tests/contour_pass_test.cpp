// Contours of whole stacks: those of pictures as a whole, whatever is in memory at once.
#include "cli/contour_pass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "tests/stack_files.h"

namespace brdfit::cli {
namespace {

constexpr int kWidth = 18;
constexpr int kHeight = 150;  // more rows than are looked at together
constexpr std::size_t kTexels = static_cast<std::size_t>(kWidth) * kHeight;
constexpr std::size_t kLights = 3;
const Vec3 kDirection = {0.6, 0.0, 0.8};

float texture(int x, int y) {
  return 0.5F + 0.02F * std::sin(1.3F * static_cast<float>(x) + 2.1F * static_cast<float>(y * y % 17));
}

// Whether a texel is lit in the photographs, and in a render whose shadow falls elsewhere.
bool is_lit_in_photograph(int x, int y) {
  return x < 9 + (y / 10) % 4;
}
bool is_lit_in_render(int x, int y) {
  return x < 9 + (y / 37) % 3;
}

class ContourPassTest : public testing::Test {
 protected:
  // A flat surface; the second light alone has no shadow.
  static MemoryStack stack() {
    StackInfo info;
    info.width = kWidth;
    info.height = kHeight;
    info.has_normals = true;
    info.has_albedo = true;
    info.lights.resize(kLights);
    for (StackLight& light : info.lights) light.direction = kDirection;
    TexelBlock block;
    block.lights = kLights;
    block.texels.resize(kTexels);
    std::iota(block.texels.begin(), block.texels.end(), 0U);
    block.normals.assign(3 * kTexels, 0.0F);
    std::fill(block.normals.begin() + 2 * kTexels, block.normals.end(), 1.0F);
    block.albedo.resize(3 * kTexels);
    for (std::size_t k = 0; k < block.albedo.size(); ++k) block.albedo[k] = albedo(k % kTexels);
    block.rgb.resize(kLights * 3 * kTexels);
    for (std::size_t k = 0; k < block.rgb.size(); ++k) {
      const bool is_lit =
          k / (3 * kTexels) == 1 || is_lit_in_photograph(x_of(k % kTexels), y_of(k % kTexels));
      block.rgb[k] = (is_lit ? 0.8F : 0.04F) * albedo(k % kTexels);
    }
    return MemoryStack(std::move(info), std::move(block));
  }
  static int x_of(std::size_t texel) { return static_cast<int>(texel) % kWidth; }
  static int y_of(std::size_t texel) { return static_cast<int>(texel) / kWidth; }
  static float albedo(std::size_t texel) { return texture(x_of(texel), y_of(texel)); }

  io::PictureMaps shadows(bool is_any = true) const {
    std::vector<std::optional<std::filesystem::path>> files(kLights);
    if (is_any) {
      tests::write_picture(folder_ / "shadow.png", kWidth, kHeight, 1, io::SampleType::kUint8,
                           [](int x, int y, int) { return is_lit_in_render(x, y) ? 1.0F : 0.0F; });
      files[0] = files[1] = folder_ / "shadow.png";
    }
    return io::PictureMaps(files, {kWidth, kHeight, "the pictures"});
  }

  static std::vector<float> weights_of(const ContourPass& pass, MemoryStack& stack) {
    TexelBlock block = stack.read_rows(0, kHeight);
    pass.weigh(block);
    return block.weight;
  }

  // Of the first light, from the whole picture.
  static std::vector<float> expected() {
    std::vector<float> seen(kTexels), shown(kTexels), unshadowed(kTexels), facing(kTexels, 0.8F);
    for (std::size_t k = 0; k < kTexels; ++k) {
      unshadowed[k] = 0.8F * albedo(k);
      seen[k] = (is_lit_in_photograph(x_of(k), y_of(k)) ? 0.8F : 0.04F) * albedo(k);
      shown[k] = is_lit_in_render(x_of(k), y_of(k)) ? unshadowed[k] : 0.0F;
    }
    return bake::contour_weights(bake::find_contours({seen, unshadowed, facing}, kWidth, kHeight),
                                 bake::find_contours({shown, unshadowed, facing}, kWidth, kHeight), kWidth,
                                 kHeight);
  }

  tests::TempFolder folder_;
};

TEST_F(ContourPassTest, WeightsAreThoseOfWholePictures) {
  MemoryStack photographs = stack();
  const ContourPass pass(photographs, shadows(), {});
  const std::vector<float> weights = weights_of(pass, photographs);
  const std::vector<float> whole = expected();
  std::size_t lowered = 0;
  for (std::size_t k = 0; k < kTexels; ++k) {
    EXPECT_NEAR(weights[k], whole[k], 0.5 / 255.0 + 1e-6) << k;
    EXPECT_EQ(weights[kTexels + k], 1.0F) << "the photograph has no shadow";
    EXPECT_EQ(weights[2 * kTexels + k], 1.0F) << "the render has none";
    lowered += weights[k] < 1.0F ? 1 : 0;
  }
  EXPECT_GT(lowered, 100U);
  EXPECT_EQ(pass.lowered(), lowered);
}

TEST_F(ContourPassTest, StripsAndMemoryChangeNoWeight) {
  MemoryStack photographs = stack();
  const std::vector<float> expected_weights =
      weights_of(ContourPass(photographs, shadows(), {}), photographs);
  for (const int rows : {1, 7, 150}) {
    ContourPassOptions options;
    options.strip_rows = rows;
    options.memory_bytes = 1;
    const ContourPass pass(photographs, shadows(), options);
    EXPECT_EQ(weights_of(pass, photographs), expected_weights) << rows;
    TexelBlock sample = photographs.read_texels(std::vector<std::uint32_t>{0, 9, 10, 1000, 2699});
    pass.weigh(sample);
    for (std::size_t light = 0; light < kLights; ++light) {
      for (std::size_t k = 0; k < sample.count(); ++k) {
        EXPECT_EQ(sample.weight_of(light, k), expected_weights[light * kTexels + sample.texels[k]]);
      }
    }
  }
}

TEST_F(ContourPassTest, LeavesABlockAloneWhereNothingDiffers) {
  MemoryStack photographs = stack();
  const ContourPass pass(photographs, shadows(false), {});
  EXPECT_EQ(pass.lowered(), 0U);
  EXPECT_TRUE(weights_of(pass, photographs).empty());
}

}  // namespace
}  // namespace brdfit::cli
