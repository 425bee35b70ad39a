// Images keep every bit that a file holds, whichever way their rows are read.
#include "io/image_reader.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "io/image_layout.h"
#include "tests/temp_folder.h"

namespace brdfit::io {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using tests::TempFolder;

template <class Sample>
ImagePixels pixels_of(int width, int height, int channels, SampleType type,
                      const std::vector<Sample>& samples) {
  return {width, height, channels, type, std::as_bytes(std::span(samples))};
}

template <class Sample>
std::vector<Sample> native(ImageReader& reader, int first, int rows) {
  std::vector<Sample> out(static_cast<std::size_t>(rows) * reader.header().row_samples());
  reader.read_native(first, rows, std::as_writable_bytes(std::span(out)));
  return out;
}

// All 65536 codes, scattered over three channels.
std::vector<std::uint16_t> all_codes() {
  std::vector<std::uint16_t> codes(std::size_t{128} * 512 * 3);
  for (std::size_t k = 0; k < codes.size(); ++k) codes[k] = static_cast<std::uint16_t>(k * 40503U);
  return codes;
}

TEST(ImageReader, EveryCodeOf16BitsComesBack) {
  const TempFolder folder;
  const auto codes = all_codes();
  for (const char* name : {"a.png", "a.tif"}) {
    write_image(folder / name, pixels_of(128, 512, 3, SampleType::kUint16, codes),
                {.type = SampleType::kUint16});
    ImageReader reader(folder / name);
    EXPECT_EQ(reader.header().type, SampleType::kUint16);
    EXPECT_EQ(reader.header().width, 128);
    EXPECT_EQ(reader.header().height, 512);
    EXPECT_EQ(native<std::uint16_t>(reader, 0, 512), codes) << name;
    std::vector<float> floats(codes.size());
    reader.read_floats(0, 512, floats);
    for (std::size_t k = 0; k < codes.size(); k += 7) {
      EXPECT_NEAR(floats[k], codes[k] / 65535.0F, 1e-7F) << name << codes[k];
    }
  }
}

TEST(ImageReader, HalvesAndFloatsComeBackBitForBit) {
  const TempFolder folder;
  std::vector<float> floats;
  for (int k = 0; k < 64 * 32 * 3; ++k) {
    floats.push_back(std::exp2(static_cast<float>(k % 200) - 100.0F) *
                     (1.0F + static_cast<float>(k) / 65536.0F));
  }
  floats[5] = std::numeric_limits<float>::infinity();
  write_image(folder / "a.exr", pixels_of(64, 32, 3, SampleType::kFloat, floats),
              {.type = SampleType::kFloat});
  ImageReader reader(folder / "a.exr");
  EXPECT_EQ(reader.header().type, SampleType::kFloat);
  EXPECT_EQ(native<float>(reader, 0, 32), floats);

  // Every half that is finite and has a value above 8 bits' steps: codes 0x0001 to 0x7bff.
  std::vector<std::uint16_t> halves(std::size_t{64} * 32 * 3);
  for (std::size_t k = 0; k < halves.size(); ++k) halves[k] = static_cast<std::uint16_t>(1 + k * 5 % 0x7bff);
  write_image(folder / "h.exr", pixels_of(64, 32, 3, SampleType::kHalf, halves), {.type = SampleType::kHalf});
  ImageReader half_reader(folder / "h.exr");
  EXPECT_EQ(half_reader.header().type, SampleType::kHalf);
  EXPECT_EQ(native<std::uint16_t>(half_reader, 0, 32), halves);
}

std::vector<std::uint8_t> picture8(int width, int height, int channels) {
  std::vector<std::uint8_t> samples;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width * channels; ++x) {
      samples.push_back(static_cast<std::uint8_t>(128.0 + 100.0 * std::sin(0.13 * x) * std::cos(0.31 * y)));
    }
  }
  return samples;
}

