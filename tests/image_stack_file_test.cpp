// Stacks read from files: the same values in strips, at once and by texel; nothing that cannot be used
// counts.
#include "io/image_stack_file.h"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "tests/stack_files.h"

namespace brdfit::io {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::input_error_of;
using tests::two_lights;
using tests::write_grey;
using tests::write_picture;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

float waves(int x, int y, int c) {
  return 0.45F + 0.4F * std::sin(0.7F * static_cast<float>(x) + 0.3F * static_cast<float>(y * (c + 1)));
}

class ImageStackFileTest : public testing::Test {
 protected:
  // A stack of five pictures with that ending, 37 x 41 pixels.
  StackSource waves_stack(const std::string& ending, SampleType type, int channels = 3) {
    Json manifest = {{"version", 1}, {"images", Json::array()}};
    for (int light = 0; light < 5; ++light) {
      const std::string name = "p" + std::to_string(light) + ending;
      write_picture(folder_ / name, 37, 41, channels, type,
                    [light](int x, int y, int c) { return waves(x + 3 * light, y, c); });
      manifest["images"].push_back({{"file", name}, {"direction", {0, 0, 1}}});
    }
    return source_of(manifest);
  }
  StackSource source_of(const Json& manifest) {
    write_json(folder_ / "olat.json", manifest);
    return read_stack_source(folder_ / "olat.json");
  }
  // Two pictures of floats, 2 x 1 pixels, each of one value in all channels.
  StackSource pairs(const std::vector<float>& a, const std::vector<float>& b, Json manifest = two_lights()) {
    for (const auto& [name, values] : {std::pair("a.exr", a), std::pair("b.exr", b)}) {
      write_picture(folder_ / name, 2, 1, 3, SampleType::kFloat,
                    [&values = values](int x, int, int) { return values[static_cast<std::size_t>(x)]; });
    }
    manifest["images"][0]["file"] = "b.exr";
    manifest["images"][1]["file"] = "a.exr";
    return source_of(manifest);
  }
  tests::TempFolder folder_;
};

TexelBlock whole(ImageStack& stack) {
  return stack.read_rows(0, stack.info().height);
}

TEST_F(ImageStackFileTest, StripsEqualTheWholeAndChosenTexelsToo) {
  for (const auto& [ending, type] :
       {std::pair(".jpg", SampleType::kUint8), std::pair(".png", SampleType::kUint16),
        std::pair(".exr", SampleType::kHalf), std::pair(".tif", SampleType::kFloat)}) {
    const StackSource source = waves_stack(ending, type);
    FileStack once(source);
    const TexelBlock all = whole(once);
    ASSERT_EQ(all.count(), 37U * 41U);
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t k = 5; k < all.count(); k += 23) chosen.push_back(k);
    for (const bool is_spilled : {false, true}) {
      FileStackOptions options;
      options.spill = is_spilled;
      FileStack stack(source, options);
      for (const int rows : {17, 1, 40}) {
        for (int first = 0; first < 41; first += rows) {
          const int count = std::min(rows, 41 - first);
          const TexelBlock strip = stack.read_rows(first, count);
          EXPECT_EQ(strip.texels.front(), static_cast<std::uint32_t>(first) * 37U);
          for (std::size_t light = 0; light < 5; ++light) {
            for (std::size_t c = 0; c < 3; ++c) {
              const auto expected =
                  all.plane(light, c).subspan(static_cast<std::size_t>(first) * 37, strip.count());
              EXPECT_TRUE(std::equal(expected.begin(), expected.end(), strip.plane(light, c).begin()))
                  << ending;
            }
          }
        }
      }
      const TexelBlock some = stack.read_texels(chosen);
      for (std::size_t light = 0; light < 5; ++light) {
        for (std::size_t k = 0; k < chosen.size(); ++k) {
          EXPECT_EQ(some.plane(light, 1)[k], all.plane(light, 1)[chosen[k]]) << ending;
        }
      }
    }
  }
}

