// Pictures written by rows: what is read back is what was written, and nothing is left of what was not
// finished.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "io/exr_rows.h"
#include "io/png_rows.h"
#include "tests/temp_folder.h"

namespace brdfit::io {
namespace {

using tests::TempFolder;

constexpr int kWidth = 7;
constexpr int kHeight = 5;

// Planes [channel][row][column] of rows [first, first + rows).
std::vector<float> planes(int channels, int first, int rows) {
  std::vector<float> out;
  for (int c = 0; c < channels; ++c) {
    for (int y = first; y < first + rows; ++y) {
      for (int x = 0; x < kWidth; ++x)
        out.push_back(0.25F * static_cast<float>(c * 100 + y * kWidth + x) - 3.0F);
    }
  }
  return out;
}

class Rows : public testing::Test {
 protected:
  TempFolder folder_;
};

TEST_F(Rows, ExrRowsComeBackWhateverTheRuns) {
  for (const ExrDepth depth : {ExrDepth::kHalf, ExrDepth::kFloat}) {
    const auto file = folder_.path() / "planes.exr";
    ExrRowWriter writer(file, kWidth, kHeight, {"lobe0.Y", "lobe1.Y", "confidence"}, depth);
    writer.write(planes(3, 0, 2), 2);
    writer.write(planes(3, 2, 1), 1);
    writer.write(planes(3, 3, 2), 2);
    writer.commit();
    ExrRowReader reader(file, {"lobe1.Y", "lobe0.Y"});
    EXPECT_EQ(reader.width(), kWidth);
    EXPECT_EQ(reader.height(), kHeight);
    const std::vector<float> all = planes(3, 1, 3);
    const std::vector<float> read = reader.read(1, 3);
    const std::size_t plane = 3 * kWidth;
    ASSERT_EQ(read.size(), 2 * plane);
    for (std::size_t k = 0; k < plane; ++k) {
      EXPECT_EQ(read[k], all[plane + k]);
      EXPECT_EQ(read[plane + k], all[k]);
    }
    std::filesystem::remove(file);
  }
}

TEST_F(Rows, OthersReadTheExrToo) {
  const auto file = folder_.path() / "others.exr";
  ExrRowWriter writer(file, kWidth, kHeight, {"A1", "B2"}, ExrDepth::kFloat);
  writer.write(planes(2, 0, kHeight), kHeight);
  writer.commit();
  OIIO::ImageBuf image(file.string());
  ASSERT_TRUE(image.read(0, 0, true, OIIO::TypeDesc::FLOAT)) << image.geterror();
  EXPECT_EQ(image.spec().channelnames, (std::vector<std::string>{"A1", "B2"}));
  EXPECT_EQ(image.getchannel(3, 2, 0, 1), planes(2, 0, kHeight)[kWidth * kHeight + 2 * kWidth + 3]);
}

TEST_F(Rows, HalvesThatWouldOverflowAreCutAndCounted) {
  const auto file = folder_.path() / "large.exr";
  ExrRowWriter writer(file, 2, 1, {"Y"}, ExrDepth::kHalf);
  writer.write(std::vector<float>{1e7F, -2.0F}, 1);
  writer.commit();
  EXPECT_EQ(writer.cut_values(), 1U);
  EXPECT_EQ(ExrRowReader(file, {"Y"}).read(0, 1), (std::vector<float>{65504.0F, -2.0F}));
}

TEST_F(Rows, NothingIsLeftOfAnUnfinishedFile) {
  const auto exr = folder_.path() / "half.exr";
  const auto png = folder_.path() / "half.png";
  {
    ExrRowWriter writer(exr, kWidth, kHeight, {"Y"}, ExrDepth::kFloat);
    writer.write(planes(1, 0, 2), 2);
    EXPECT_THROW(writer.commit(), std::invalid_argument);
    EXPECT_THROW(writer.write(std::vector<float>(kWidth, NAN), 1), std::invalid_argument);
    PngRowWriter other(png, kWidth, kHeight, 1);
    EXPECT_THROW(other.commit(), std::invalid_argument);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(Rows, AMissingChannelOrADamagedFileIsNamed) {
  const auto file = folder_.path() / "planes.exr";
  ExrRowWriter writer(file, kWidth, kHeight, {"Y"}, ExrDepth::kFloat);
  writer.write(planes(1, 0, kHeight), kHeight);
  writer.commit();
  EXPECT_THROW(ExrRowReader(file, {"Z"}), IoError);
  EXPECT_THROW(ExrRowReader(folder_.path() / "none.exr", {"Y"}), IoError);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 40);
  EXPECT_THROW(ExrRowReader(file, {"Y"}).read(0, kHeight), IoError);
}

TEST_F(Rows, WideRowsReachTheFileWhole) {
  // Rows go to the file as they are, what is between them is gathered.
  constexpr int kWide = 3000;
  for (const ExrCompression compression : {ExrCompression::kNone, ExrCompression::kZip}) {
    const auto file = folder_.path() / "wide.exr";
    std::vector<float> values(std::size_t{2} * kWide * 5);
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = std::sin(0.1F * static_cast<float>(k));
    ExrRowWriter writer(file, kWide, 5, {"A", "B"}, ExrDepth::kFloat, {}, compression);
    writer.write(values, 5);
    writer.commit();
    EXPECT_EQ(ExrRowReader(file, {"A", "B"}).read(0, 5), values);
  }
}

class PngRows : public testing::TestWithParam<PngCompression> {
 protected:
  TempFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Compressions, PngRows,
                         testing::Values(PngCompression::kQuick, PngCompression::kNone),
                         [](const auto& which) {
                           return which.param == PngCompression::kNone ? "None" : "Quick";
                         });

TEST_P(PngRows, AreExact) {
  for (const int channels : {1, 3, 4}) {
    const auto file = folder_.path() / ("codes" + std::to_string(channels) + ".png");
    std::vector<std::uint8_t> samples(static_cast<std::size_t>(kWidth * kHeight * channels));
    for (std::size_t k = 0; k < samples.size(); ++k) samples[k] = static_cast<std::uint8_t>(37 * k + 11);
    PngRowWriter writer(file, kWidth, kHeight, channels, GetParam());
    const std::size_t top = static_cast<std::size_t>(kWidth * 2 * channels);
    writer.write(std::span(samples).first(top), 2);
    writer.write(std::span(samples).subspan(top), kHeight - 2);
    writer.commit();
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;  // alpha is a code like the others
    OIIO::ImageInput::unique_ptr image = OIIO::ImageInput::open(file.string(), &config);
    ASSERT_TRUE(image);
    std::vector<std::uint8_t> read(samples.size());
    ASSERT_TRUE(image->read_image(0, 0, 0, -1, OIIO::TypeDesc::UINT8, read.data()));
    EXPECT_EQ(read, samples);
  }
}

}  // namespace
}  // namespace brdfit::io