TEST(ImageReader, StripsOfAnyHeightHoldWhatTheWholePictureHolds) {
  const TempFolder folder;
  const auto samples = picture8(70, 45, 3);
  for (const char* name : {"a.jpg", "a.png", "a.tif", "a.exr"}) {
    const SampleType type = std::string(name) == "a.exr" ? SampleType::kHalf : SampleType::kUint8;
    write_image(folder / name, pixels_of(70, 45, 3, SampleType::kUint8, samples), {.type = type});
    ImageReader whole_reader(folder / name);
    std::vector<float> whole(whole_reader.header().row_samples() * 45);
    whole_reader.read_floats(0, 45, whole);
    for (const int rows : {1, 7, 16, 44}) {
      ImageReader reader(folder / name);
      std::vector<float> strips;
      for (int first = 0; first < 45; first += rows) {
        const int count = std::min(rows, 45 - first);
        std::vector<float> strip(reader.header().row_samples() * static_cast<std::size_t>(count));
        reader.read_floats(first, count, strip);
        strips.insert(strips.end(), strip.begin(), strip.end());
      }
      EXPECT_EQ(strips, whole) << name << " in strips of " << rows;
    }
  }
}

TEST(ImageReader, RowsMayBeReadInAnyOrderAndAgain) {
  const TempFolder folder;
  const auto samples = picture8(33, 40, 3);
  for (const char* name : {"a.jpg", "a.png", "a.tif"}) {
    write_image(folder / name, pixels_of(33, 40, 3, SampleType::kUint8, samples),
                {.type = SampleType::kUint8});
    ImageReader reader(folder / name);
    const auto whole = native<std::uint8_t>(reader, 0, 40);
    for (const int first : {30, 3, 3, 39, 0}) {
      const auto begin = whole.begin() + first * 33 * 3;
      EXPECT_EQ(native<std::uint8_t>(reader, first, 1), std::vector<std::uint8_t>(begin, begin + 33 * 3))
          << name;
    }
  }
}

TEST(ImageReader, TiledFilesAreReadByRowsToo) {
  const TempFolder folder;
  const auto samples = picture8(70, 45, 3);
  const std::string file = (folder / "tiled.tif").string();
  auto output = OIIO::ImageOutput::create(file);
  OIIO::ImageSpec spec(70, 45, 3, OIIO::TypeDesc::UINT8);
  spec.tile_width = 16;
  spec.tile_height = 16;
  ASSERT_TRUE(output->open(file, spec) && output->write_image(OIIO::TypeDesc::UINT8, samples.data()) &&
              output->close());
  ImageReader reader(file);
  EXPECT_FALSE(reader.header().is_scanline);
  EXPECT_EQ(native<std::uint8_t>(reader, 0, 45), samples);
  const auto begin = samples.begin() + 14 * 70 * 3;
  EXPECT_EQ(native<std::uint8_t>(reader, 14, 20), std::vector<std::uint8_t>(begin, begin + 20 * 70 * 3));
}

TEST(ImageReader, ColoursAreNotMultipliedWithAlpha) {
  const TempFolder folder;
  const std::vector<std::uint8_t> samples = {200, 100, 50, 0, 10, 20, 30, 128};
  write_image(folder / "a.png", pixels_of(2, 1, 4, SampleType::kUint8, samples),
              {.type = SampleType::kUint8});
  ImageReader reader(folder / "a.png");
  const auto read = native<std::uint8_t>(reader, 0, 1);
  EXPECT_EQ(read[4], 10);
  EXPECT_EQ(read[6], 30);
}

TEST(ImageReader, JpegQualityIsAsAsked) {
  const TempFolder folder;
  const auto samples = picture8(128, 128, 3);
  for (const int quality : {30, 98}) {
    write_image(folder / ("q" + std::to_string(quality) + ".jpg"),
                pixels_of(128, 128, 3, SampleType::kUint8, samples),
                {.type = SampleType::kUint8, .jpeg_quality = quality});
  }
  EXPECT_LT(3 * std::filesystem::file_size(folder / "q30.jpg"),
            2 * std::filesystem::file_size(folder / "q98.jpg"));
}

TEST(ImageReader, JpegKeepsTheColourOfEachPixelWhereAsked) {
  const TempFolder folder;
  // Columns of red and blue, which half as many colours cannot tell apart.
  std::vector<std::uint8_t> samples(3 * 64 * 64, 0);
  for (std::size_t k = 0; k < 64 * 64; ++k) samples[3 * k + (k % 2 == 0 ? 0 : 2)] = 200;
  const auto red_of_blue = [&](const std::string& subsampling) {
    const auto file = folder / ("s" + subsampling.substr(2, 1) + ".jpg");
    write_image(file, pixels_of(64, 64, 3, SampleType::kUint8, samples),
                {.type = SampleType::kUint8, .jpeg_quality = 100, .jpeg_subsampling = subsampling});
    ImageReader reader(file);
    return static_cast<int>(native<std::uint8_t>(reader, 0, 64)[3 * (64 * 20 + 21)]);
  };
  EXPECT_LT(red_of_blue("4:4:4"), 10);
  EXPECT_GT(red_of_blue("4:2:0"), 50);
}

