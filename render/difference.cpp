// Differences, their colours, and the bar that explains the colours.
#include "render/difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "render/canvas.h"
#include "render/caption.h"
#include "render/text_layout.h"

namespace brdfit::render {
namespace {

constexpr double kLogRatioFloor = 1e-3;

using Pixel = std::array<double, 3>;

// Weights of the channels that are shown; luminance as in Rec.709.
Pixel weights_of(Channel channel) {
  switch (channel) {
    case Channel::kRed:
      return {1.0, 0.0, 0.0};
    case Channel::kGreen:
      return {0.0, 1.0, 0.0};
    case Channel::kBlue:
      return {0.0, 0.0, 1.0};
    case Channel::kRgb:
    case Channel::kLuminance:
      break;
  }
  return {0.2126, 0.7152, 0.0722};
}

double shown_value(const Pixel& rgb, Channel channel) {
  const Pixel weight = weights_of(channel);
  return weight[0] * rgb[0] + weight[1] * rgb[1] + weight[2] * rgb[2];
}

double log_of(double value) {
  return std::log(std::max(value, 0.0) + kLogRatioFloor);
}

double log_ratio(const Pixel& model, const Pixel& reference, Channel channel) {
  if (channel != Channel::kRgb) {
    return log_of(shown_value(model, channel)) - log_of(shown_value(reference, channel));
  }
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) sum += log_of(model[c]) - log_of(reference[c]);
  return sum / 3.0;
}

float to_float(double value) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -kLargest, kLargest));
}

Pixel pixel_of(const Image& image, std::size_t k) {
  return {image.rgb[3 * k], image.rgb[3 * k + 1], image.rgb[3 * k + 2]};
}

// Colours are given in CIELAB (D65), where equal steps look equal; L falls linearly from white to the ends.
struct Lab {
  double l;
  double a;
  double b;
};
constexpr std::array<Lab, 3> kReds = {{{100.0, 0.0, 0.0}, {66.0, 42.0, 26.0}, {32.0, 52.0, 30.0}}};
constexpr std::array<Lab, 3> kBlues = {{{100.0, 0.0, 0.0}, {66.0, -8.0, -34.0}, {32.0, 6.0, -44.0}}};
constexpr std::array<Lab, 3> kYellowToRed = {{{100.0, 0.0, 0.0}, {66.0, 36.0, 48.0}, {32.0, 50.0, 34.0}}};

Lab mix(const std::array<Lab, 3>& points, double place) {
  const std::size_t k = place < 0.5 ? 0 : 1;
  const double t = 2.0 * place - static_cast<double>(k);
  const auto between = [t](double from, double to) { return from + t * (to - from); };
  return {between(points[k].l, points[k + 1].l), between(points[k].a, points[k + 1].a),
          between(points[k].b, points[k + 1].b)};
}

double inverse_lab_curve(double t) {
  constexpr double kKnee = 6.0 / 29.0;
  return t > kKnee ? t * t * t : 3.0 * kKnee * kKnee * (t - 4.0 / 29.0);
}

std::uint8_t srgb_byte(double linear) {
  return static_cast<std::uint8_t>(
      std::lround(255.0 * std::clamp(display_value(ViewTransform::kSrgb, linear), 0.0, 1.0)));
}

Colour8 colour_of(const Lab& lab) {
  const double fy = (lab.l + 16.0) / 116.0;
  const double x = 0.95047 * inverse_lab_curve(fy + lab.a / 500.0);
  const double y = inverse_lab_curve(fy);
  const double z = 1.08883 * inverse_lab_curve(fy - lab.b / 200.0);
  return {srgb_byte(std::max(0.0, 3.2404542 * x - 1.5371385 * y - 0.4985314 * z)),
          srgb_byte(std::max(0.0, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z)),
          srgb_byte(std::max(0.0, 0.0556434 * x - 0.2040259 * y + 1.0572252 * z))};
}

// Colours over [-1, 1]; the middle is exactly white.
constexpr int kHalfSteps = 255;
using ColourMap = std::array<Colour8, 2 * kHalfSteps + 1>;

