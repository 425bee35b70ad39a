// Curves between codes and light, and what files say of theirs.
#include "io/transfer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/image_layout.h"
#include "tests/stack_files.h"

namespace brdfit::io {
namespace {

using tests::TempFolder;
using tests::write_picture;

std::vector<Transfer> all_transfers() {
  std::vector<Transfer> all;
  for (const char* name : {"linear", "srgb", "rec709", "gamma 2.2", "gamma 0.45"})
    all.push_back(*transfer_from(name));
  return all;
}

TEST(Transfer, CodeAndLightAreInverseMonotoneAndOdd) {
  for (const Transfer& transfer : all_transfers()) {
    double last = -1.0;
    for (double code = 0.0; code <= 1.5; code += 1.0 / 512.0) {
      const double light = to_linear(transfer, code);
      EXPECT_GT(light, last) << name_of(transfer) << code;
      EXPECT_NEAR(to_code(transfer, light), code, 1e-12) << name_of(transfer);
      EXPECT_EQ(to_linear(transfer, -code), -light);
      last = light;
    }
    EXPECT_NEAR(to_linear(transfer, 1.0), 1.0, 1e-12) << name_of(transfer);
  }
}

TEST(Transfer, CurvesPassThroughTheirStandardsValues) {
  EXPECT_NEAR(to_linear(*transfer_from("srgb"), 0.5), 0.21404, 1e-5);   // IEC 61966-2-1
  EXPECT_NEAR(to_code(*transfer_from("rec709"), 0.18), 0.40899, 1e-4);  // BT.709: 1.099 L^0.45 - 0.099
  EXPECT_NEAR(to_linear(*transfer_from("gamma 2.2"), 0.5), 0.21764, 1e-5);
}

TEST(Transfer, NamesComeBackAndOthersAreRefused) {
  for (const Transfer& transfer : all_transfers()) EXPECT_EQ(transfer_from(name_of(transfer)), transfer);
  for (const char* name :
       {"", "sRGB", "log", "gamma", "gamma ", "gamma 0", "gamma 9", "gamma -1", "gamma 2.2x"}) {
    EXPECT_FALSE(transfer_from(name)) << name;
  }
}

// OpenImageIO says "sRGB" of any PNG and JPEG; that is no statement of the file.
TEST(Transfer, OnlyWhatAFileSaysCounts) {
  const TempFolder folder;
  const auto half = [](int, int, int) { return 0.5F; };
  const std::vector<std::uint8_t> samples(std::size_t{4} * 4 * 3, 128);
  const auto write = [&](const char* name, const std::string& space) {
    write_image(folder / name, {4, 4, 3, SampleType::kUint8, std::as_bytes(std::span(samples))},
                {.type = SampleType::kUint8, .colour_space = space});
    return transfer_in_file(folder / name, ImageReader(folder / name).header());
  };
  EXPECT_EQ(write("plain.png", ""), std::nullopt);
  EXPECT_EQ(write("plain.jpg", ""), std::nullopt);
  EXPECT_EQ(write("srgb.png", "sRGB"), Transfer{Transfer::Kind::kSrgb});
  EXPECT_EQ(write("linear.png", "Linear"), Transfer{});
  write_picture(folder / "a.exr", 4, 4, 3, SampleType::kHalf, half);
  EXPECT_EQ(transfer_in_file(folder / "a.exr", ImageReader(folder / "a.exr").header()), Transfer{});
  write_picture(folder / "a.tif", 4, 4, 3, SampleType::kUint16, half);
  EXPECT_EQ(transfer_in_file(folder / "a.tif", ImageReader(folder / "a.tif").header()), std::nullopt);
  EXPECT_EQ(usual_transfer(SampleType::kUint8), Transfer{Transfer::Kind::kSrgb});
  EXPECT_EQ(usual_transfer(SampleType::kUint16), Transfer{});
}

TEST(ImageLayout, SeesWhatMustBeDecodedAsAWhole) {
  const TempFolder folder;
  tests::write_grey(folder / "plain.png");
  EXPECT_FALSE(layout_of(folder / "plain.png").needs_whole_image);
  std::string png = tests::read_text(folder / "plain.png");
  png[28] = 1;  // the interlace method, in IHDR
  tests::write_text(folder / "interlaced.png", png);
  EXPECT_TRUE(layout_of(folder / "interlaced.png").needs_whole_image);

  tests::write_grey(folder / "plain.jpg");
  EXPECT_FALSE(layout_of(folder / "plain.jpg").needs_whole_image);
  std::string jpeg = tests::read_text(folder / "plain.jpg");
  const std::size_t frame = jpeg.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  jpeg[frame + 1] = '\xC2';
  tests::write_text(folder / "progressive.jpg", jpeg);
  EXPECT_TRUE(layout_of(folder / "progressive.jpg").needs_whole_image);
  tests::write_text(folder / "cut.jpg", jpeg.substr(0, 11));
  EXPECT_FALSE(layout_of(folder / "cut.jpg").needs_whole_image);
}

}  // namespace
}  // namespace brdfit::io
