// The plot of a choice of effects.
#include "render/ladder_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/plot.h"
#include "render/plot_axis.h"
#include "render/svg.h"

namespace brdfit::render {
namespace {

constexpr double kWidth = 460.0;
constexpr double kLeft = 62.0;
constexpr double kRight = 14.0;
constexpr double kErrorTop = 30.0;
constexpr double kErrorHeight = 170.0;
constexpr double kCostTop = 246.0;
constexpr double kCostHeight = 80.0;
constexpr double kFoot = 42.0;  // rung numbers and their name
constexpr double kErrorAloneHeight = kErrorTop + kErrorHeight + kFoot;
constexpr double kWholeHeight = kCostTop + kCostHeight + kFoot;

constexpr const char* kErrorColour = "#0072b2";
constexpr const char* kCostColour = "#7a5a00";

// One of the two plots.
struct Panel {
  LinearScale scale;
  double top;
  double height;

  double y(double value) const { return top + height * (scale.upper - value) / (scale.upper - scale.lower); }
};

double x_of(std::size_t rung, std::size_t count) {
  const double width = kWidth - kLeft - kRight;
  return kLeft + width * (static_cast<double>(rung) + 0.5) / static_cast<double>(count);
}

void draw_frame(Svg& svg, const Panel& panel, const std::string& name) {
  for (int k = 0; k <= panel.scale.ticks(); ++k) {
    const double y = panel.y(panel.scale.tick(k));
    svg.line({kLeft, y}, {kWidth - kRight, y}, kGridStyle);
    svg.text({kLeft - 6.0, y + 5.0},
             number_label(std::abs(panel.scale.tick(k)) < 1e-12 ? 0.0 : panel.scale.tick(k)),
             R"(text-anchor="end")");
  }
  svg.rect({kLeft, panel.top}, kWidth - kLeft - kRight, panel.height, kFrameStyle);
  svg.text({kLeft, panel.top - 9.0}, name, "");
}

void draw_error(Svg& svg, const Panel& panel, const std::vector<LadderPoint>& points,
                std::optional<double> all_pct) {
  draw_frame(svg, panel, "held-out log-ratio %");
  if (all_pct) {
    const double y = panel.y(*all_pct);
    svg.line({kLeft, y}, {kWidth - kRight, y},
             R"(class="all" stroke="#555" stroke-width="1.5" stroke-dasharray="6 4")");
    svg.text({kWidth - kRight - 4.0, kErrorTop - 9.0}, fmt::format("- - all effects: {:.2f}", *all_pct),
             R"(text-anchor="end" fill="#555")");
  }
  std::vector<SvgPoint> line;
  for (std::size_t k = 0; k < points.size(); ++k) {
    line.emplace_back(x_of(k, points.size()), panel.y(points[k].held_out_pct));
  }
  svg.polyline(line, fmt::format(R"(stroke="{}" stroke-width="2" fill="none")", kErrorColour));
  for (std::size_t k = 0; k < points.size(); ++k) {
    const LadderPoint& point = points[k];
    const double x = line[k].first;
    if (point.standard_error_pct) {
      const double high = panel.y(point.held_out_pct + *point.standard_error_pct);
      const double low = panel.y(point.held_out_pct - *point.standard_error_pct);
      const double cap = 4.0;
      svg.polyline(
          std::vector<SvgPoint>{
              {x - cap, high}, {x + cap, high}, {x, high}, {x, low}, {x - cap, low}, {x + cap, low}},
          fmt::format(R"(class="whisker" stroke="{}" stroke-width="1.5" fill="none")", kErrorColour));
    }
    svg.circle(line[k], 4.0,
               fmt::format(R"(class="{}" stroke="{}" stroke-width="2" fill="{}")",
                           point.is_removal ? "point removed" : "point", kErrorColour,
                           point.is_removal ? "#fff" : kErrorColour),
               fmt::format("{}: {:.2f}%", k, point.held_out_pct));
  }
}

void draw_cost(Svg& svg, const Panel& panel, const std::vector<LadderPoint>& points) {
  draw_frame(svg, panel, "ns per evaluation");
  const double width = std::min(26.0, 0.6 * (kWidth - kLeft - kRight) / static_cast<double>(points.size()));
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!points[k].evaluation_ns) continue;
    const double y = panel.y(*points[k].evaluation_ns);
    svg.rect({x_of(k, points.size()) - 0.5 * width, y}, width, panel.top + panel.height - y,
             fmt::format(R"(class="cost" fill="{}")", kCostColour));
  }
}

void draw_rung_numbers(Svg& svg, double bottom, std::size_t count) {
  // Numbers of two digits stay apart.
  const std::size_t stride = 1 + (count - 1) / 16;
  for (std::size_t k = 0; k < count; k += stride) {
    svg.text({x_of(k, count), bottom + 17.0}, std::to_string(k), R"(text-anchor="middle")");
  }
  svg.text({0.5 * (kLeft + kWidth - kRight), bottom + 36.0}, "rung", R"(text-anchor="middle")");
}

bool is_finite(const std::optional<double>& value) {
  return !value || std::isfinite(*value);
}

bool is_drawable(const LadderPoint& point) {
  return std::isfinite(point.held_out_pct) && is_finite(point.standard_error_pct) &&
         is_finite(point.evaluation_ns);
}

std::string description_of(const std::vector<LadderPoint>& points) {
  return fmt::format("The held-out error goes from {:.2f}% to {:.2f}% in {} steps.",
                     points.front().held_out_pct, points.back().held_out_pct, points.size() - 1);
}

}  // namespace

std::string ladder_plot(const std::string& title, const std::vector<LadderPoint>& points,
                        std::optional<double> all_pct) {
  if (points.empty() || !is_finite(all_pct) || !std::ranges::all_of(points, is_drawable)) return "";
  double smallest = points.front().held_out_pct;
  double largest = smallest;
  double most_ns = 0.0;
  const auto include = [&](double value) {
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  };
  if (all_pct) include(*all_pct);
  for (const LadderPoint& point : points) {
    const double spread = point.standard_error_pct.value_or(0.0);
    include(point.held_out_pct - spread);
    include(point.held_out_pct + spread);
    most_ns = std::max(most_ns, point.evaluation_ns.value_or(0.0));
  }
  const bool has_cost = most_ns > 0.0;
  Svg svg(kWidth, has_cost ? kWholeHeight : kErrorAloneHeight, title, description_of(points));
  svg.rect({0.0, 0.0}, kWidth, has_cost ? kWholeHeight : kErrorAloneHeight, R"(fill="#fff")");
  svg.begin_group(kPlotFont);
  draw_error(svg, {LinearScale::around(smallest, largest), kErrorTop, kErrorHeight}, points, all_pct);
  if (has_cost) draw_cost(svg, {LinearScale::around(0.0, most_ns), kCostTop, kCostHeight}, points);
  draw_rung_numbers(svg, has_cost ? kCostTop + kCostHeight : kErrorTop + kErrorHeight, points.size());
  svg.end_group();
  return svg.finish(false);
}

}  // namespace brdfit::render
