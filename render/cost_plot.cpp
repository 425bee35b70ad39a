// Scatter plots of what choices cost.
#include "render/cost_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>

#include "render/plot.h"
#include "render/plot_axis.h"
#include "render/svg.h"

namespace brdfit::render {
namespace {

constexpr double kWidth = 640.0;
constexpr double kLeft = 66.0;
constexpr double kRight = 18.0;
constexpr double kTop = 34.0;
constexpr double kHeight = 330.0;
constexpr double kFoot = 52.0;  // ticks and the name of the axis
constexpr double kLegendRow = 22.0;
constexpr double kCharacter = 7.6;  // width of one, roughly
constexpr double kRadius = 4.5;

constexpr std::string_view kFont =
    R"(font-family="DejaVu Sans, Arial, sans-serif" font-size="13" fill="#222")";

// Colours that differ for the colour-blind too (Okabe and Ito 2008).
constexpr std::array<const char*, 7> kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                 "#7a5a00", "#56b4e9", "#7a7a7a"};

// Corners of the shapes, with the angle of the first in degrees; 0 corners: a circle.
struct Shape {
  int corners;
  double turn_deg;
  double size;  // so that shapes seem equally large
};
constexpr std::array<Shape, 6> kShapes = {
    {{0, 0.0, 1.0}, {4, 45.0, 1.25}, {3, -90.0, 1.45}, {4, 0.0, 1.4}, {3, 90.0, 1.45}, {5, -90.0, 1.2}}};

// What is taken already, so that numbers find a free place.
struct Box {
  double left;
  double top;
  double right;
  double bottom;

  double overlap(const Box& other) const {
    const double width = std::min(right, other.right) - std::max(left, other.left);
    const double height = std::min(bottom, other.bottom) - std::max(top, other.top);
    return std::max(width, 0.0) * std::max(height, 0.0);
  }
};

// A run of values' ends, with their spreads.
std::pair<double, double> ends_of(const CostPlot& plot, PlotSpread CostPlotPoint::*which) {
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  for (const CostPlotPoint& point : plot.points) {
    smallest = std::min(smallest, (point.*which).low);
    largest = std::max(largest, (point.*which).high);
  }
  return {smallest, largest};
}

// One plot of drawable points.
class Drawing {
 public:
  explicit Drawing(const CostPlot& plot)
      : plot_(plot), across_(axis_of(&CostPlotPoint::cost)), upwards_(axis_of(&CostPlotPoint::error)) {
    for (const CostPlotPoint& point : plot.points) shown_series_.insert(point.series);
    place_legend();
  }

