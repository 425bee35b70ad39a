// Display transforms, and 8-bit pictures by thresholds.
#include "render/view.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace brdfit::render {
namespace {

constexpr std::array<std::pair<ViewTransform, std::string_view>, 3> kTransforms = {
    {{ViewTransform::kLinear, "linear"},
     {ViewTransform::kSrgb, "srgb"},
     {ViewTransform::kGranTurismo, "gt"}}};
constexpr std::array<std::pair<Channel, std::string_view>, 5> kChannels = {
    {{Channel::kRgb, "rgb"},
     {Channel::kRed, "red"},
     {Channel::kGreen, "green"},
     {Channel::kBlue, "blue"},
     {Channel::kLuminance, "luminance"}}};

template <class Names, class Value>
std::string_view name_in(const Names& names, Value value) {
  for (const auto& [candidate, name] : names) {
    if (candidate == value) return name;
  }
  return "";
}

template <class Value, std::size_t N>
std::optional<Value> value_in(const std::array<std::pair<Value, std::string_view>, N>& names,
                              std::string_view wanted) {
  for (const auto& [value, name] : names) {
    if (name == wanted) return value;
  }
  return std::nullopt;
}

// IEC 61966-2-1, for values in [0, 1].
double srgb_encoded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double srgb_decoded(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// Uchimura's parameters, in the letters of his slides.
constexpr double kMaximum = 1.0;                                                        // P
constexpr double kContrast = 1.0;                                                       // a
constexpr double kLinearStart = 0.22;                                                   // m
constexpr double kLinearLength = 0.4;                                                   // l
constexpr double kBlack = 1.33;                                                         // c
constexpr double kPedestal = 0.0;                                                       // b
constexpr double kLinearReach = (kMaximum - kLinearStart) * kLinearLength / kContrast;  // l0
constexpr double kShoulderStart = kLinearStart + kLinearReach;                          // S0
constexpr double kShoulderValue = kLinearStart + kContrast * kLinearReach;              // S1
constexpr double kShoulderSlope = kContrast * kMaximum / (kMaximum - kShoulderValue);   // C2

double gran_turismo_toe(double value) {
  const double share = value / kLinearStart;
  const double linear_weight = share * share * (3.0 - 2.0 * share);
  const double toe = kLinearStart * std::pow(share, kBlack) + kPedestal;
  const double linear = kLinearStart + kContrast * (value - kLinearStart);
  return toe + (linear - toe) * linear_weight;
}

// About the value that the tone mapper takes to `mapped` in (0, 1): to many digits, not to the last.
double gran_turismo_inverse(double mapped) {
  if (mapped >= kShoulderValue) {
    return kShoulderStart -
           kMaximum / kShoulderSlope * std::log((kMaximum - mapped) / (kMaximum - kShoulderValue));
  }
  if (mapped >= kLinearStart) return kLinearStart + (mapped - kLinearStart) / kContrast;
  double value = mapped;
  for (int k = 0; k < 12; ++k) value *= mapped / gran_turismo_toe(value);
  return value;
}

// About the value that is displayed as `displayed` in (0, 1).
double display_inverse(ViewTransform transform, double displayed) {
  switch (transform) {
    case ViewTransform::kLinear:
      return displayed;
    case ViewTransform::kSrgb:
      return srgb_decoded(displayed);
    case ViewTransform::kGranTurismo:
      break;
  }
  return gran_turismo_inverse(srgb_decoded(displayed));
}

constexpr std::size_t kTopCode = 255;

// Exact 8-bit codes without transcendental functions: the code of a value is the number of thresholds that it
// reaches. All transforms rise, and positive floats are ordered as their bits are, so that the leading bits
// tell the code but for the one threshold that may lie among the floats that share them.
class Encoder {
 public:
  Encoder(ViewTransform transform, double exposure_stops)
      : transform_(transform), gain_(std::exp2(exposure_stops)) {
    for (std::size_t code = 1; code <= kTopCode; ++code) threshold_[code - 1] = find_threshold(code);
    threshold_[kTopCode] = std::numeric_limits<float>::quiet_NaN();  // nothing reaches it
    const std::uint32_t first_bin = bin_of(threshold_[0]);
    const std::uint32_t last_bin = bin_of(threshold_[kTopCode - 1]);
    lowest_ = std::bit_cast<float>(first_bin << kShift);
    first_bin_ = first_bin;
    std::size_t code = 0;
    for (std::uint32_t bin = first_bin; bin <= last_bin; ++bin) {
      start_.push_back(static_cast<std::uint8_t>(code));
      std::size_t in_bin = 0;
      while (code < kTopCode && bin_of(threshold_[code]) == bin) ++code, ++in_bin;
      if (in_bin > 1) one_step_ = false;
    }
  }

  // Negative values and NaN count as 0.
  void encode(const float* values, std::size_t count, std::uint8_t* codes) const {
    if (!one_step_) {
      for (std::size_t k = 0; k < count; ++k) codes[k] = searched_code(values[k]);
      return;
    }
    const float highest = threshold_[kTopCode - 1];
    for (std::size_t k = 0; k < count; ++k) {
      const float above = values[k] > lowest_ ? values[k] : lowest_;
      const float value = above < highest ? above : highest;
      const std::uint8_t code = start_[bin_of(value) - first_bin_];
      codes[k] = static_cast<std::uint8_t>(code + std::uint8_t{value >= threshold_[code]});
    }
  }

 private:
  // Bits of a float that share a starting code: the exponent and eight bits of the mantissa stay.
  static constexpr int kShift = 15;

  static std::uint32_t bin_of(float value) { return std::bit_cast<std::uint32_t>(value) >> kShift; }

  // The definition.
  bool reaches(float value, std::size_t code) const {
    return 255.0 * display_value(transform_, gain_ * value) >= static_cast<double>(code) - 0.5;
  }

  // The smallest float that has at least that code; infinity if there is none.
  float find_threshold(std::size_t code) const {
    constexpr std::uint32_t kInfinity = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity());
    const double guess = display_inverse(transform_, (static_cast<double>(code) - 0.5) / 255.0) / gain_;
    const auto start = std::bit_cast<std::uint32_t>(
        static_cast<float>(std::clamp(guess, 0.0, double{std::numeric_limits<float>::max()})));
    // Zero reaches no code. Steps double until the threshold lies between the ends.
    std::uint32_t below = start;
    for (std::uint32_t step = 1; below > 0 && reaches(std::bit_cast<float>(below), code); step *= 2) {
      below -= std::min(step, below);
    }
    std::uint32_t at_or_above = std::max(start, below + 1);
    for (std::uint32_t step = 1; at_or_above < kInfinity && !reaches(std::bit_cast<float>(at_or_above), code);
         step *= 2) {
      below = at_or_above;
      at_or_above += std::min(step, kInfinity - at_or_above);
    }
    while (at_or_above - below > 1) {
      const std::uint32_t middle = below + (at_or_above - below) / 2;
      (reaches(std::bit_cast<float>(middle), code) ? at_or_above : below) = middle;
    }
    return std::bit_cast<float>(at_or_above);
  }

  // For exposures so extreme that floats cannot tell codes apart.
  std::uint8_t searched_code(float value) const {
    const auto end = threshold_.begin() + kTopCode;
    const float from_zero = value > 0.0F ? value : 0.0F;
    return static_cast<std::uint8_t>(std::upper_bound(threshold_.begin(), end, from_zero) -
                                     threshold_.begin());
  }

  ViewTransform transform_;
  double gain_;
  std::array<float, kTopCode + 1> threshold_;
  std::vector<std::uint8_t> start_;  // codes at the beginnings of bins
  std::uint32_t first_bin_ = 0;
  float lowest_ = 0.0F;
  bool one_step_ = true;  // no bin has two thresholds
};

using Code8 = std::array<std::uint8_t, 3>;

// Two colours for every state without a value; equal where it is not hatched.
std::array<Code8, 2> colours_of(PixelState state) {
  switch (state) {
    case PixelState::kValue:
      break;
    case PixelState::kOutside:
      return {{{64, 64, 64}, {64, 64, 64}}};
    case PixelState::kBelowHorizon:
      return {{{32, 32, 32}, {32, 32, 32}}};
    case PixelState::kUnmeasured:
      return {{{176, 176, 176}, {96, 96, 96}}};
    case PixelState::kNotFinite:
      return {{{255, 0, 255}, {96, 0, 96}}};
    case PixelState::kNegative:
      return {{{0, 255, 255}, {0, 88, 96}}};
  }
  return {};
}

// Width in pixels of a pair of stripes, measured along a row: wide enough to be seen at half size.
int hatch_period(const Image& image) {
  return 2 * std::max(2, static_cast<int>(std::lround(3.0 * std::min(image.width, image.height) / 512.0)));
}

class PictureMaker {
 public:
  PictureMaker(const Image& image, const ViewOptions& options)
      : image_(image),
        channel_(options.channel),
        encoder_(options.transform, options.exposure_stops),
        hatch_period_(hatch_period(image)) {}