ColourMap make_map(const std::array<Lab, 3>& below, const std::array<Lab, 3>& above) {
  ColourMap map;
  for (int k = -kHalfSteps; k <= kHalfSteps; ++k) {
    const double place = std::abs(k) / static_cast<double>(kHalfSteps);
    map[static_cast<std::size_t>(k + kHalfSteps)] = colour_of(mix(k < 0 ? below : above, place));
  }
  return map;
}

const ColourMap& map_of(DifferenceKind kind) {
  static const ColourMap diverging = make_map(kBlues, kReds);
  static const ColourMap sequential = make_map(kYellowToRed, kYellowToRed);
  return kind == DifferenceKind::kAbsolute ? sequential : diverging;
}

Colour8 colour_at(const ColourMap& map, double share) {
  const long step = std::lround(std::clamp(share, -1.0, 1.0) * kHalfSteps);
  return map[static_cast<std::size_t>(step + kHalfSteps)];
}

void check_range(double range) {
  if (!std::isfinite(range) || range <= 0.0) {
    throw std::invalid_argument("the range of a difference is a positive number");
  }
}

// 1, 2 or 5 times a power of ten, the least that is not below the value.
double round_up(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    // What is a round number but for the last bits stays that number.
    if (factor * decade >= value * (1.0 - 1e-6)) return factor * decade;
  }
  return 10.0 * decade;
}

// Shares of the range at which the bar has numbers: as many as there is room for.
std::vector<double> bar_ticks(DifferenceKind kind, int bar_height, int text_px) {
  const int room = bar_height / (3 * text_px / 2);
  const double low = kind == DifferenceKind::kAbsolute ? 0.0 : -1.0;
  const int steps = room >= 4 ? 4 : room >= 2 ? 2 : 1;
  std::vector<double> ticks;
  for (int k = 0; k <= steps; ++k) ticks.push_back(low + (1.0 - low) * k / steps);
  return ticks;
}

std::string bar_number(double value, DifferenceKind kind) {
  const bool plus = kind != DifferenceKind::kAbsolute && value > 0.0;
  return fmt::format("{}{}", plus ? "+" : "", pretty_number(value));
}

}  // namespace

std::string_view name_of(DifferenceKind kind) {
  switch (kind) {
    case DifferenceKind::kSigned:
      return "signed";
    case DifferenceKind::kAbsolute:
      return "absolute";
    case DifferenceKind::kLogRatio:
      break;
  }
  return "log-ratio";
}

std::optional<DifferenceKind> difference_kind_by_name(std::string_view name) {
  for (const DifferenceKind kind :
       {DifferenceKind::kSigned, DifferenceKind::kAbsolute, DifferenceKind::kLogRatio}) {
    if (name_of(kind) == name) return kind;
  }
  return std::nullopt;
}

Difference difference_of(const Image& model, const Image& reference, DifferenceKind kind,
                         const ViewOptions& view) {
  if (model.width != reference.width || model.height != reference.height) {
    throw std::invalid_argument("difference_of: the pictures differ in size");
  }
  Difference result;
  result.width = model.width;
  result.height = model.height;
  result.value.assign(model.pixel_count(), 0.0F);
  result.state = reference.state;
  const double scale = std::exp2(view.exposure_stops);
  for (std::size_t k = 0; k < result.value.size(); ++k) {
    if (result.state[k] != PixelState::kValue) continue;
    result.state[k] = model.state[k];
    if (result.state[k] != PixelState::kValue) continue;
    const Pixel m = pixel_of(model, k);
    const Pixel r = pixel_of(reference, k);
    if (kind == DifferenceKind::kLogRatio) {
      result.value[k] = to_float(log_ratio(m, r, view.channel));
    } else {
      const double difference = scale * (shown_value(m, view.channel) - shown_value(r, view.channel));
      result.value[k] = to_float(kind == DifferenceKind::kAbsolute ? std::abs(difference) : difference);
    }
  }
  return result;
}

