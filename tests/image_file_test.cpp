// Image files hold what was given, say what it is, and are the same bytes every time.
#include "io/image_file.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "io/error.h"
#include "tests/temp_folder.h"

namespace brdfit::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::read_text;
using tests::TempFolder;

using Bytes = std::vector<unsigned char>;

struct Decoded {
  OIIO::ImageSpec spec;
  std::vector<float> samples;  // of 8-bit files: code / 255
};

Decoded decode(const Bytes& bytes, const std::string& format) {
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::create(format);
  OIIO::ImageSpec opened;
  if (!input || !input->set_ioproxy(&memory) || !input->open("memory." + format, opened, config)) {
    throw std::runtime_error("OpenImageIO cannot read " + format + ": " + OIIO::geterror());
  }
  Decoded result{input->spec(), {}};
  result.samples.resize(static_cast<std::size_t>(result.spec.image_pixels()) *
                        static_cast<std::size_t>(result.spec.nchannels));
  if (!input->read_image(0, 0, 0, result.spec.nchannels, OIIO::TypeDesc::FLOAT, result.samples.data())) {
    throw std::runtime_error(input->geterror());
  }
  return result;
}

std::vector<std::uint8_t> codes(std::size_t count) {
  std::vector<std::uint8_t> result(count);
  for (std::size_t k = 0; k < count; ++k) result[k] = static_cast<std::uint8_t>(k * 37 + k / 5);
  return result;
}

// Values over the whole range of floats, also below 0.
std::vector<float> values(std::size_t count) {
  std::vector<float> result(count);
  for (std::size_t k = 0; k < count; ++k) {
    result[k] = (k % 3 == 0 ? -1.0F : 1.0F) * std::exp2(static_cast<float>(k % 250) - 125.0F) * 1.1F;
  }
  return result;
}

const ImageMetadata kMetadata = {{"ImageDescription", "slice of gold-metallic-paint2, f in sr^-1"},
                                 {"Software", "brdfit 0.1.0"},
                                 {"units", "sr^-1"},
                                 {"light angle", "90 deg"},
                                 {"brdfit:exposure_stops", "-1.5"},
                                 {"Comment", "two lines:\n\xCE\xB8_h and <&>"}};

TEST(ImageFile, PngHoldsTheGivenCodesForEveryNumberOfChannels) {
  for (const int channels : {1, 3, 4}) {
    const auto samples = codes(std::size_t{17} * 5 * static_cast<std::size_t>(channels));
    const Decoded read = decode(encode_png({17, 5, channels, samples}), "png");
    EXPECT_EQ(read.spec.width, 17);
    EXPECT_EQ(read.spec.height, 5);
    EXPECT_EQ(read.spec.nchannels, channels);
    EXPECT_EQ(read.spec.format, OIIO::TypeDesc::UINT8);
    ASSERT_EQ(read.samples.size(), samples.size());
    for (std::size_t k = 0; k < samples.size(); ++k) {
      EXPECT_EQ(std::lround(read.samples[k] * 255.0F), samples[k]) << channels << " channels, sample " << k;
    }
  }
}

TEST(ImageFile, ExrHoldsTheGivenFloatsUnderTheirNames) {
  const auto samples = values(std::size_t{9} * 7 * 3);
  const Decoded read = decode(encode_exr({9, 7, {"R", "G", "B"}, samples}), "exr");
  EXPECT_EQ(read.spec.width, 9);
  EXPECT_EQ(read.spec.height, 7);
  EXPECT_THAT(read.spec.channelnames, ElementsAre("R", "G", "B"));
  EXPECT_EQ(read.spec.format, OIIO::TypeDesc::FLOAT);
  EXPECT_EQ(read.spec.get_string_attribute("compression"), "zip");
  EXPECT_EQ(read.samples, samples);
}

TEST(ImageFile, ExrTakesAnyNumberOfNamedChannels) {
  const auto samples = values(std::size_t{4} * 4 * 2);
  const Decoded read = decode(encode_exr({4, 4, {"difference.Y", "state.Z"}, samples}), "exr");
  EXPECT_THAT(read.spec.channelnames, ElementsAre("difference.Y", "state.Z"));
  EXPECT_EQ(read.samples, samples);
}

TEST(ImageFile, MetadataIsKept) {
  const auto png = decode(encode_png({2, 2, 3, codes(12)}, kMetadata), "png");
  const auto exr = decode(encode_exr({2, 2, {"R", "G", "B"}, values(12)}, kMetadata), "exr");
  for (const auto& [name, text] : kMetadata) {
    EXPECT_EQ(png.spec.get_string_attribute(name), text) << name;
    EXPECT_EQ(exr.spec.get_string_attribute(name), text) << name;
  }
}