TEST(ImageLayout, RefusesAJpegThatWasCutOffAmongItsPixels) {
  const TempFolder folder;
  const auto file = folder / "a.jpg";
  write_image(file, pixels_of(128, 128, 3, SampleType::kUint8, picture8(128, 128, 3)),
              {.type = SampleType::kUint8, .jpeg_quality = 98});
  const auto whole = std::filesystem::file_size(file);
  EXPECT_NO_THROW(layout_of(file));
  // What follows the end does not matter, however long; nor where pieces of the search meet.
  for (const std::size_t more : {1U, 4095U, 4096U, 20000U}) {
    std::filesystem::resize_file(file, whole + more);
    EXPECT_NO_THROW(layout_of(file)) << more;
  }
  for (const std::size_t less : {1U, 2U, 4096U, static_cast<unsigned>(whole / 2)}) {
    std::filesystem::resize_file(file, whole - less);
    EXPECT_THROW(layout_of(file), IoError) << less;
  }
}

std::string message_of(const std::filesystem::path& file, IoError::Side side) {
  try {
    ImageReader reader(file);
    std::vector<std::byte> room(reader.header().row_bytes() *
                                static_cast<std::size_t>(reader.header().height));
    reader.read_native(0, reader.header().height, room);
  } catch (const IoError& error) {
    EXPECT_EQ(error.side(), side);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "no error";
}

TEST(ImageReader, FilesThatCannotBeReadAreNamedInOneLine) {
  const TempFolder folder;
  tests::write_text(folder / "text.png", "no picture");
  tests::write_text(folder / "empty.jpg", "");
  const auto samples = picture8(64, 64, 3);
  write_image(folder / "whole.png", pixels_of(64, 64, 3, SampleType::kUint8, samples),
              {.type = SampleType::kUint8});
  const std::string bytes = tests::read_text(folder / "whole.png");
  tests::write_text(folder / "cut.png", bytes.substr(0, bytes.size() / 2));
  EXPECT_THAT(message_of(folder / "none.png", IoError::Side::kInput), HasSubstr("none.png: no such file"));
  EXPECT_THAT(message_of(folder.path(), IoError::Side::kInput), HasSubstr("is a directory"));
  for (const char* name : {"text.png", "empty.jpg"}) {
    EXPECT_THAT(message_of(folder / name, IoError::Side::kInput), HasSubstr("cannot be read as an image"));
  }
  EXPECT_THAT(message_of(folder / "cut.png", IoError::Side::kInput), HasSubstr("cut.png: rows "));
}

TEST(ImageReader, WhatCannotBeWrittenLeavesNothingBehind) {
  const TempFolder folder;
  const auto samples = picture8(4, 4, 3);
  const ImagePixels pixels = pixels_of(4, 4, 3, SampleType::kUint8, samples);
  EXPECT_THROW(write_image(folder / "none/a.png", pixels, {.type = SampleType::kUint8}), IoError);
  EXPECT_THROW(write_image(folder / "a.nothing", pixels, {.type = SampleType::kUint8}), IoError);
  // JPEG has 8 bits; writing fewer bits than asked for would be a silent loss.
  EXPECT_THROW(write_image(folder / "a.jpg", pixels, {.type = SampleType::kUint16}), IoError);
  EXPECT_THROW(write_image(folder / "a.png", {4, 5, 3, SampleType::kUint8, pixels.samples}, {}),
               std::invalid_argument);
  EXPECT_TRUE(folder.names().empty());
}

TEST(ImageReader, RowsOutsideAreRefused) {
  const TempFolder folder;
  const auto samples = picture8(4, 4, 3);
  write_image(folder / "a.png", pixels_of(4, 4, 3, SampleType::kUint8, samples),
              {.type = SampleType::kUint8});
  ImageReader reader(folder / "a.png");
  std::vector<std::byte> room(24);
  EXPECT_THROW(reader.read_native(3, 2, room), std::invalid_argument);
  EXPECT_THROW(reader.read_native(-1, 2, room), std::invalid_argument);
  EXPECT_THROW(reader.read_native(0, 1, room), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::io
