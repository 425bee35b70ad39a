// What all plots share.
#include "render/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace brdfit::render {
namespace {

struct LineLook {
  const char* colour;
  const char* dashes;  // empty: solid
};

constexpr std::array<LineLook, 6> kLooks = {{{"#0072b2", ""},
                                             {"#d55e00", "9 4"},
                                             {"#009e73", "9 3 2 3"},
                                             {"#cc79a7", "2 3"},
                                             {"#7a5a00", "14 4"},
                                             {"#56b4e9", "5 3 2 3 2 3"}}};

constexpr double kMargin = 12.0;
constexpr double kTitleHeight = 30.0;
constexpr double kSubtitleHeight = 24.0;
constexpr double kLegendRow = 24.0;
constexpr double kSample = 38.0;  // length of a line's sample and the gap behind it

// Roughly, as no font is at hand: DejaVu Sans is 0.6 em wide on average.
double text_width(std::string_view text) {
  const auto characters = std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; });
  return 9.3 * static_cast<double>(characters);
}

// From p to the segment from a to b, in pixels.
double distance_to_line(const SvgPoint& p, const SvgPoint& a, const SvgPoint& b) {
  const double dx = b.first - a.first;
  const double dy = b.second - a.second;
  const double squared = dx * dx + dy * dy;
  const double along = (p.first - a.first) * dx + (p.second - a.second) * dy;
  const double share = squared > 0.0 ? std::clamp(along / squared, 0.0, 1.0) : 0.0;
  return std::hypot(p.first - a.first - share * dx, p.second - a.second - share * dy);
}

}  // namespace

std::string model_line_style(std::size_t model) {
  const LineLook& look = kLooks[model % kLooks.size()];
  const std::string dashes =
      *look.dashes == '\0' ? "" : fmt::format(R"( stroke-dasharray="{}")", look.dashes);
  return fmt::format(R"(class="model-{}" stroke="{}" stroke-width="2"{} fill="none" stroke-linejoin="round")",
                     model, look.colour, dashes);
}

std::vector<SvgPoint> thinned(const std::vector<SvgPoint>& points) {
  constexpr double kTolerance = 0.05;
  // More between two kept points would make this slow for no gain.
  constexpr std::size_t kMostDropped = 100;
  std::vector<SvgPoint> kept;
  for (std::size_t k = 0, last = 0; k < points.size(); ++k) {
    bool is_needed = k == 0 || k + 1 == points.size() || k - last > kMostDropped;
    for (std::size_t between = last + 1; !is_needed && between <= k; ++between) {
      is_needed = distance_to_line(points[between], points[last], points[k + 1]) > kTolerance;
    }
    if (!is_needed) continue;
    kept.push_back(points[k]);
    last = k;
  }
  return kept;
}

double channel_value(const Rgb& value, Channel channel) {
  switch (channel) {
    case Channel::kRed:
      return value[0];
    case Channel::kGreen:
      return value[1];
    case Channel::kBlue:
      return value[2];
    case Channel::kLuminance:
      return 0.2126 * value[0] + 0.7152 * value[1] + 0.0722 * value[2];
    case Channel::kRgb:
      break;
  }
  throw std::invalid_argument("a plot shows one channel: red, green, blue or luminance");
}

std::string power_label(int exponent) {
  if (exponent == 0) return "1";
  if (exponent == 1) return "10";
  constexpr std::array<const char*, 10> kDigits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string label = exponent < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) {
    label += kDigits[static_cast<std::size_t>(digit - '0')];
  }
  return label;
}

std::string number_label(double value) {
  const double size = std::abs(value);
  if (size == 0.0 || (size >= 1e-3 && size < 1e4)) return fmt::format("{:.4g}", value);
  const auto exponent = static_cast<int>(std::floor(std::log10(size) + 1e-12));
  const std::string mantissa = fmt::format("{:.3g}", value / std::pow(10.0, exponent));
  return mantissa == "1" ? power_label(exponent) : mantissa + "×" + power_label(exponent);
}

LogScale LogScale::around(double smallest, double largest) {
  LogScale scale;
  scale.lower = static_cast<int>(std::floor(std::log10(smallest) + 1e-9));
  scale.upper = std::max(static_cast<int>(std::ceil(std::log10(largest) - 1e-9)), scale.lower + 1);
  scale.lower = std::max(scale.lower, scale.upper - kMostDecades);
  return scale;
}

double LogScale::place(double value) const {
  return (std::log10(std::max(value, 1e-300)) - lower) / (upper - lower);
}

double PlotHead::text_height() const {
  return kMargin + (title.empty() ? 0.0 : kTitleHeight) + (subtitle.empty() ? 0.0 : kSubtitleHeight);
}

std::vector<PlotHead::Entry> PlotHead::entries(double width) const {
  std::vector<Entry> result;
  double x = kMargin;
  double y = text_height() + 0.5 * kLegendRow;
  const auto add = [&](const std::string& label, int model) {
    const double entry_width = kSample + text_width(label);
    if (x > kMargin && x + entry_width > width) {
      x = kMargin;
      y += kLegendRow;
    }
    result.push_back({{x, y}, label, model});
    x += entry_width + 24.0;
  };
  if (has_reference) add("measured", -1);
  for (std::size_t k = 0; k < models.size(); ++k) add(models[k], static_cast<int>(k));
  return result;
}

double PlotHead::height(double width) const {
  const std::vector<Entry> all = entries(width);
  return all.empty() ? text_height() : all.back().at.second + 0.5 * kLegendRow;
}

void PlotHead::draw(Svg& svg, double width) const {
  double y = kMargin;
  if (!title.empty()) {
    svg.text({kMargin, y + 17.0}, title, R"(font-size="20" font-weight="bold")");
    y += kTitleHeight;
  }
  if (!subtitle.empty()) svg.symbols({kMargin, y + 13.0}, subtitle, R"(fill="#444")");
  for (const Entry& entry : entries(width)) {
    const auto [left, middle] = entry.at;
    if (entry.model < 0) {
      for (const double x : {4.0, 15.0, 26.0}) svg.circle({left + x, middle}, 2.5, R"(fill="#222")");
    } else {
      const std::string style = model_line_style(static_cast<std::size_t>(entry.model));
      svg.line({left, middle}, {left + 30.0, middle}, style.substr(style.find(' ') + 1));
    }
    svg.text({left + kSample, middle + 5.0}, entry.label, "");
  }
}

}  // namespace brdfit::render