// A date, a host or a history would make two files of the same picture differ.
TEST(ImageFile, NothingIsAddedThatChangesFromRunToRun) {
  const auto png = encode_png({2, 2, 3, codes(12)}, kMetadata);
  const auto exr = encode_exr({2, 2, {"R", "G", "B"}, values(12)}, kMetadata);
  for (const auto& [bytes, format] : {std::pair(png, "png"), std::pair(exr, "exr")}) {
    const Decoded read = decode(bytes, format);
    for (const auto& attribute : read.spec.extra_attribs) {
      const std::string name = attribute.name().string();
      const bool is_given = std::any_of(kMetadata.begin(), kMetadata.end(),
                                        [&](const auto& entry) { return entry.first == name; });
      const bool is_constant = name.starts_with("oiio:") || name.starts_with("screenWindow") ||
                               name == "compression" || name == "PixelAspectRatio";
      EXPECT_TRUE(is_given || is_constant) << format << ": " << name << " = " << attribute.get_string();
    }
  }
  // tIME is PNG's chunk for a date; an EXR has capDate, which must be empty.
  const std::string png_text(png.begin(), png.end());
  EXPECT_EQ(png_text.find("tIME"), std::string::npos);
  const std::string exr_text(exr.begin(), exr.end());
  const std::size_t date = exr_text.find("capDate");
  if (date != std::string::npos) {
    EXPECT_EQ(exr_text.substr(date, 19), std::string("capDate\0string\0\0\0\0\0", 19));
  }
}

TEST(ImageFile, TheSamePictureIsTheSameBytes) {
  const auto pixels = codes(std::size_t{64} * 64 * 3);
  const auto floats = values(std::size_t{64} * 64 * 3);
  EXPECT_EQ(encode_png({64, 64, 3, pixels}, kMetadata), encode_png({64, 64, 3, pixels}, kMetadata));
  EXPECT_EQ(encode_exr({64, 64, {"R", "G", "B"}, floats}, kMetadata),
            encode_exr({64, 64, {"R", "G", "B"}, floats}, kMetadata));
}

TEST(ImageFile, SizesThatDisagreeAreRefused) {
  const auto pixels = codes(12);
  const auto floats = values(12);
  for (const auto& [width, height] : {std::pair(2, 3), {3, 2}, {0, 2}, {2, 0}, {-2, -2}, {12, 1}}) {
    EXPECT_THROW(encode_png({width, height, 3, pixels}), std::invalid_argument) << width << " x " << height;
    EXPECT_THROW(encode_exr({width, height, {"R", "G", "B"}, floats}), std::invalid_argument)
        << width << " x " << height;
  }
  EXPECT_THROW(encode_png({2, 2, 3, std::span(pixels).first(11)}), std::invalid_argument);
  EXPECT_THROW(encode_png({3, 2, 2, pixels}), std::invalid_argument);
  EXPECT_THROW(encode_exr({2, 2, {}, {}}), std::invalid_argument);
}

TEST(ImageFile, ChannelsNeedNamesOfTheirOwn) {
  const auto floats = values(8);
  EXPECT_THROW(encode_exr({2, 2, {"R", "R"}, floats}), std::invalid_argument);
  EXPECT_THROW(encode_exr({2, 2, {"R", ""}, floats}), std::invalid_argument);
}

TEST(ImageFile, ValuesThatAreNotFiniteAreRefusedWithTheirPlace) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()}) {
    auto floats = values(std::size_t{4} * 3 * 3);
    floats[(2 * 4 + 1) * 3 + 2] = bad;
    try {
      encode_exr({4, 3, {"R", "G", "B"}, floats});
      ADD_FAILURE() << bad << " was taken";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr("column 1, row 2 is not finite"));
    }
  }
}

TEST(ImageFile, MetadataThatTheFileWouldLoseIsRefused) {
  const auto pixels = codes(12);
  const auto floats = values(12);
  const std::vector<ImageMetadata> refused = {{{"", "x"}},
                                              {{std::string(80, 'n'), "x"}},
                                              {{" space", "x"}},
                                              {{"two  spaces", "x"}},
                                              {{"line\n", "x"}},
                                              {{"DateTime", "2000:01:01 00:00:00"}},
                                              {{"compression", "none"}},
                                              {{"oiio:ColorSpace", "x"}},
                                              {{"units", "sr^-1"}, {"Units", "m"}},
                                              {{"units", std::string("a\0b", 3)}}};
  for (const ImageMetadata& metadata : refused) {
    EXPECT_THROW(encode_png({2, 2, 3, pixels}, metadata), std::invalid_argument) << metadata[0].first;
    EXPECT_THROW(encode_exr({2, 2, {"R", "G", "B"}, floats}, metadata), std::invalid_argument)
        << metadata[0].first;
  }
}

TEST(ImageFile, WritesAndReplacesFilesWhole) {
  const TempFolder folder;
  const Bytes bytes = encode_png({2, 2, 3, codes(12)});
  write_text(folder / "picture.png", "an older file");
  write_bytes(folder / "picture.png", bytes);
  EXPECT_EQ(read_text(folder / "picture.png"), std::string(bytes.begin(), bytes.end()));
  EXPECT_THAT(folder.names(), ElementsAre("picture.png"));
}

TEST(ImageFile, AFolderThatIsNotThereIsAnOutputError) {
  const TempFolder folder;
  for (const bool is_text : {false, true}) {
    try {
      if (is_text) {
        write_text(folder / "none/picture.svg", "<svg/>");
      } else {
        write_bytes(folder / "none/picture.png", Bytes{1, 2, 3});
      }
      ADD_FAILURE() << "no error";
    } catch (const IoError& error) {
      EXPECT_EQ(error.side(), IoError::Side::kOutput);
      EXPECT_THAT(error.what(), HasSubstr("picture."));
    }
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

}  // namespace
}  // namespace brdfit::io
