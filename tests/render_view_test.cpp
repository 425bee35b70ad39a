// Display transforms, exact 8-bit codes, and how pixels without a value look.
#include "render/view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace brdfit::render {
namespace {

constexpr float kLargest = std::numeric_limits<float>::max();
constexpr ViewTransform kTransforms[] = {ViewTransform::kLinear, ViewTransform::kSrgb,
                                         ViewTransform::kGranTurismo};

// The definition.
int code_of(float value, const ViewOptions& options) {
  return static_cast<int>(
      std::round(255.0 * display_value(options.transform, std::exp2(options.exposure_stops) * value)));
}

// One row, each value three times.
Image row_of(const std::vector<float>& values) {
  Image image(static_cast<int>(values.size()), 1);
  for (std::size_t k = 0; k < image.rgb.size(); ++k) image.rgb[k] = values[k / 3];
  return image;
}

Image image_of(int width, int height, float value, PixelState state) {
  Image image(width, height);
  image.rgb.assign(image.rgb.size(), state == PixelState::kValue ? value : 0.0F);
  image.state.assign(image.state.size(), state);
  return image;
}

void expect_exact(const std::vector<float>& values, const ViewOptions& options) {
  const Picture picture = to_picture(row_of(values), options);
  for (std::size_t k = 0; k < values.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(picture.rgb[3 * k + c], code_of(values[k], options))
          << values[k] << " " << name_of(options.transform) << " " << options.exposure_stops;
    }
  }
}

// The smallest float whose code by the definition is at least this.
float first_with_code(int code, const ViewOptions& options) {
  std::uint32_t below = 0;
  std::uint32_t above = std::bit_cast<std::uint32_t>(kLargest);
  if (code_of(kLargest, options) < code) return kLargest;
  while (above - below > 1) {
    const std::uint32_t middle = below + (above - below) / 2;
    (code_of(std::bit_cast<float>(middle), options) >= code ? above : below) = middle;
  }
  return std::bit_cast<float>(above);
}

TEST(ToPicture, RoundsExactlyAtAndAroundEveryStep) {
  for (const ViewTransform transform : kTransforms) {
    for (const double stops : {0.0, -6.0, -0.37, 1.5, 10.0}) {
      const ViewOptions options = {transform, stops, Channel::kRgb};
      std::vector<float> values;
      for (int code = 1; code <= 255; ++code) {
        const float first = first_with_code(code, options);
        EXPECT_EQ(code_of(first, options), code);
        for (const float value : {std::nextafter(first, 0.0F), first, std::nextafter(first, kLargest)}) {
          values.push_back(value);
        }
      }
      expect_exact(values, options);
    }
  }
}

TEST(ToPicture, RoundsAnyFloatExactly) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::uint32_t> any(0, std::bit_cast<std::uint32_t>(kLargest));
  std::uniform_real_distribution<float> visible(0.0F, 2.0F);
  std::vector<float> values = {0.0F,
                               -0.0F,
                               1.0F,
                               kLargest,
                               std::numeric_limits<float>::denorm_min(),
                               std::numeric_limits<float>::min()};
  for (int k = 0; k < 20000; ++k) {
    values.push_back(std::bit_cast<float>(any(random)));
    values.push_back(visible(random));
  }
  for (const ViewTransform transform : kTransforms) {
    for (const double stops : {0.0, -3.3, 4.0}) expect_exact(values, {transform, stops, Channel::kRgb});
  }
}

TEST(ToPicture, RoundsExactlyAtExposuresBeyondReason) {
  const std::vector<float> values = {
      0.0F,    std::numeric_limits<float>::denorm_min(), 3e-45F, 1e-38F, 1e-20F, 1e-3F, 1.0F, 1e10F, 1e38F,
      kLargest};
  for (const ViewTransform transform : kTransforms) {
    for (const double stops : {-900.0, -135.0, -125.0, 120.0, 145.0, 155.0, 900.0}) {
      expect_exact(values, {transform, stops, Channel::kRgb});
    }
    // Even a gain that is not finite keeps black black.
    const Picture picture = to_picture(row_of({0.0F, 1.0F}), {transform, 5000.0, Channel::kRgb});
    EXPECT_THAT(picture.rgb, testing::ElementsAre(0, 0, 0, 255, 255, 255));
  }
}