double difference_range(std::span<const Difference> all) {
  std::vector<float> sizes;
  for (const Difference& difference : all) {
    for (std::size_t k = 0; k < difference.value.size(); ++k) {
      if (difference.state[k] == PixelState::kValue) sizes.push_back(std::abs(difference.value[k]));
    }
  }
  constexpr double kLeast = 1e-3;
  if (sizes.empty()) return kLeast;
  const auto place = static_cast<std::size_t>(std::ceil(0.98 * static_cast<double>(sizes.size()))) - 1;
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(place), sizes.end());
  return round_up(std::max(kLeast, static_cast<double>(sizes[place])));
}

double share_beyond(std::span<const Difference> all, double range) {
  std::size_t values = 0;
  std::size_t beyond = 0;
  for (const Difference& difference : all) {
    for (std::size_t k = 0; k < difference.value.size(); ++k) {
      if (difference.state[k] != PixelState::kValue) continue;
      ++values;
      if (std::abs(static_cast<double>(difference.value[k])) > range * (1.0 + 1e-6)) ++beyond;
    }
  }
  return values == 0 ? 0.0 : static_cast<double>(beyond) / static_cast<double>(values);
}

Picture difference_picture(const Difference& difference, DifferenceKind kind, double range) {
  check_range(range);
  Image states(difference.width, difference.height);
  states.state = difference.state;
  Picture picture = to_picture(states, {});
  const ColourMap& map = map_of(kind);
  for (std::size_t k = 0; k < difference.value.size(); ++k) {
    if (difference.state[k] != PixelState::kValue) continue;
    const Colour8 colour = colour_at(map, difference.value[k] / range);
    picture.rgb[3 * k] = colour.r;
    picture.rgb[3 * k + 1] = colour.g;
    picture.rgb[3 * k + 2] = colour.b;
  }
  return picture;
}

Picture colour_bar(DifferenceKind kind, double range, const std::string& unit, int height, int text_px) {
  check_range(range);
  const std::vector<std::string> unit_lines =
      unit.empty() ? std::vector<std::string>()
                   : wrap_text(unit, text_px, FontWeight::kRegular, std::max(1, height));
  // The numbers at the ends stand half above and half below the bar's edges.
  const int top = text_px / 2;
  const int bar_width = 5 * text_px / 4;
  const int bar_height = std::max(2, height - 2 * top);
  const std::vector<double> ticks = bar_ticks(kind, bar_height, text_px);
  int number_width = 0;
  for (const double tick : ticks) {
    number_width =
        std::max(number_width, text_width(bar_number(tick * range, kind), text_px, FontWeight::kRegular));
  }
  const int tick_length = std::max(3, text_px / 4);
  const int number_x = bar_width + 2 + tick_length + text_px / 4;
  const int unit_x = number_x + number_width + text_px / 2;
  const int unit_width = static_cast<int>(unit_lines.size()) * row_height(text_px);
  Canvas canvas(unit_lines.empty() ? number_x + number_width : unit_x + unit_width, std::max(1, height),
                {255, 255, 255});

  const TextStyle number_style{.size_px = text_px, .align_y = AlignY::kCentre};
  const double low = ticks.front();
  const ColourMap& map = map_of(kind);
  for (int row = 0; row < bar_height; ++row) {
    const double share = 1.0 - (1.0 - low) * row / (bar_height - 1);
    canvas.fill(1, top + row, bar_width, 1, colour_at(map, share));
  }
  canvas.frame(0, top - 1, bar_width + 2, bar_height + 2, number_style.colour);
  for (const double tick : ticks) {
    const int y = top + static_cast<int>(std::lround((bar_height - 1) * (1.0 - tick) / (1.0 - low)));
    canvas.line(bar_width + 2, y, bar_width + 1 + tick_length, y, number_style.colour);
    canvas.text(number_x, y, bar_number(tick * range, kind), number_style);
  }
  const TextStyle unit_style{
      .size_px = text_px, .align_x = AlignX::kCentre, .align_y = AlignY::kTop, .upwards = true};
  for (std::size_t k = 0; k < unit_lines.size(); ++k) {
    canvas.text(unit_x + static_cast<int>(k) * row_height(text_px), height / 2, unit_lines[k], unit_style);
  }
  return canvas.picture();
}

}  // namespace brdfit::render
