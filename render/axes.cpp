// Ticks, numbers and names around a slice.
#include "render/axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace brdfit::render {
namespace {

constexpr Colour8 kInk = {32, 32, 32};
constexpr Colour8 kWhite = {255, 255, 255};
constexpr std::array<int, 9> kAngles = {0, 1, 5, 15, 30, 45, 60, 75, 90};
// Where there is no room for all numbers, the first of these stay.
constexpr std::array<int, 9> kByImportance = {0, 90, 45, 30, 60, 15, 75, 5, 1};

int tick_length(int text_px) {
  return std::max(3, text_px / 4);
}

int width_of(std::string_view text, int text_px) {
  return text_width(text, text_px, FontWeight::kRegular);
}

std::string degrees(int deg) {
  return std::to_string(deg) + "°";
}

// The ticks whose numbers are drawn: extent_of gives the length of a number along the axis.
template <typename ExtentOf>
std::vector<Tick> ticks_with_numbers(const std::vector<Tick>& ticks, const ExtentOf& extent_of) {
  std::vector<Tick> shown;
  for (const int deg : kByImportance) {
    const auto tick = std::find_if(ticks.begin(), ticks.end(), [&](const Tick& t) { return t.deg == deg; });
    if (tick == ticks.end()) continue;
    const bool free = std::all_of(shown.begin(), shown.end(), [&](const Tick& other) {
      return 2 * std::abs(other.pixel - tick->pixel) > extent_of(*tick) + extent_of(other);
    });
    if (free) shown.push_back(*tick);
  }
  return shown;
}

// The first of the texts that fits, else the last.
std::string_view fitting(std::span<const std::string_view> texts, int text_px, int room) {
  const auto found = std::find_if(texts.begin(), texts.end(),
                                  [&](std::string_view text) { return width_of(text, text_px) <= room; });
  return found == texts.end() ? texts.back() : *found;
}

void draw_theta_h(Canvas& canvas, int x, int bottom, const SliceOptions& slice, AxisDetail detail,
                  int text_px) {
  const std::vector<Tick> ticks = theta_h_ticks(slice.axis, slice.size);
  const int length = tick_length(text_px);
  for (const Tick& tick : ticks) {
    canvas.line(x + tick.pixel, bottom, x + tick.pixel, bottom + length - 1, kInk);
  }
  if (detail == AxisDetail::kTicks) return;
  TextStyle style{.size_px = text_px, .colour = kInk, .align_x = AlignX::kCentre, .align_y = AlignY::kTop};
  const auto extent = [&](const Tick& tick) { return width_of(degrees(tick.deg), text_px) + text_px / 3; };
  for (const Tick& tick : ticks_with_numbers(ticks, extent)) {
    canvas.text(x + tick.pixel, bottom + length + text_px / 5, degrees(tick.deg), style);
  }
  constexpr std::array<std::string_view, 3> kNames = {"half angle θh (degrees)", "half angle θh", "θh"};
  constexpr std::array<std::string_view, 3> kRootNames = {"half angle θh (degrees, square-root axis)",
                                                          "half angle θh (sqrt axis)", "θh (sqrt)"};
  const auto& names = slice.axis == ThetaHAxis::kLinear ? kNames : kRootNames;
  canvas.text(x + slice.size / 2, bottom + length + text_px / 5 + 5 * text_px / 4,
              fitting(names, text_px, slice.size + text_px), style);
}

void draw_theta_d(Canvas& canvas, int left, int y, const SliceOptions& slice, AxisDetail detail,
                  int text_px) {
  const std::vector<Tick> ticks = theta_d_ticks(slice.size);
  const int length = tick_length(text_px);
  for (const Tick& tick : ticks) {
    const int at = y + slice.size - tick.pixel;
    canvas.line(left - length, at, left - 1, at, kInk);
  }
  if (detail == AxisDetail::kTicks) return;
  TextStyle style{.size_px = text_px, .colour = kInk, .align_x = AlignX::kRight, .align_y = AlignY::kCentre};
  for (const Tick& tick : ticks_with_numbers(ticks, [&](const Tick&) { return 5 * text_px / 4; })) {
    canvas.text(left - length - text_px / 5, y + slice.size - tick.pixel, degrees(tick.deg), style);
  }
  constexpr std::array<std::string_view, 3> kNames = {"difference angle θd (degrees)", "difference angle θd",
                                                      "θd"};
  style.align_x = AlignX::kCentre;
  style.align_y = AlignY::kBottom;
  style.upwards = true;
  canvas.text(left - length - text_px / 3 - width_of("90°", text_px), y + slice.size / 2,
              fitting(kNames, text_px, slice.size + text_px), style);
}

// White on a dark rim: legible on any picture.
void outlined_text(Canvas& canvas, int x, int y, std::string_view text, TextStyle style) {
  const int rim = std::max(1, style.size_px / 8);
  style.colour = kInk;
  for (int dy = -rim; dy <= rim; ++dy) {
    for (int dx = -rim; dx <= rim; ++dx) {
      if (dx * dx + dy * dy <= rim * rim + 1) canvas.text(x + dx, y + dy, text, style);
    }
  }
  style.colour = kWhite;
  canvas.text(x, y, text, style);
}

// The largest size up to text_px at which a text fits.
int fitting_size(std::string_view text, int text_px, int room) {
  int size_px = text_px;
  while (size_px > 6 && width_of(text, size_px) > room) --size_px;
  return size_px;
}

}  // namespace