TEST(ToPicture, TakesWhatNoImageHoldsForBlack) {
  for (const ViewTransform transform : kTransforms) {
    const Picture picture =
        to_picture(row_of({-1.0F, -kLargest, std::nanf("")}), {transform, 0.0, Channel::kRgb});
    EXPECT_THAT(picture.rgb, testing::Each(0));
  }
}

TEST(ToPicture, RefusesAnExposureThatIsNotFinite) {
  for (const double stops : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    EXPECT_THROW(to_picture(Image(2, 2), {ViewTransform::kSrgb, stops, Channel::kRgb}),
                 std::invalid_argument);
  }
}

TEST(ToPicture, KnowsCodesOfOthers) {
  const auto code = [](ViewTransform transform, float value) {
    return int{to_picture(row_of({value}), {transform, 0.0, Channel::kRgb}).rgb[0]};
  };
  EXPECT_EQ(code(ViewTransform::kLinear, 0.5F), 128);
  EXPECT_EQ(code(ViewTransform::kSrgb, 0.5F), 188);
  EXPECT_EQ(code(ViewTransform::kSrgb, 0.18F), 118);
  EXPECT_EQ(code(ViewTransform::kSrgb, 0.2158605F), 128);
  EXPECT_EQ(code(ViewTransform::kSrgb, 2.0F), 255);
}

TEST(ToPicture, MultipliesByThePowerOfTwoOfTheExposure) {
  const std::vector<float> values = {0.001F, 0.02F, 0.1F, 0.3F, 0.7F, 1.4F};
  for (const ViewTransform transform : kTransforms) {
    for (const int stops : {-3, 1, 5}) {
      std::vector<float> scaled;
      for (const float value : values) scaled.push_back(std::ldexp(value, stops));
      EXPECT_EQ(to_picture(row_of(values), {transform, double(stops), Channel::kRgb}).rgb,
                to_picture(row_of(scaled), {transform, 0.0, Channel::kRgb}).rgb);
    }
  }
}

TEST(ToPicture, ShowsASingleChannelAsGrey) {
  Image image(1, 1);
  image.rgb = {0.1F, 0.4F, 0.8F};
  const auto grey = [&](Channel channel) {
    const Picture picture = to_picture(image, {ViewTransform::kLinear, 0.0, channel});
    EXPECT_EQ(picture.rgb[0], picture.rgb[1]);
    EXPECT_EQ(picture.rgb[0], picture.rgb[2]);
    return int{picture.rgb[0]};
  };
  EXPECT_EQ(grey(Channel::kRed), 26);
  EXPECT_EQ(grey(Channel::kGreen), 102);
  EXPECT_EQ(grey(Channel::kBlue), 204);
  EXPECT_EQ(grey(Channel::kLuminance), std::lround(255 * (0.2126 * 0.1 + 0.7152 * 0.4 + 0.0722 * 0.8)));
  EXPECT_THAT(to_picture(image, {ViewTransform::kLinear, 0.0, Channel::kRgb}).rgb,
              testing::ElementsAre(26, 102, 204));
}

TEST(ToPicture, KeepsTheOrderOfPixels) {
  Image image(3, 2);
  for (std::size_t k = 0; k < image.rgb.size(); ++k) image.rgb[k] = static_cast<float>(k) / 255.0F;
  const Picture picture = to_picture(image, {ViewTransform::kLinear, 0.0, Channel::kRgb});
  ASSERT_EQ(picture.width, 3);
  ASSERT_EQ(picture.height, 2);
  for (std::size_t k = 0; k < image.rgb.size(); ++k) EXPECT_EQ(picture.rgb[k], k);
}

TEST(ToPicture, DoesNotDependOnTheNumberOfThreads) {
  std::mt19937 random(2);
  Image image(301, 203);
  for (float& value : image.rgb) value = std::generate_canonical<float, 24>(random);
  for (PixelState& state : image.state) state = static_cast<PixelState>(random() % kPixelStateCount);
  const Picture parallel = to_picture(image, {});
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(to_picture(image, {}).rgb, parallel.rgb);
}