TEST_F(ImageStackFileTest, LuminanceIsThatOfTheColours) {
  Json manifest = Json::parse(R"({"color_matrix": [[1.5, -0.4, -0.1], [-0.2, 1.4, -0.2], [0, -0.5, 1.5]]})");
  for (const SampleType type : {SampleType::kUint8, SampleType::kUint16}) {
    for (const bool has_matrix : {false, true}) {
      StackSource source = waves_stack(".png", type);
      if (has_matrix) source.color_matrix = manifest["color_matrix"].get<Matrix3>();
      FileStack stack(source);
      const TexelBlock fast = stack.read_luminance(0, 41);
      const TexelBlock slow = stack.ImageStack::read_luminance(0, 41);
      ASSERT_EQ(fast.channels, 1U);
      ASSERT_EQ(fast.rgb.size(), slow.rgb.size());
      for (std::size_t k = 0; k < fast.rgb.size(); ++k) EXPECT_NEAR(fast.rgb[k], slow.rgb[k], 1e-6F);
      EXPECT_EQ(fast.weight, slow.weight);
    }
  }
}

TEST_F(ImageStackFileTest, ThreadsDoNotChangeABit) {
  const StackSource source = waves_stack(".jpg", SampleType::kUint8);
  std::vector<std::vector<float>> results;
  for (const std::size_t threads : {std::size_t{1}, std::size_t{4}}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    FileStack stack(source);
    results.push_back(whole(stack).rgb);
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST_F(ImageStackFileTest, EncodingsDecodeToTheSameLightAtTheirDepth) {
  const auto error_of = [&](const std::string& ending, SampleType type, const Transfer& transfer) {
    FileStackOptions options;
    options.transfer = transfer;
    FileStack stack(waves_stack(ending, type), options);
    const TexelBlock block = whole(stack);
    EXPECT_EQ(stack.encoding().depth, type);
    EXPECT_EQ(stack.encoding().transfer_origin, "asked for");
    double worst = 0.0;
    for (std::size_t k = 0; k < block.count(); ++k) {
      const int x = static_cast<int>(k % 37), y = static_cast<int>(k / 37);
      const double light = to_linear(transfer, waves(x + 6, y, 1));
      worst = std::max(worst, std::abs(light - static_cast<double>(block.plane(2, 1)[k])));
    }
    return worst;
  };
  const Transfer srgb{Transfer::Kind::kSrgb};
  EXPECT_LT(error_of(".png", SampleType::kUint8, srgb), 2.3 * 0.5 / 255.0);
  EXPECT_LT(error_of(".png", SampleType::kUint16, srgb), 2.3 * 0.5 / 65535.0);
  EXPECT_LT(error_of(".tif", SampleType::kUint16, {Transfer::Kind::kGamma, 2.2}), 2.3 * 0.5 / 65535.0);
  EXPECT_LT(error_of(".exr", SampleType::kHalf, {}), 1.0 / 4096.0);
  EXPECT_LT(error_of(".exr", SampleType::kHalf, srgb), 2.3 / 4096.0);
  EXPECT_EQ(error_of(".exr", SampleType::kFloat, {}), 0.0);
  EXPECT_LT(error_of(".tif", SampleType::kFloat, srgb), 1e-7);
}

TEST_F(ImageStackFileTest, GreyPicturesHaveThreeEqualChannels) {
  for (const int channels : {1, 2}) {
    FileStack stack(waves_stack(".png", SampleType::kUint8, channels));
    const TexelBlock block = whole(stack);
    EXPECT_TRUE(std::equal(block.plane(0, 0).begin(), block.plane(0, 0).end(), block.plane(0, 2).begin()));
    FileStack again(waves_stack(".png", SampleType::kUint16, channels));
    const TexelBlock deep = whole(again);
    EXPECT_TRUE(std::equal(deep.plane(0, 0).begin(), deep.plane(0, 0).end(), deep.plane(0, 1).begin()));
  }
}

TEST_F(ImageStackFileTest, TheTransferIsTheCallersThenTheManifestsThenTheFilesThenTheUsual) {
  write_grey(folder_ / "a.png");
  write_grey(folder_ / "b.png");
  Json manifest = two_lights();
  EXPECT_EQ(FileStack(source_of(manifest)).encoding().transfer_origin, "the usual for 8 bit");
  EXPECT_EQ(FileStack(source_of(manifest)).encoding().transfer, Transfer{Transfer::Kind::kSrgb});
  manifest["transfer"] = "rec709";
  EXPECT_EQ(FileStack(source_of(manifest)).encoding().transfer_origin, "the manifest");
  FileStackOptions options;
  options.transfer = Transfer{};
  EXPECT_EQ(FileStack(source_of(manifest), options).encoding().transfer, Transfer{});
  EXPECT_EQ(FileStack(waves_stack(".exr", SampleType::kHalf)).encoding().transfer_origin, "the pictures");
}

TEST_F(ImageStackFileTest, SaturatedValuesHaveNoWeightAndAreCounted) {
  for (const SampleType type : {SampleType::kUint8, SampleType::kUint16}) {
    for (const char* name : {"a.png", "b.png"}) {
      write_picture(folder_ / name, 4, 3, 4, type, [&](int x, int y, int c) {
        // The fourth channel is alpha, and may be full.
        return c == 3 || (name[0] == 'b' && x == 2 && y == 1 && c == 1) ? 1.0F : 0.5F;
      });
    }
    FileStack stack(source_of(two_lights()));
    const TexelBlock block = whole(stack);
    ASSERT_FALSE(block.weight.empty());
    EXPECT_EQ(block.weight_of(1, 6), 0.0F);
    EXPECT_EQ(std::accumulate(block.weight.begin(), block.weight.end(), 0.0F), 23.0F);
    EXPECT_EQ(stack.counts().saturated, 1U);
    EXPECT_EQ(stack.counts().pixels, 24U);
    whole(stack);
    EXPECT_EQ(stack.counts().saturated, 1U) << "a row counts once";
  }
}

TEST_F(ImageStackFileTest, ValuesThatAreNotFiniteBecomeZeroWithoutWeight) {
  FileStack stack(pairs({0.5F, kNan}, {kInfinity, 3.0F}));
  const TexelBlock block = whole(stack);
  EXPECT_THAT(block.weight, testing::ElementsAre(1.0F, 0.0F, 0.0F, 1.0F));
  EXPECT_EQ(block.plane(0, 0)[1], 0.0F);
  EXPECT_EQ(block.plane(1, 2)[0], 0.0F);
  EXPECT_EQ(block.plane(1, 0)[1], 3.0F) << "values far above 1 are values";
  EXPECT_EQ(stack.counts().non_finite, 2U);
  EXPECT_EQ(stack.counts().saturated, 0U);
}

TEST_F(ImageStackFileTest, DarkFlatExposureAndMatrixApplyInThisOrder) {
  Json manifest = two_lights();
  manifest["images"][0]["exposure_seconds"] = 0.5;
  manifest["images"][1]["exposure_seconds"] = 0.25;
  manifest["dark"] = "dark.exr";
  manifest["flat"] = "flat.exr";
  manifest["color_matrix"] = {{2, 0, 0}, {0, 1, 0}, {1, 0, 1}};
  write_picture(folder_ / "dark.exr", 2, 1, 3, SampleType::kFloat, [](int, int, int) { return 0.1F; });
  write_picture(folder_ / "flat.exr", 2, 1, 3, SampleType::kFloat,
                [](int x, int, int) { return x == 0 ? 0.3F : 0.7F; });
  FileStack stack(pairs({0.5F, 0.7F}, {0.1F, 0.05F}, manifest));
  const TexelBlock block = whole(stack);
  // The flat less the dark is 0.2 and 0.6, its mean 0.4: gains of 2 and 2/3.
  EXPECT_NEAR(block.plane(0, 1)[0], 0.4 * 2.0 / 0.25, 1e-5);
  EXPECT_NEAR(block.plane(0, 1)[1], 0.6 * 2.0 / 3.0 / 0.25, 1e-5);
  EXPECT_NEAR(block.plane(0, 0)[0], 2.0 * 3.2, 1e-5);
  EXPECT_NEAR(block.plane(0, 2)[0], 2.0 * 3.2, 1e-5);
  EXPECT_NEAR(block.plane(1, 1)[0], 0.0, 1e-6);
  EXPECT_NEAR(block.plane(1, 1)[1], -0.05 * 2.0 / 3.0 / 0.5, 1e-5) << "below the dark frame stays below 0";
  EXPECT_THAT(block.weight, IsEmpty());
  const std::vector<std::uint32_t> second = {1};
  EXPECT_EQ(stack.read_texels(second).plane(0, 2)[0], block.plane(0, 2)[1]);
}

TEST_F(ImageStackFileTest, FramesOf8BitPicturesAreTakenOffInLight) {
  for (const char* name : {"a.png", "b.png"}) write_grey(folder_ / name, 4, 3, 0.6F);
  write_grey(folder_ / "dark.png", 4, 3, 0.2F);
  Json manifest = two_lights();
  manifest["dark"] = "dark.png";
  FileStack stack(source_of(manifest));
  const Transfer srgb{Transfer::Kind::kSrgb};
  const double expected = to_linear(srgb, 153.0 / 255.0) - to_linear(srgb, 51.0 / 255.0);
  const TexelBlock block = whole(stack);
  for (const float value : block.rgb) EXPECT_NEAR(value, expected, 1e-6);
}

TEST_F(ImageStackFileTest, MaskAndBlackFlatTakeTexelsOutOfAllPictures) {
  Json manifest = two_lights();
  manifest["mask"] = "mask.png";
  write_picture(folder_ / "mask.png", 2, 1, 1, SampleType::kUint8,
                [](int x, int, int) { return x == 0 ? 1.0F : 0.0F; });
  FileStack masked(pairs({0.5F, 0.5F}, {0.5F, 0.5F}, manifest));
  EXPECT_THAT(whole(masked).weight, testing::ElementsAre(1.0F, 0.0F, 1.0F, 0.0F));
  EXPECT_EQ(masked.counts().masked_texels, 1U);
  manifest.erase("mask");
  manifest["flat"] = "flat.exr";
  write_picture(folder_ / "flat.exr", 2, 1, 3, SampleType::kFloat,
                [](int x, int, int) { return x == 0 ? 0.0F : 1.0F; });
  FileStack flat(pairs({0.5F, 0.5F}, {0.5F, 0.5F}, manifest));
  EXPECT_THAT(whole(flat).weight, testing::ElementsAre(0.0F, 1.0F, 0.0F, 1.0F));
  EXPECT_EQ(flat.counts().bad_texels, 1U);
}

TEST_F(ImageStackFileTest, WeightMapsMultiplyHoweverTheStackIsRead) {
  for (const auto& [name, type] :
       {std::pair("w.png", SampleType::kUint8), std::pair("w16.png", SampleType::kUint16),
        std::pair("w.exr", SampleType::kHalf)}) {
    StackSource source = waves_stack(".png", SampleType::kUint8);
    const auto level = [](int x, int y) { return static_cast<float>((x + 7 * y) % 6) / 5.0F; };
    write_picture(folder_ / name, 37, 41, 1, type, [&](int x, int y, int) { return level(x, y); });
    source.pictures[3].weight = folder_ / name;
    for (const bool is_spilled : {false, true}) {
      FileStackOptions options;
      options.spill = is_spilled;
      FileStack stack(source, options);
      const TexelBlock luminance = stack.read_luminance(7, 9);
      const TexelBlock some = stack.read_texels(std::vector<std::uint32_t>{0, 5, 38, 1500});
      const TexelBlock all = whole(stack);
      for (std::size_t k = 0; k < all.count(); ++k) {
        EXPECT_EQ(all.weight_of(2, k), 1.0F);
        EXPECT_NEAR(all.weight_of(3, k), level(static_cast<int>(k % 37), static_cast<int>(k / 37)), 2e-4F);
      }
      for (std::size_t k = 0; k < some.count(); ++k) {
        EXPECT_EQ(some.weight_of(3, k), all.weight_of(3, some.texels[k])) << name;
      }
      for (std::size_t k = 0; k < luminance.count(); ++k) {
        EXPECT_EQ(luminance.weight_of(3, k), all.weight_of(3, luminance.texels[k])) << name;
      }
    }
  }
}

TEST_F(ImageStackFileTest, AWeightMapKeepsWhatCannotBeUsedAtZero) {
  Json manifest = two_lights();
  manifest["images"][1]["weight"] = "w.exr";
  write_picture(folder_ / "w.exr", 2, 1, 1, SampleType::kFloat, [](int, int, int) { return 0.25F; });
  FileStack stack(pairs({0.5F, kNan}, {kInfinity, 3.0F}, manifest));
  EXPECT_THAT(whole(stack).weight, testing::ElementsAre(0.25F, 0.0F, 0.0F, 1.0F));
}

TEST_F(ImageStackFileTest, WhatIsNoWeightIsNamed) {
  Json manifest = two_lights();
  manifest["images"][1]["weight"] = "w.exr";
  const auto error_of = [&](int width, float value) {
    write_picture(folder_ / "w.exr", width, 1, 1, SampleType::kFloat,
                  [value](int x, int, int) { return x == 1 ? value : 0.5F; });
    return input_error_of([&] {
      FileStack stack(pairs({0.5F, 0.5F}, {0.5F, 0.5F}, manifest));
      whole(stack);
    });
  };
  EXPECT_EQ(error_of(2, 1.0F), "no error");
  EXPECT_THAT(error_of(2, 1.5F), HasSubstr("w.exr: pixel (1, 0) holds 1.5 (expected values from 0 to 1)"));
  EXPECT_THAT(error_of(2, -0.1F), HasSubstr("holds -0.1"));
  EXPECT_THAT(error_of(2, kNan), HasSubstr("is not finite"));
  EXPECT_THAT(error_of(3, 0.5F), HasSubstr("is 3 x 1 pixels (expected 2 x 1 as a.exr)"));
}

TEST_F(ImageStackFileTest, NormalsAreUnitHoweverTheyAreStored) {
  const std::vector<std::array<float, 3>> normals = {{0.6F, 0.0F, 0.8F}, {0.0F, 0.0F, 0.0F}};
  for (const auto& [name, type] :
       {std::pair("n.exr", SampleType::kFloat), std::pair("n8.png", SampleType::kUint8),
        std::pair("n16.png", SampleType::kUint16)}) {
    const bool is_float = type == SampleType::kFloat;
    write_picture(folder_ / name, 2, 1, 3, type, [&](int x, int, int c) {
      const float n = normals[static_cast<std::size_t>(x)][static_cast<std::size_t>(c)];
      return is_float ? 2.0F * n : 0.5F * n + 0.5F;
    });
    Json manifest = two_lights();
    manifest["normals"] = name;
    FileStack stack(pairs({0.5F, 0.5F}, {0.5F, 0.5F}, manifest));
    EXPECT_TRUE(stack.info().has_normals);
    const TexelBlock block = whole(stack);
    ASSERT_EQ(block.normals.size(), 6U);
    const float tolerance = type == SampleType::kUint8 ? 5e-3F : 2e-5F;
    EXPECT_NEAR(block.normals[0], 0.6F, tolerance) << name;
    EXPECT_NEAR(block.normals[4], 0.8F, tolerance) << name;
    EXPECT_EQ(block.normals[5], 1.0F) << "no normal: a stand-in";
    EXPECT_EQ(block.weight_of(0, 1), 0.0F);
    EXPECT_EQ(stack.counts().bad_texels, 1U);
  }
}

TEST_F(ImageStackFileTest, AlbedoIsTakenByItsOwnEncoding) {
  Json manifest = two_lights();
  manifest["albedo"] = "albedo.png";
  manifest["transfer"] = "linear";
  write_grey(folder_ / "albedo.png", 2, 1, 0.6F);
  FileStack stack(pairs({0.5F, 0.5F}, {0.5F, 0.5F}, manifest));
  EXPECT_TRUE(stack.info().has_albedo);
  const std::vector<float> albedo = whole(stack).albedo;
  for (const float value : albedo) EXPECT_NEAR(value, to_linear({Transfer::Kind::kSrgb}, 0.6), 1e-6);
}

TEST_F(ImageStackFileTest, NearLightsKeepTheirPlace) {
  Json manifest = two_lights();
  manifest["images"][1].erase("direction");
  manifest["images"][1]["position"] = {0.5, 1.0, 3.0};
  manifest["pixel_size"] = 1.0;
  manifest["origin"] = {0.0, 1.0, 0.0};
  manifest["units"] = "mm";
  FileStack stack(pairs({0.5F, 0.5F}, {0.5F, 0.5F}, manifest));
  ASSERT_TRUE(has_near_lights(stack.info()));
  EXPECT_NEAR(stack.info().lights[0].direction.z, 1.0, 1e-15) << "seen from between the two pixels";
  const Incidence left = incidence(stack.info(), 0, 0);
  EXPECT_NEAR(left.direction.x, 0.5 / std::hypot(0.5, 3.0), 1e-15);
  EXPECT_NEAR(left.falloff, 9.0 / 9.25, 1e-15);
}

TEST_F(ImageStackFileTest, MemoryBoundsTheHeightOfStrips) {
  const StackSource source = waves_stack(".jpg", SampleType::kUint8);
  int last = 0;
  for (const std::size_t bytes :
       {std::size_t{1}, std::size_t{40000}, std::size_t{80000}, std::size_t{1} << 30}) {
    FileStackOptions options;
    options.memory_bytes = bytes;
    FileStack stack(source, options);
    const int rows = stack.strip_rows();
    EXPECT_GE(rows, std::max(1, last));
    const TexelBlock strip = stack.read_rows(0, rows);
    const std::size_t used = (strip.rgb.size() + strip.lights * strip.count()) * sizeof(float);
    if (rows > 1) {
      EXPECT_LE(used, bytes);
    }
    last = rows;
  }
  EXPECT_EQ(last, 41);
}

TEST_F(ImageStackFileTest, BlocksGivenBackLeaveNoTrace) {
  const StackSource source = waves_stack(".png", SampleType::kUint8);
  FileStack plain(source);
  FileStack stack(source);
  TexelBlock old = stack.read_rows(0, 20);
  old.weight.assign(old.lights * old.count(), 0.0F);
  old.normals.assign(3 * old.count(), 7.0F);
  std::fill(old.rgb.begin(), old.rgb.end(), 7.0F);
  stack.give_back(std::move(old));
  const TexelBlock fresh = plain.read_rows(20, 21);
  const TexelBlock reused = stack.read_rows(20, 21);
  EXPECT_EQ(reused.rgb, fresh.rgb);
  EXPECT_EQ(reused.texels, fresh.texels);
  EXPECT_THAT(reused.weight, IsEmpty());
  EXPECT_THAT(reused.normals, IsEmpty());
}

TEST_F(ImageStackFileTest, RowsKeptAsideMayBeReadInAnyOrder) {
  // A row at a time from the top and back, which decodes anew for every step back unless it is kept.
  const StackSource source = waves_stack(".jpg", SampleType::kUint8);
  FileStackOptions options;
  options.spill = true;
  options.spill_folder = folder_.path();
  FileStack stack(source, options);
  FileStack plain(source);
  const TexelBlock all = whole(plain);
  for (const int row : {40, 3, 40, 0}) {
    const TexelBlock strip = stack.read_rows(row, 1);
    EXPECT_EQ(strip.plane(4, 2)[7], all.plane(4, 2)[static_cast<std::size_t>(row) * 37 + 7]);
  }
  options.spill_folder = folder_ / "none";
  EXPECT_THROW(FileStack(source, options), IoError);
}

TEST_F(ImageStackFileTest, FilesThatDoNotFitAreNamed) {
  write_grey(folder_ / "a.png", 4, 3);
  write_grey(folder_ / "b.png", 5, 3);
  const std::string error = input_error_of([&] { FileStack stack(source_of(two_lights())); });
  EXPECT_THAT(error, HasSubstr("b.png: is 5 x 3 pixels (expected 4 x 3 as a.png)"));
  write_grey(folder_ / "b.png", 4, 3);
  Json manifest = two_lights();
  for (const char* key : {"dark", "flat", "mask", "normals", "albedo"}) {
    write_grey(folder_ / "frame.png", 4, 4);
    manifest = two_lights();
    manifest[key] = "frame.png";
    EXPECT_THAT(input_error_of([&] { FileStack stack(source_of(manifest)); }),
                HasSubstr("frame.png: is 4 x 4"));
  }
  write_grey(folder_ / "black.png", 4, 3, 0.0F);
  manifest = two_lights();
  manifest["flat"] = "black.png";
  EXPECT_THAT(input_error_of([&] { FileStack stack(source_of(manifest)); }),
              HasSubstr("flat frame is black"));
  tests::write_text(folder_ / "b.png", "no picture");
  EXPECT_THAT(input_error_of([&] { FileStack stack(source_of(two_lights())); }),
              HasSubstr("b.png: cannot be read"));
}

TEST_F(ImageStackFileTest, ChoicesThatDoNotFitAreRefused) {
  FileStack stack(pairs({0.5F, 0.5F}, {0.5F, 0.5F}));
  EXPECT_THROW(stack.read_rows(0, 2), std::invalid_argument);
  EXPECT_THROW(stack.read_rows(-1, 1), std::invalid_argument);
  EXPECT_THROW(stack.read_texels(std::vector<std::uint32_t>{2}), std::invalid_argument);
  EXPECT_THROW(stack.read_texels(std::vector<std::uint32_t>{1, 0}), std::invalid_argument);
  EXPECT_EQ(stack.read_rows(1, 0).count(), 0U);
  EXPECT_EQ(stack.read_texels({}).count(), 0U);
}

}  // namespace
}  // namespace brdfit::io