  void draw_row(int y, std::uint8_t* rgb) const {
    const auto width = static_cast<std::size_t>(image_.width);
    const std::size_t first = static_cast<std::size_t>(y) * width;
    const float* values = image_.rgb.data() + 3 * first;
    if (channel_ == Channel::kRgb) {
      encoder_.encode(values, 3 * width, rgb);
    } else {
      draw_grey(values, width, rgb);
    }
    const PixelState* state = image_.state.data() + first;
    for (int x = 0; x < image_.width; ++x) {
      if (state[x] != PixelState::kValue) std::ranges::copy(colour_of(state[x], x, y), rgb + 3 * x);
    }
  }

 private:
  void draw_grey(const float* values, std::size_t width, std::uint8_t* rgb) const {
    std::vector<float> grey(width);
    std::vector<std::uint8_t> codes(width);
    for (std::size_t x = 0; x < width; ++x) grey[x] = channel_value(values + 3 * x);
    encoder_.encode(grey.data(), width, codes.data());
    for (std::size_t x = 0; x < width; ++x) std::fill_n(rgb + 3 * x, 3, codes[x]);
  }

  float channel_value(const float* rgb) const {
    switch (channel_) {
      case Channel::kRed:
        return rgb[0];
      case Channel::kGreen:
        return rgb[1];
      case Channel::kBlue:
        return rgb[2];
      case Channel::kRgb:
      case Channel::kLuminance:
        break;
    }
    return static_cast<float>(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);  // Rec. 709
  }