// Pixels without a value. -----------------------------------------------------------------------------------

using Colour = std::array<int, 3>;

Colour colour_at(const Picture& picture, int x, int y) {
  const auto k = static_cast<std::size_t>(3 * (y * picture.width + x));
  return {picture.rgb[k], picture.rgb[k + 1], picture.rgb[k + 2]};
}

int brightness(const Colour& colour) {
  return colour[0] + colour[1] + colour[2];
}

constexpr PixelState kHatched[] = {PixelState::kUnmeasured, PixelState::kNotFinite, PixelState::kNegative};

TEST(ToPicture, ShowsWhatIsOutsideOrBelowTheHorizonInFlatDarkGreys) {
  const Picture outside = to_picture(image_of(20, 20, 0.0F, PixelState::kOutside), {});
  const Picture below = to_picture(image_of(20, 20, 0.0F, PixelState::kBelowHorizon), {});
  for (const Picture* picture : {&outside, &below}) {
    EXPECT_THAT(picture->rgb, testing::Each(picture->rgb[0]));
    EXPECT_GT(picture->rgb[0], 0);
    EXPECT_LT(picture->rgb[0], 100);
  }
  EXPECT_LT(below.rgb[0], outside.rgb[0]);
}

// Whatever the values, the exposure and the transform: no area of a value picture has stripes of this
// contrast in these places.
TEST(ToPicture, HatchesWhatIsMissingWithStripesOfStrongContrast) {
  for (const int size : {16, 64, 256, 512, 1024}) {
    for (const PixelState state : kHatched) {
      const Picture picture = to_picture(image_of(size, size, 0.0F, state), {});
      const Colour first = colour_at(picture, 0, 0);
      int period = 1;
      while (period < size && colour_at(picture, period, 0) == first) ++period;
      while (period < size && colour_at(picture, period, 0) != first) ++period;
      EXPECT_GE(period, 4);
      EXPECT_LE(period, std::max(4, size / 80));
      const Colour second = colour_at(picture, period - 1, 0);
      EXPECT_GE(std::abs(brightness(first) - brightness(second)), 150);
      for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
          const bool in_first = (x + y) % period < period / 2;
          ASSERT_EQ(colour_at(picture, x, y), in_first ? first : second) << x << " " << y;
        }
      }
    }
  }
}

TEST(ToPicture, TellsStatesApartByColour) {
  const auto first = [](PixelState state) {
    return colour_at(to_picture(image_of(8, 8, 0.0F, state), {}), 0, 0);
  };
  const Colour grey = first(PixelState::kUnmeasured);
  EXPECT_EQ(grey[0], grey[1]);
  EXPECT_EQ(grey[1], grey[2]);
  const Colour magenta = first(PixelState::kNotFinite);
  EXPECT_EQ(magenta, (Colour{255, 0, 255}));
  const Colour cyan = first(PixelState::kNegative);
  EXPECT_EQ(cyan, (Colour{0, 255, 255}));
}

// Stripes of two areas that values part, or of two states, continue one another.
TEST(ToPicture, HatchesByTheirPlaceInThePicture) {
  Image image = image_of(64, 64, 0.0F, PixelState::kUnmeasured);
  const Picture whole = to_picture(image, {});
  for (int y = 0; y < 64; ++y) {
    for (int x = 20; x < 31; ++x) image.state[static_cast<std::size_t>(64 * y + x)] = PixelState::kValue;
  }
  const Picture parted = to_picture(image, {});
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Colour expected = x >= 20 && x < 31 ? Colour{0, 0, 0} : colour_at(whole, x, y);
      ASSERT_EQ(colour_at(parted, x, y), expected);
    }
  }
}

TEST(ToPicture, ShowsStatesAlikeInEveryView) {
  const Image image = image_of(32, 32, 0.0F, PixelState::kNotFinite);
  const Picture expected = to_picture(image, {});
  for (const ViewTransform transform : kTransforms) {
    for (const Channel channel : {Channel::kRgb, Channel::kRed, Channel::kLuminance}) {
      EXPECT_EQ(to_picture(image, {transform, 3.0, channel}).rgb, expected.rgb);
    }
  }
}