  std::string svg() {
    Svg svg(kWidth, kTop + kHeight + kFoot + legend_height_, plot_.title, description(), "group");
    svg.rect({0.0, 0.0}, kWidth, kTop + kHeight + kFoot + legend_height_, R"(class="paper" fill="#fff")");
    svg.begin_group(kFont);
    draw_axes(svg);
    draw_front(svg);
    draw_points(svg);
    draw_numbers(svg);
    draw_legend(svg);
    svg.end_group();
    return svg.finish(false);
  }

 private:
  PlotAxis axis_of(PlotSpread CostPlotPoint::*which) const {
    const auto [smallest, largest] = ends_of(plot_, which);
    return {smallest, largest, plot_.with_zero};
  }
  double x(double cost) const { return kLeft + (kWidth - kLeft - kRight) * across_.place(cost); }
  double y(double error) const { return kTop + kHeight * (1.0 - upwards_.place(error)); }
  SvgPoint at(const CostPlotPoint& point) const { return {x(point.cost.middle), y(point.error.middle)}; }

  std::string description() const {
    return fmt::format("{} points, {} of them on the front. {}: {} to {}.", plot_.points.size(),
                       front_of(plot_).size(), plot_.error_name,
                       number_label(ends(&CostPlotPoint::error).first),
                       number_label(ends(&CostPlotPoint::error).second));
  }
  std::pair<double, double> ends(PlotSpread CostPlotPoint::*which) const { return ends_of(plot_, which); }

  void draw_axes(Svg& svg) const {
    for (const AxisTick& tick : across_.ticks()) {
      svg.line({x(tick.value), kTop}, {x(tick.value), kTop + kHeight}, grid(tick));
      svg.text({x(tick.value), kTop + kHeight + 18.0}, tick.label, R"(text-anchor="middle")");
    }
    for (const AxisTick& tick : upwards_.ticks()) {
      svg.line({kLeft, y(tick.value)}, {kWidth - kRight, y(tick.value)}, grid(tick));
      svg.text({kLeft - 6.0, y(tick.value) + 4.5}, tick.label, R"(text-anchor="end")");
    }
    svg.rect({kLeft, kTop}, kWidth - kLeft - kRight, kHeight,
             R"(class="frame" stroke="#444" stroke-width="1" fill="none")");
    svg.text({kLeft, kTop - 11.0}, plot_.error_name, "");
    svg.text({0.5 * (kLeft + kWidth - kRight), kTop + kHeight + 40.0}, plot_.cost_name,
             R"(text-anchor="middle")");
  }

  // Of differences, 0 is what everything is compared with.
  std::string grid(const AxisTick& tick) const {
    return plot_.with_zero && tick.value == 0.0 ? R"(class="zero" stroke="#444" stroke-width="1")"
                                                : R"(class="grid" stroke="#ddd" stroke-width="1")";
  }

  // A point's error is what can be had from its cost on, up to that of the next.
  void draw_front(Svg& svg) const {
    std::vector<SvgPoint> line;
    for (const std::size_t k : front_of(plot_)) {
      const SvgPoint next = at(plot_.points[k]);
      if (!line.empty()) line.emplace_back(next.first, line.back().second);
      line.push_back(next);
    }
    if (line.empty()) return;
    line.emplace_back(kWidth - kRight, line.back().second);
    svg.polyline(line,
                 R"(class="front" stroke="#222" stroke-width="1.5" stroke-dasharray="5 3" fill="none")");
  }

  static std::string fill_of(std::size_t series) {
    const std::size_t colour = series % kColours.size();
    return fmt::format(R"(class="series-{}" fill="{}" stroke="{}")", colour, kColours[colour],
                       kColours[colour]);
  }

  static void draw_shape(Svg& svg, const SvgPoint& centre, std::size_t series, double radius) {
    const Shape& shape = kShapes[series % kShapes.size()];
    if (shape.corners == 0) {
      svg.circle(centre, radius, fill_of(series));
      return;
    }
    std::vector<SvgPoint> corners;
    for (int k = 0; k <= shape.corners; ++k) {
      const double angle = (shape.turn_deg + 360.0 * k / shape.corners) * std::numbers::pi / 180.0;
      corners.emplace_back(centre.first + shape.size * radius * std::cos(angle),
                           centre.second + shape.size * radius * std::sin(angle));
    }
    svg.polyline(corners, fill_of(series));
  }

  void draw_spreads(Svg& svg, const CostPlotPoint& point) const {
    const SvgPoint centre = at(point);
    const std::string style = fill_of(point.series) + R"( stroke-width="1.5" stroke-opacity="0.6")";
    if (point.cost.high > point.cost.low) {
      svg.line({x(point.cost.low), centre.second}, {x(point.cost.high), centre.second}, style);
    }
    if (point.error.high > point.error.low) {
      svg.line({centre.first, y(point.error.low)}, {centre.first, y(point.error.high)}, style);
    }
  }

  // Those on the front above the others, which may cover them.
  void draw_points(Svg& svg) const {
    bool is_first = true;
    for (const bool is_on_front : {false, true}) {
      for (const CostPlotPoint& point : plot_.points) {
        if (point.is_on_front != is_on_front) continue;
        svg.begin_group(
            fmt::format(
                R"(class="{}" data-point="{}" data-across="{:.2f}" role="img" tabindex="{}" aria-label="{}")",
                is_on_front ? "point at-front" : "point", xml_escaped(point.key), at(point).first,
                is_first ? 0 : -1, xml_escaped(point.name)),
            point.name);
        is_first = false;
        // What can be pointed at is larger than what is seen; it is also where the focus is shown.
        svg.circle(at(point), kRadius + 5.5,
                   R"(class="reach" fill="none" stroke="none" pointer-events="all")");
        draw_spreads(svg, point);
        if (is_on_front) {
          svg.circle(at(point), kRadius + 3.5,
                     R"(class="ring" fill="none" stroke="#222" stroke-width="1.2")");
        }
        draw_shape(svg, at(point), point.series, kRadius);
        svg.end_group();
      }
    }
  }

  // Each number stands where it covers least.
  void draw_numbers(Svg& svg) const {
    std::vector<Box> taken;
    for (const CostPlotPoint& point : plot_.points) {
      const auto [px, py] = at(point);
      const double r = point.is_on_front ? kRadius + 4.0 : kRadius + 1.0;
      taken.push_back({px - r, py - r, px + r, py + r});
    }
    const std::vector<std::size_t> front = front_of(plot_);
    for (std::size_t n = 0; n < front.size(); ++n) {
      const std::string label = std::to_string(n + 1);
      const Box box =
          free_box(at(plot_.points[front[n]]), 7.2 * static_cast<double>(label.size()) + 2.0, taken);
      taken.push_back(box);
      svg.text({0.5 * (box.left + box.right), box.bottom - 1.5}, label,
               R"(class="number" text-anchor="middle" font-size="12" font-weight="bold")");
    }
  }

  static Box free_box(const SvgPoint& centre, double width, const std::vector<Box>& taken) {
    constexpr double kTall = 12.0;
    const Box inside = {kLeft + 1.0, kTop + 1.0, kWidth - kRight - 1.0, kTop + kHeight - 1.0};
    Box best{};
    double least = std::numeric_limits<double>::infinity();
    for (const double distance : {kRadius + 6.0, kRadius + 16.0, kRadius + 28.0}) {
      for (int k = 0; k < 8; ++k) {
        const double angle = -0.25 * std::numbers::pi * (k + 1);
        const double px = centre.first + (distance + 0.5 * width) * std::cos(angle);
        const double py = centre.second + (distance + 0.3 * kTall) * std::sin(angle);
        const Box box = {px - 0.5 * width, py - 0.5 * kTall, px + 0.5 * width, py + 0.5 * kTall};
        double covered = width * kTall - box.overlap(inside) + 0.3 * distance;
        for (const Box& other : taken) covered += box.overlap(other);
        if (covered >= least) continue;
        least = covered;
        best = box;
      }
    }
    return best;
  }

  void place_legend() {
    double across = kLeft;
    double down = 0.0;
    for (const std::size_t series : shown_series_) {
      const double width =
          32.0 + kCharacter * static_cast<double>(std::max<std::size_t>(plot_.series[series].size(), 3));
      if (across > kLeft && across + width > kWidth - kRight) {
        across = kLeft;
        down += kLegendRow;
      }
      legend_.push_back({series, {across, down}});
      across += width;
    }
    legend_height_ = down + kLegendRow + 4.0;
  }

  void draw_legend(Svg& svg) const {
    const double top = kTop + kHeight + kFoot + 8.0;
    for (const auto& [series, place] : legend_) {
      draw_shape(svg, {place.first + 6.0, top + place.second}, series, kRadius);
      svg.text({place.first + 16.0, top + place.second + 4.5}, plot_.series[series], "");
    }
  }

  const CostPlot& plot_;
  PlotAxis across_;
  PlotAxis upwards_;
  std::set<std::size_t> shown_series_;
  std::vector<std::pair<std::size_t, SvgPoint>> legend_;
  double legend_height_ = 0.0;
};

bool is_finite(const PlotSpread& spread) {
  return std::isfinite(spread.middle) && std::isfinite(spread.low) && std::isfinite(spread.high);
}

}  // namespace

bool is_drawable(const CostPlotPoint& point) {
  return is_finite(point.cost) && is_finite(point.error);
}

std::vector<std::size_t> front_of(const CostPlot& plot) {
  std::vector<std::size_t> front;
  for (std::size_t k = 0; k < plot.points.size(); ++k) {
    if (plot.points[k].is_on_front && is_drawable(plot.points[k])) front.push_back(k);
  }
  std::ranges::stable_sort(front, {}, [&](std::size_t k) {
    return std::pair(plot.points[k].cost.middle, plot.points[k].error.middle);
  });
  return front;
}

std::string cost_plot(const CostPlot& plot) {
  CostPlot drawn = plot;
  std::erase_if(drawn.points, [](const CostPlotPoint& point) { return !is_drawable(point); });
  if (drawn.points.empty()) return "";
  for (const CostPlotPoint& point : drawn.points) {
    if (point.series >= drawn.series.size()) throw std::invalid_argument("cost plot: a series is not there");
  }
  return Drawing(drawn).svg();
}

}  // namespace brdfit::render