  // Stripes go by the pixel's place alone, so that neighbouring areas have no seam.
  Code8 colour_of(PixelState state, int x, int y) const {
    const bool second_stripe = (x + y) % hatch_period_ >= hatch_period_ / 2;
    return colours_of(state)[second_stripe ? 1 : 0];
  }

  const Image& image_;
  Channel channel_;
  Encoder encoder_;
  int hatch_period_;
};

}  // namespace

std::string_view name_of(ViewTransform transform) {
  return name_in(kTransforms, transform);
}
std::string_view name_of(Channel channel) {
  return name_in(kChannels, channel);
}
std::optional<ViewTransform> view_transform_by_name(std::string_view name) {
  return value_in(kTransforms, name);
}
std::optional<Channel> channel_by_name(std::string_view name) {
  return value_in(kChannels, name);
}

double gran_turismo(double value) {
  if (value < kLinearStart) return gran_turismo_toe(value);
  if (value <= kShoulderStart) return kLinearStart + kContrast * (value - kLinearStart);
  return kMaximum -
         (kMaximum - kShoulderValue) * std::exp(-kShoulderSlope / kMaximum * (value - kShoulderStart));
}

double display_value(ViewTransform transform, double value) {
  if (!(value > 0.0)) return 0.0;
  switch (transform) {
    case ViewTransform::kLinear:
      return std::min(value, 1.0);
    case ViewTransform::kSrgb:
      return srgb_encoded(std::min(value, 1.0));
    case ViewTransform::kGranTurismo:
      break;
  }
  return srgb_encoded(gran_turismo(value));
}

Picture to_picture(const Image& image, const ViewOptions& options) {
  if (!std::isfinite(options.exposure_stops)) {
    throw std::invalid_argument("to_picture: exposure is not a finite number of stops");
  }
  Picture picture(image.width, image.height);
  const PictureMaker maker(image, options);
  tbb::parallel_for(tbb::blocked_range<int>(0, image.height), [&](const tbb::blocked_range<int>& range) {
    for (int y = range.begin(); y < range.end(); ++y) {
      maker.draw_row(y,
                     &picture.rgb[3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width)]);
    }
  });
  return picture;
}

}  // namespace brdfit::render