std::vector<Tick> theta_h_ticks(ThetaHAxis axis, int size) {
  std::vector<Tick> ticks;
  for (const int deg : kAngles) {
    if (axis == ThetaHAxis::kLinear && deg % 15 != 0) continue;
    const double place = axis == ThetaHAxis::kLinear ? deg / 90.0 : std::sqrt(deg / 90.0);
    ticks.push_back({deg, static_cast<int>(std::lround(place * size))});
  }
  return ticks;
}

std::vector<Tick> theta_d_ticks(int size) {
  return theta_h_ticks(ThetaHAxis::kLinear, size);
}

AxisRoom axis_room(AxisDetail detail, int text_px) {
  const int length = tick_length(text_px);
  if (detail == AxisDetail::kTicks) return {length, 0, 0, length};
  const int number = width_of("90°", text_px);
  return {length + text_px / 3 + number + 5 * text_px / 4, number / 2 + 1, text_px / 2,
          length + text_px / 5 + 9 * text_px / 4};
}

void draw_axes(Canvas& canvas, int x, int y, const SliceOptions& slice, AxisDetail detail, int text_px) {
  draw_theta_h(canvas, x, y + slice.size, slice, detail, text_px);
  draw_theta_d(canvas, x, y, slice, detail, text_px);
}

void draw_region_names(Canvas& canvas, int x, int y, int size, int text_px) {
  const std::string_view left = "specular";
  const std::string_view right = "retroreflection";
  const int margin = text_px / 2;
  const int centre = size / 2;
  const auto style = [&](std::string_view text, AlignX align_x, AlignY align_y, bool upwards) {
    return TextStyle{.size_px = fitting_size(text, text_px, size - 2 * margin),
                     .align_x = align_x,
                     .align_y = align_y,
                     .upwards = upwards};
  };
  outlined_text(canvas, x + centre, y + margin, "Fresnel",
                style("Fresnel", AlignX::kCentre, AlignY::kTop, false));
  outlined_text(canvas, x + centre, y + centre, "diffuse",
                style("diffuse", AlignX::kCentre, AlignY::kCentre, false));
  // Names at the sides are turned where they would run into the one in the middle.
  const bool turned =
      width_of(right, text_px) + width_of("diffuse", text_px) / 2 + 3 * margin > size - centre;
  if (turned) {
    outlined_text(canvas, x + margin, y + centre, left, style(left, AlignX::kCentre, AlignY::kTop, true));
    outlined_text(canvas, x + size - margin, y + centre, right,
                  style(right, AlignX::kCentre, AlignY::kBottom, true));
  } else {
    outlined_text(canvas, x + margin, y + centre, left, style(left, AlignX::kLeft, AlignY::kCentre, false));
    outlined_text(canvas, x + size - margin, y + centre, right,
                  style(right, AlignX::kRight, AlignY::kCentre, false));
  }
}

}  // namespace brdfit::render
