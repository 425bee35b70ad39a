// A plot of shares with their intervals.
#include "bench/detection_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "bench/detection_trials.h"
#include "render/plot.h"

namespace brdfit::bench {
namespace {

using render::kFrameStyle;
using render::kGridStyle;
using render::Svg;
using render::SvgPoint;

constexpr double kWidth = 720.0;
constexpr double kLeft = 76.0;
constexpr double kPlotWidth = kWidth - kLeft - 24.0;
constexpr double kPlotHeight = 300.0;
constexpr double kBelow = 62.0;  // ticks and the axis' name
constexpr double kAbove = 30.0;  // names of the marked strengths
constexpr double kNormal = 1.959963985;

struct Frame {
  double top;
  render::LogScale scale;

  double x(double strength) const { return kLeft + kPlotWidth * scale.place(strength); }
  double y(double share) const { return top + kPlotHeight * (1.0 - share); }
};

void draw_axes(Svg& svg, const Frame& frame) {
  for (int percent = 0; percent <= 100; percent += 25) {
    const double y = frame.y(0.01 * percent);
    svg.line({kLeft, y}, {kLeft + kPlotWidth, y}, kGridStyle);
    svg.text({kLeft - 8.0, y + 5.0}, fmt::format("{}%", percent), R"(text-anchor="end")");
  }
  for (const double strength : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0}) {
    const double x = frame.x(strength);
    svg.line({x, frame.top}, {x, frame.top + kPlotHeight}, kGridStyle);
    svg.text({x, frame.top + kPlotHeight + 20.0}, render::number_label(strength), R"(text-anchor="middle")");
  }
  svg.text({kLeft + 0.5 * kPlotWidth, frame.top + kPlotHeight + 46.0},
           "rise of the held-out error without it, in units of the threshold", R"(text-anchor="middle")");
  const SvgPoint at = {20.0, frame.top + 0.5 * kPlotHeight};
  svg.text(
      at, "found",
      fmt::format("text-anchor=\"middle\" transform=\"rotate(-90 {:.2f} {:.2f})\"", at.first, at.second));
}

// What is asked of the choice lies to the right of the second.
void draw_marks(Svg& svg, const Frame& frame) {
  const auto mark = [&](double strength, std::string_view name) {
    const double x = frame.x(strength);
    svg.line({x, frame.top}, {x, frame.top + kPlotHeight}, R"(stroke="#444" stroke-dasharray="3 4")");
    svg.text({x, frame.top - 8.0}, name, R"(text-anchor="middle" font-size="14")");
  };
  mark(1.0, "threshold");
  mark(3.0, "3 × threshold");
}

// Intervals beside each other rather than one on the other.
void draw_curve(Svg& svg, const Frame& frame, const Curve& curve, std::size_t index, std::size_t count) {
  const std::string style = render::model_line_style(index);
  const double aside = 7.0 * (static_cast<double>(index) - 0.5 * static_cast<double>(count - 1));
  std::vector<SvgPoint> points;
  for (const Share& bin : curve.bins) {
    if (bin.n == 0) continue;
    const double x = frame.x(std::sqrt(bin.from * bin.to)) + aside;
    points.emplace_back(x, frame.y(bin.share()));
    // Solid, whatever the curve is.
    std::string bar = style.substr(style.find("stroke="));
    bar = bar.substr(0, bar.find("stroke-")) + R"(stroke-width="1.5")";
    svg.line({x, frame.y(bin.lower())}, {x, frame.y(bin.upper())}, bar);
    svg.circle(points.back(), 3.5, bar + R"( fill="#fff")", fmt::format("{} of {}", bin.found, bin.n));
  }
  svg.polyline(points, style);
}

}  // namespace

double Share::middle() const {
  if (n == 0) return 0.5;
  const double z2 = kNormal * kNormal;
  return (share() + 0.5 * z2 / n) / (1.0 + z2 / n);
}

double Share::half() const {
  if (n == 0) return 0.5;
  const double z2 = kNormal * kNormal;
  return kNormal / (1.0 + z2 / n) * std::sqrt(share() * (1.0 - share()) / n + 0.25 * z2 / n / n);
}

std::string detection_picture(const std::vector<Curve>& curves) {
  render::PlotHead head{"How often an effect is found, by its strength", "bars: 95% intervals", false, {}};
  for (const Curve& curve : curves) head.models.push_back(curve.name);
  const Frame frame = {head.height(kWidth) + kAbove, render::LogScale::around(kLeastStrength, kMostStrength)};
  const double height = frame.top + kPlotHeight + kBelow;
  Svg svg(kWidth, height, head.title,
          "The share of trials in which the choice of effects found a group, over the group's strength");
  svg.rect({0.0, 0.0}, kWidth, height, R"(fill="#fff")");
  svg.begin_group(render::kPlotFont);
  head.draw(svg, kWidth);
  draw_axes(svg, frame);
  draw_marks(svg, frame);
  for (std::size_t k = 0; k < curves.size(); ++k) draw_curve(svg, frame, curves[k], k, curves.size());
  svg.rect({kLeft, frame.top}, kPlotWidth, kPlotHeight, kFrameStyle);
  svg.end_group();
  return svg.finish();
}

}  // namespace brdfit::bench