// Transforms. -----------------------------------------------------------------------------------------------

TEST(GranTurismo, IsTheIdentityInItsLinearSection) {
  for (int k = 0; k <= 1000; ++k) {
    const double value = 0.22 + (0.532 - 0.22) * k / 1000.0;
    EXPECT_NEAR(gran_turismo(value), value, 1e-15);
  }
}

TEST(GranTurismo, RisesWithoutStepsFromZeroToOne) {
  EXPECT_EQ(gran_turismo(0.0), 0.0);
  double last = 0.0;
  constexpr double kStep = 1e-4;
  for (int k = 1; k <= 100000; ++k) {
    const double value = gran_turismo(k * kStep);
    ASSERT_GT(value, last);
    ASSERT_LT(value - last, 1.6 * kStep);
    ASSERT_LT(value, 1.0);
    last = value;
  }
  EXPECT_NEAR(gran_turismo(100.0), 1.0, 1e-15);
  EXPECT_EQ(gran_turismo(HUGE_VAL), 1.0);
}

TEST(GranTurismo, HasAContinuousSlope) {
  for (const double joint : {0.22, 0.532}) {
    const double h = 1e-6;
    EXPECT_NEAR((gran_turismo(joint) - gran_turismo(joint - h)) / h, 1.0, 1e-4);
    EXPECT_NEAR((gran_turismo(joint + h) - gran_turismo(joint)) / h, 1.0, 1e-4);
  }
}

// By hand: the toe at half its length is the mean of 0.22 * 0.5^1.33 and 0.11, at a quarter
// smoothstep(0.25) = 0.15625 of the way; the shoulder at 1 has gone one
// part of 0.468 / 0.468.
TEST(GranTurismo, HasThePublishedToeAndShoulder) {
  EXPECT_NEAR(gran_turismo(0.11), 0.5 * (0.22 * std::pow(0.5, 1.33) + 0.11), 1e-15);
  EXPECT_NEAR(gran_turismo(0.055), 0.84375 * 0.22 * std::pow(0.25, 1.33) + 0.15625 * 0.055, 1e-15);
  EXPECT_NEAR(gran_turismo(1.0), 1.0 - 0.468 * std::exp(-1.0), 1e-15);
}

TEST(DisplayValue, RisesFromZeroToOne) {
  for (const ViewTransform transform : kTransforms) {
    EXPECT_EQ(display_value(transform, 0.0), 0.0);
    EXPECT_EQ(display_value(transform, -1.0), 0.0);
    EXPECT_EQ(display_value(transform, std::nan("")), 0.0);
    EXPECT_NEAR(display_value(transform, 1e30), 1.0, 1e-15);
    double last = 0.0;
    for (int k = 1; k < 9999; ++k) {
      const double value = display_value(transform, k * 1e-4);
      ASSERT_GT(value, last);
      ASSERT_LT(value, 1.0);
      last = value;
    }
  }
}

TEST(DisplayValue, OfTheToneMapperIsThatOfItsOutput) {
  for (const double value : {0.001, 0.1, 0.3, 0.9, 4.0}) {
    EXPECT_EQ(display_value(ViewTransform::kGranTurismo, value),
              display_value(ViewTransform::kSrgb, gran_turismo(value)));
  }
}

TEST(ViewNames, LeadBackToWhatTheyName) {
  for (const ViewTransform transform : kTransforms) {
    EXPECT_EQ(view_transform_by_name(name_of(transform)), transform);
  }
  for (const Channel channel :
       {Channel::kRgb, Channel::kRed, Channel::kGreen, Channel::kBlue, Channel::kLuminance}) {
    EXPECT_EQ(channel_by_name(name_of(channel)), channel);
  }
  EXPECT_EQ(name_of(ViewTransform::kGranTurismo), "gt");
  EXPECT_EQ(name_of(Channel::kLuminance), "luminance");
  EXPECT_FALSE(view_transform_by_name("filmic"));
  EXPECT_FALSE(channel_by_name(""));
}

}  // namespace
}  // namespace brdfit::render
