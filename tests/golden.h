// Golden pictures: files in tests/golden that pictures are compared with, within what an eye would notice.
//
// Two comparisons of OpenImageIO have to agree that nothing changed: Yee's perceptual metric, which sees what
// moved, and a plain one of 8-bit codes, which sees the faint changes of large areas that Yee's takes for a
// change of light. Rounding in another compiler or processor moves single codes by one; a few pixels at an
// edge may move more.
#ifndef BRDFIT_TESTS_GOLDEN_H_
#define BRDFIT_TESTS_GOLDEN_H_

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "io/image_file.h"
#include "render/image.h"

namespace brdfit::tests {

// Most that a picture may differ from its golden one.
inline constexpr float kCodeStep = 3.5F / 255.0F;  // of a channel: three 8-bit codes
inline constexpr double kFailingShare = 0.002;     // of the pixels that may differ by more
inline constexpr double kPerceivedShare = 0.002;   // of the pixels that Yee's metric may find different

struct PictureDifference {
  bool same_size = false;
  double failing_share = 1.0;
  double perceived_share = 1.0;
  double largest = 1.0;  // of a channel's codes, over 255

  bool is_noticed() const {
    return !same_size || failing_share > kFailingShare || perceived_share > kPerceivedShare;
  }
};

inline std::ostream& operator<<(std::ostream& out, const PictureDifference& difference) {
  if (!difference.same_size) return out << "sizes differ";
  return out << 100.0 * difference.failing_share << "% of the pixels differ by more than "
             << 255.0F * kCodeStep << " codes (at most " << 255.0 * difference.largest << "), "
             << 100.0 * difference.perceived_share << "% to the eye";
}

// Display values, or linear ones, which Yee's metric takes.
inline OIIO::ImageBuf buffer_of(const render::Picture& picture, bool is_linear) {
  std::vector<float> samples(picture.rgb.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const float v = static_cast<float>(picture.rgb[k]) / 255.0F;
    const float linear = v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
    samples[k] = is_linear ? linear : v;
  }
  const OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeDesc::FLOAT);
  OIIO::ImageBuf buffer(spec);
  buffer.set_pixels(OIIO::get_roi(spec), OIIO::TypeDesc::FLOAT, samples.data());
  return buffer;
}

inline PictureDifference compare_pictures(const render::Picture& a, const render::Picture& b) {
  PictureDifference difference;
  difference.same_size = a.width == b.width && a.height == b.height;
  if (!difference.same_size) return difference;
  const double pixels = static_cast<double>(a.width) * static_cast<double>(a.height);
  const auto codes =
      OIIO::ImageBufAlgo::compare(buffer_of(a, false), buffer_of(b, false), kCodeStep, kCodeStep);
  OIIO::ImageBufAlgo::CompareResults ignored;
  const int perceived = OIIO::ImageBufAlgo::compare_Yee(buffer_of(a, true), buffer_of(b, true), ignored);
  if (OIIO::has_error()) throw std::runtime_error("OpenImageIO cannot compare: " + OIIO::geterror());
  difference.failing_share = static_cast<double>(codes.nfail) / pixels;
  difference.perceived_share = perceived / pixels;
  difference.largest = codes.maxerror;
  return difference;
}

inline std::filesystem::path golden_file(std::string_view name) {
  return std::filesystem::path(BRDFIT_GOLDEN) / (std::string(name) + ".png");
}

inline void write_picture(const std::filesystem::path& file, const render::Picture& picture) {
  std::filesystem::create_directories(file.parent_path());
  io::write_bytes(file, io::encode_png({picture.width, picture.height, 3, picture.rgb}));
}

inline render::Picture read_picture(const std::filesystem::path& file) {
  const OIIO::ImageBuf buffer(file.string());
  const OIIO::ImageSpec& spec = buffer.spec();
  render::Picture picture(spec.width, spec.height);
  if (spec.nchannels != 3 ||
      !buffer.get_pixels(OIIO::get_roi(spec), OIIO::TypeDesc::UINT8, picture.rgb.data())) {
    throw std::runtime_error("cannot read " + file.string() + ": " + buffer.geterror());
  }
  return picture;
}

// Compares with the golden picture of that name; with BRDFIT_UPDATE_GOLDEN=1 makes it the golden one.
inline testing::AssertionResult is_golden(const render::Picture& picture, std::string_view name) {
  const std::filesystem::path file = golden_file(name);
  const char* update = std::getenv("BRDFIT_UPDATE_GOLDEN");
  if (update != nullptr && std::string_view(update) == "1") {
    write_picture(file, picture);
    return testing::AssertionSuccess();
  }
  std::ostringstream why;
  if (!std::filesystem::exists(file)) {
    why << "there is no " << file.string();
  } else {
    const PictureDifference difference = compare_pictures(picture, read_picture(file));
    if (!difference.is_noticed()) return testing::AssertionSuccess();
    why << file.string() << ": " << difference;
  }
  const std::filesystem::path drawn = std::filesystem::path(BRDFIT_GOLDEN_NEW) / (std::string(name) + ".png");
  write_picture(drawn, picture);
  return testing::AssertionFailure() << why.str() << "; what was drawn is in " << drawn.string();
}

}  // namespace brdfit::tests

#endif  // BRDFIT_TESTS_GOLDEN_H_
