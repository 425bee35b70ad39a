// Differences are those of the values, and their colours can be read back from the bar.
#include "render/difference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "tests/picture_tools.h"

namespace brdfit::render {
namespace {

using testing::Each;
using tests::pixel_at;
using tests::Rgb8;

constexpr DifferenceKind kKinds[] = {DifferenceKind::kSigned, DifferenceKind::kAbsolute,
                                     DifferenceKind::kLogRatio};
constexpr Channel kChannels[] = {Channel::kRgb, Channel::kRed, Channel::kGreen, Channel::kBlue,
                                 Channel::kLuminance};

// One row of pixels of the given colours.
Image row_of(const std::vector<float>& rgb) {
  Image image(static_cast<int>(rgb.size() / 3), 1);
  image.rgb = rgb;
  image.state.assign(image.pixel_count(), PixelState::kValue);
  return image;
}

Image random_row(unsigned seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> exponent(-12.0F, 6.0F);
  std::vector<float> rgb(3 * static_cast<std::size_t>(count));
  for (float& value : rgb) value = std::exp2(exponent(random));
  return row_of(rgb);
}

Difference row_of_differences(const std::vector<float>& values) {
  return {static_cast<int>(values.size()), 1, values,
          std::vector<PixelState>(values.size(), PixelState::kValue)};
}

double channel_of(const Image& image, std::size_t k, Channel channel) {
  const auto at = [&](std::size_t c) { return static_cast<double>(image.rgb[3 * k + c]); };
  if (channel == Channel::kRed) return at(0);
  if (channel == Channel::kGreen) return at(1);
  if (channel == Channel::kBlue) return at(2);
  return 0.2126 * at(0) + 0.7152 * at(1) + 0.0722 * at(2);
}

// CIE 1976 lightness of an sRGB colour.
double lightness(const Rgb8& pixel) {
  const auto linear = [](std::uint8_t code) {
    const double v = code / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  const double y = 0.2126729 * linear(pixel[0]) + 0.7151522 * linear(pixel[1]) + 0.0721750 * linear(pixel[2]);
  return y > 0.008856 ? 116.0 * std::cbrt(y) - 16.0 : 903.3 * y;
}

Rgb8 colour_of(DifferenceKind kind, double range, double value) {
  return pixel_at(difference_picture(row_of_differences({static_cast<float>(value)}), kind, range), 0, 0);
}

TEST(Difference, IsThatOfTheChannelThatIsShown) {
  const Image model = random_row(1, 500);
  const Image reference = random_row(2, 500);
  for (const Channel channel : kChannels) {
    ViewOptions view;
    view.channel = channel;
    const Difference is_signed = difference_of(model, reference, DifferenceKind::kSigned, view);
    const Difference absolute = difference_of(model, reference, DifferenceKind::kAbsolute, view);
    for (std::size_t k = 0; k < model.pixel_count(); ++k) {
      const double m = channel_of(model, k, channel);
      const double r = channel_of(reference, k, channel);
      ASSERT_NEAR(is_signed.value[k], m - r, 1e-6 * (m + r));
      ASSERT_EQ(absolute.value[k], std::abs(is_signed.value[k]));
    }
  }
}

TEST(Difference, OfLogarithmsIsThatOfTheErrorMeasure) {
  const Image model = random_row(3, 500);
  const Image reference = random_row(4, 500);
  for (const Channel channel : kChannels) {
    ViewOptions view;
    view.channel = channel;
    const Difference difference = difference_of(model, reference, DifferenceKind::kLogRatio, view);
    for (std::size_t k = 0; k < model.pixel_count(); ++k) {
      const auto ratio = [&](Channel c) {
        return std::log((channel_of(model, k, c) + 1e-3) / (channel_of(reference, k, c) + 1e-3));
      };
      const double expected =
          channel == Channel::kRgb
              ? (ratio(Channel::kRed) + ratio(Channel::kGreen) + ratio(Channel::kBlue)) / 3.0
              : ratio(channel);
      ASSERT_NEAR(difference.value[k], expected, 1e-5);
    }
  }
}

TEST(Difference, ChangesSignWithTheOrder) {
  const Image a = random_row(5, 200);
  const Image b = random_row(6, 200);
  for (const DifferenceKind kind : {DifferenceKind::kSigned, DifferenceKind::kLogRatio}) {
    const Difference forth = difference_of(a, b, kind, {});
    const Difference back = difference_of(b, a, kind, {});
    for (std::size_t k = 0; k < a.pixel_count(); ++k) ASSERT_EQ(forth.value[k], -back.value[k]);
  }
  for (const DifferenceKind kind : kKinds) EXPECT_THAT(difference_of(a, a, kind, {}).value, Each(0.0F));
}

TEST(Difference, IsAsExposedUnlessItIsARatio) {
  const Image model = random_row(7, 100);
  const Image reference = random_row(8, 100);
  for (const DifferenceKind kind : kKinds) {
    ViewOptions exposed;
    exposed.exposure_stops = 3.0;
    const Difference plain = difference_of(model, reference, kind, {});
    const Difference scaled = difference_of(model, reference, kind, exposed);
    const float factor = kind == DifferenceKind::kLogRatio ? 1.0F : 8.0F;
    for (std::size_t k = 0; k < model.pixel_count(); ++k) {
      ASSERT_EQ(scaled.value[k], factor * plain.value[k]);
    }
  }
}

TEST(Difference, HasAValueWhereBothHaveOneAndOtherwiseSaysWhy) {
  Image model(6, 6);
  Image reference(6, 6);
  model.rgb.assign(model.rgb.size(), 2.0F);
  reference.rgb.assign(reference.rgb.size(), 1.0F);
  for (std::size_t k = 0; k < 36; ++k) {
    model.state[k] = static_cast<PixelState>(k % 6);
    reference.state[k] = static_cast<PixelState>(k / 6);
  }
  for (const DifferenceKind kind : kKinds) {
    const Difference difference = difference_of(model, reference, kind, {});
    for (std::size_t k = 0; k < 36; ++k) {
      const bool reference_has_one = reference.state[k] == PixelState::kValue;
      ASSERT_EQ(difference.state[k], reference_has_one ? model.state[k] : reference.state[k]);
      ASSERT_EQ(difference.value[k] > 0.0F, k == 0);
    }
  }
}

TEST(Difference, IsFiniteWhateverTheImagesHold) {
  const float most = std::numeric_limits<float>::max();
  const Image high = row_of({most, most, most});
  const Image low = row_of({-most, -most, -most});
  const Image zero = row_of({0.0F, 0.0F, 0.0F});
  for (const DifferenceKind kind : kKinds) {
    for (const Image* model : {&high, &low, &zero}) {
      for (const Image* reference : {&high, &low, &zero}) {
        for (const double stops : {-300.0, 0.0, 300.0}) {
          ViewOptions view;
          view.exposure_stops = stops;
          ASSERT_TRUE(std::isfinite(difference_of(*model, *reference, kind, view).value[0]));
        }
      }
    }
  }
}

TEST(Difference, OfPicturesOfDifferentSizesIsAnError) {
  for (const DifferenceKind kind : kKinds) {
    EXPECT_THROW(difference_of(Image(3, 2), Image(2, 3), kind, {}), std::invalid_argument);
    EXPECT_THROW(difference_of(Image(3, 2), Image(3, 3), kind, {}), std::invalid_argument);
  }
}

TEST(DifferenceRange, IsTheLeastRoundNumberThatCovers98Percent) {
  std::mt19937 random(9);
  for (int round = 0; round < 200; ++round) {
    const double scale = std::exp(std::uniform_real_distribution<double>(-6.0, 12.0)(random));
    std::normal_distribution<float> normal(0.0F, static_cast<float>(scale));
    std::vector<Difference> all;
    std::vector<double> sizes;
    for (const int count : {300, 1, 51}) {
      std::vector<float> values(static_cast<std::size_t>(count));
      for (float& value : values) {
        value = normal(random);
        sizes.push_back(std::abs(static_cast<double>(value)));
      }
      all.push_back(row_of_differences(values));
    }
    const double range = difference_range(all);
    const double leading = range / std::pow(10.0, std::floor(std::log10(range * (1.0 + 1e-9))));
    EXPECT_TRUE(std::abs(leading - 1.0) < 1e-6 || std::abs(leading - 2.0) < 1e-6 ||
                std::abs(leading - 5.0) < 1e-6)
        << range;
    const auto covered = [&](double limit) {
      return static_cast<double>(std::count_if(sizes.begin(), sizes.end(),
                                               [&](double size) { return size <= limit * (1.0 + 1e-6); })) /
             static_cast<double>(sizes.size());
    };
    EXPECT_GE(covered(range), 0.98);
    EXPECT_GE(range, 1e-3 * (1.0 - 1e-9));
    const double next_below = range / (std::abs(leading - 5.0) < 1e-6 ? 2.5 : 2.0);
    if (next_below > 1e-3) {
      EXPECT_LT(covered(next_below), 0.98);
    }
    EXPECT_NEAR(share_beyond(all, range), 1.0 - covered(range), 1e-12);
  }
}

TEST(DifferenceRange, OfRoundNumbersIsThatNumber) {
  for (const double value : {0.001, 0.002, 0.005, 0.01, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 5e20}) {
    EXPECT_NEAR(difference_range({{row_of_differences({static_cast<float>(-value)})}}), value, 1e-9 * value);
  }
  EXPECT_NEAR(difference_range({{row_of_differences({0.0051F})}}), 0.01, 1e-12);
}

TEST(DifferenceRange, OfNothingIsTheLeast) {
  EXPECT_EQ(difference_range({}), 1e-3);
  EXPECT_EQ(share_beyond({}, 1.0), 0.0);
  Difference none = row_of_differences({1000.0F, -1000.0F});
  none.state = {PixelState::kUnmeasured, PixelState::kBelowHorizon};
  EXPECT_EQ(difference_range({{none}}), 1e-3);
  EXPECT_EQ(share_beyond({{none}}, 1.0), 0.0);
  EXPECT_EQ(difference_range({{row_of_differences({0.0F})}}), 1e-3);
  EXPECT_TRUE(std::isfinite(difference_range({{row_of_differences({std::numeric_limits<float>::max()})}})));
}

TEST(DifferencePicture, IsWhiteAtZeroAndEvenlyDarkerTowardsBothEnds) {
  for (const DifferenceKind kind : kKinds) {
    EXPECT_EQ(colour_of(kind, 0.5, 0.0), tests::kWhite);
    for (const double sign : {-1.0, 1.0}) {
      if (kind == DifferenceKind::kAbsolute && sign < 0.0) continue;
      for (double share = 0.0; share <= 1.0; share += 1.0 / 64.0) {
        // 8 bits and the 255 steps of the map leave an error of half a step of lightness.
        EXPECT_NEAR(lightness(colour_of(kind, 0.5, 0.5 * sign * share)), 100.0 - 68.0 * share, 0.6);
      }
    }
  }
}

TEST(DifferencePicture, ShowsTheSign) {
  for (const DifferenceKind kind : {DifferenceKind::kSigned, DifferenceKind::kLogRatio}) {
    for (double share = 0.05; share <= 1.0; share += 0.05) {
      const Rgb8 above = colour_of(kind, 2.0, 2.0 * share);
      const Rgb8 below = colour_of(kind, 2.0, -2.0 * share);
      EXPECT_GT(above[0], above[2] + 4) << share;
      EXPECT_GT(below[2], below[0] + 4) << share;
      EXPECT_NEAR(lightness(above), lightness(below), 1.0);
    }
  }
}

TEST(DifferencePicture, HasTheColoursOfTheEndsBeyondTheRange) {
  for (const DifferenceKind kind : kKinds) {
    for (const double sign : {-1.0, 1.0}) {
      const Rgb8 end = colour_of(kind, 0.02, 0.02 * sign);
      EXPECT_EQ(colour_of(kind, 0.02, 0.03 * sign), end);
      EXPECT_EQ(colour_of(kind, 0.02, sign * std::numeric_limits<float>::max()), end);
      EXPECT_NE(colour_of(kind, 0.02, 0.019 * sign), end);
    }
  }
}

TEST(DifferencePicture, ShowsPixelsWithoutAValueAsEveryPictureDoes) {
  Image image(36, 6);
  for (std::size_t k = 0; k < image.pixel_count(); ++k) image.state[k] = static_cast<PixelState>(k % 36 / 6);
  const Difference difference{36, 6, std::vector<float>(image.pixel_count(), 0.0F), image.state};
  const Picture expected = to_picture(image, {});
  for (const DifferenceKind kind : kKinds) {
    const Picture picture = difference_picture(difference, kind, 1.0);
    for (int y = 0; y < 6; ++y) {
      for (int x = 6; x < 36; ++x) ASSERT_EQ(pixel_at(picture, x, y), pixel_at(expected, x, y));
    }
  }
}

TEST(DifferencePicture, NeedsARange) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double range : {0.0, -1.0, infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
    for (const DifferenceKind kind : kKinds) {
      EXPECT_THROW(difference_picture(row_of_differences({0.0F}), kind, range), std::invalid_argument);
      EXPECT_THROW(colour_bar(kind, range, "", 100, 16), std::invalid_argument);
    }
  }
}

TEST(ColourBar, EndsWithTheColoursOfTheRangesEnds) {
  for (const DifferenceKind kind : kKinds) {
    for (const int height : {41, 128, 300}) {
      const Picture bar = colour_bar(kind, 0.2, "sr⁻¹", height, 16);
      ASSERT_EQ(bar.height, height);
      const double low = kind == DifferenceKind::kAbsolute ? 0.0 : -0.2;
      EXPECT_EQ(pixel_at(bar, 3, 8), colour_of(kind, 0.2, 0.2));
      EXPECT_EQ(pixel_at(bar, 3, height - 9), colour_of(kind, 0.2, low));
      // Every row in between has the colour of its own value.
      for (int row = 0; row < height - 16; ++row) {
        const double value = 0.2 + (low - 0.2) * row / (height - 17);
        ASSERT_NEAR(lightness(pixel_at(bar, 3, 8 + row)), lightness(colour_of(kind, 0.2, value)), 0.5);
      }
    }
  }
}

TEST(ColourBar, HasNumbersAtItsEndsAndTheUnit) {
  const Picture is_signed = colour_bar(DifferenceKind::kSigned, 0.05, "f (sr⁻¹)", 200, 16);
  for (const char* number : {"+0.05", "−0.05", "0", "+0.025", "−0.025"}) {
    EXPECT_TRUE(tests::shows_text(is_signed, number)) << number;
  }
  EXPECT_TRUE(tests::shows_text(is_signed, "f (sr⁻¹)", {.upwards = true}));
  const Picture absolute = colour_bar(DifferenceKind::kAbsolute, 2e-5, "", 200, 16);
  EXPECT_TRUE(tests::shows_text(absolute, "2e−5"));
  EXPECT_FALSE(tests::shows_text(absolute, "−2e−5"));
  EXPECT_LT(absolute.width, is_signed.width);
}

TEST(ColourBar, KeepsItsHeightWithoutRoom) {
  for (const DifferenceKind kind : kKinds) {
    for (const int height : {1, 2, 15, 16, 17, 20}) {
      EXPECT_EQ(colour_bar(kind, 1.0, "a unit of several words", height, 16).height, height);
    }
  }
}

TEST(DifferenceKind, HasANameAndIsFoundByIt) {
  for (const DifferenceKind kind : kKinds) EXPECT_EQ(difference_kind_by_name(name_of(kind)), kind);
  EXPECT_EQ(difference_kind_by_name("relative"), std::nullopt);
  EXPECT_EQ(difference_kind_by_name(""), std::nullopt);
}

}  // namespace
}  // namespace brdfit::render
