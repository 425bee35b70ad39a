// Polar plots in the plane of incidence.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "render/lobes.h"
#include "render/plot.h"
#include "render/svg.h"

namespace brdfit::render {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// f cos_o of one subject over the view's angle in degrees, negative on the side of the light.
struct PolarPoint {
  double view_deg;
  std::optional<double> value;
};

// Angles of view in even steps.
std::vector<double> even_angles(double step_deg) {
  std::vector<double> angles;
  const auto count = static_cast<int>(std::floor(90.0 / step_deg));
  for (int k = -count; k <= count; ++k) angles.push_back(k * step_deg);
  return angles;
}

// With finer steps about an angle, where a peak is.
std::vector<double> refined(std::vector<double> angles, double centre_deg, double step_deg,
                            double reach_deg) {
  const auto count = static_cast<int>(std::round(reach_deg / step_deg));
  for (int k = -count; k <= count; ++k) angles.push_back(centre_deg + k * step_deg);
  std::erase_if(angles, [](double angle) { return std::abs(angle) >= 90.0; });
  std::sort(angles.begin(), angles.end());
  const auto is_same = [](double a, double b) { return std::abs(a - b) < 1e-9; };
  angles.erase(std::unique(angles.begin(), angles.end(), is_same), angles.end());
  return angles;
}

std::vector<PolarPoint> polar_points(const Subject& subject, double theta_i_deg,
                                     const std::vector<double>& angles, Channel channel) {
  const Vec3 light = {-std::sin(theta_i_deg * kDegree), 0.0, std::cos(theta_i_deg * kDegree)};
  const std::vector<Vec3> wi(angles.size(), light);
  std::vector<Vec3> wo;
  for (const double angle : angles) wo.push_back({std::sin(angle * kDegree), 0.0, std::cos(angle * kDegree)});
  std::vector<Rgb> f_cos_i(angles.size());
  std::vector<PixelState> state(angles.size());
  subject.eval_cos(wi, wo, f_cos_i, state);
  std::vector<PolarPoint> points;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    points.push_back({angles[k], {}});
    if (state[k] != PixelState::kValue) continue;
    points.back().value = channel_value(f_cos_i[k], channel) / light.z * wo[k].z;
  }
  return points;
}

double largest_of(const std::vector<PolarPoint>& points) {
  double largest = 0.0;
  for (const PolarPoint& point : points) largest = std::max(largest, point.value.value_or(0.0));
  return largest;
}

// The next of 1, 2, 5 times a power of ten.
double rounded_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (value <= digit * power * (1.0 + 1e-9)) return digit * power;
  }
  return 10.0 * power;
}

// A half disc: its centre, its radius and the value at its rim.
struct Disc {
  SvgPoint centre;
  double radius;
  double rim;

  SvgPoint at(double angle_deg, double distance) const {
    return {centre.first + distance * std::sin(angle_deg * kDegree),
            centre.second - distance * std::cos(angle_deg * kDegree)};
  }
  double distance(double value) const { return radius * std::sqrt(std::sqrt(std::max(value, 0.0) / rim)); }
};

void draw_ring(Svg& svg, const Disc& disc, double distance, std::string_view style) {
  std::vector<SvgPoint> arc;
  for (int angle = -90; angle <= 90; angle += 2) arc.push_back(disc.at(angle, distance));
  svg.polyline(arc, style);
}

// Rings at the rim and at powers of ten, as far as they can be told apart.
void draw_rings(Svg& svg, const Disc& disc) {
  const auto label = [&](double distance, const std::string& text) {
    svg.text({disc.centre.first + distance, disc.centre.second + 17.0}, text,
             R"(class="ring" font-size="13" fill="#444" text-anchor="middle")");
  };
  draw_ring(svg, disc, disc.radius, kFrameStyle);
  label(disc.radius, number_label(disc.rim));
  auto exponent = static_cast<int>(std::floor(std::log10(disc.rim) + 1e-9));
  double last = disc.radius;
  for (; disc.distance(std::pow(10.0, exponent)) > 0.08 * disc.radius; --exponent) {
    const double distance = disc.distance(std::pow(10.0, exponent));
    if (distance > 0.99 * disc.radius) continue;
    draw_ring(svg, disc, distance, R"(stroke="#ddd" stroke-width="1" fill="none")");
    if (last - distance < 42.0 || distance < 16.0) continue;
    label(distance, power_label(exponent));
    last = distance;
  }
}

void draw_spokes(Svg& svg, const Disc& disc) {
  for (int angle = -90; angle <= 90; angle += 30) {
    svg.line(disc.centre, disc.at(angle, disc.radius), angle % 90 == 0 ? kFrameStyle : kGridStyle);
    const SvgPoint at = disc.at(angle, disc.radius + 8.0);
    const char* anchor = angle < 0 ? "end" : angle > 0 ? "start" : "middle";
    svg.text({at.first, at.second}, fmt::format("{}{}°", angle < 0 ? "−" : "", std::abs(angle)),
             fmt::format(R"(class="spoke" font-size="14" text-anchor="{}")", anchor));
  }
}

// An arrow towards the centre where the light comes from, a dashed line where a mirror would send it.
void draw_light(Svg& svg, const Disc& disc, double theta_i_deg) {
  const SvgPoint tip = disc.at(-theta_i_deg, 0.80 * disc.radius);
  svg.line(disc.at(-theta_i_deg, 1.0 * disc.radius), tip, R"(stroke="#b8860b" stroke-width="3")");
  const Disc about_tip = {tip, 1.0, 1.0};
  const SvgPoint head[] = {about_tip.at(-theta_i_deg + 180.0, 8.0), about_tip.at(-theta_i_deg + 60.0, 7.0),
                           about_tip.at(-theta_i_deg - 60.0, 7.0)};
  svg.polyline(head, R"(fill="#b8860b")");
  svg.line(disc.centre, disc.at(theta_i_deg, disc.radius),
           R"(stroke="#b8860b" stroke-width="1.2" stroke-dasharray="3 3")");
}

void draw_reference(Svg& svg, const Disc& disc, const std::vector<PolarPoint>& points) {
  svg.begin_group(kMeasuredStyle);
  for (const PolarPoint& point : points) {
    if (!point.value) continue;
    svg.circle(disc.at(point.view_deg, disc.distance(*point.value)), 1.9, "",
               fmt::format("{:.4g}°: {:.3g}", point.view_deg, *point.value));
  }
  svg.end_group();
}

void draw_curve(Svg& svg, const Disc& disc, const std::vector<PolarPoint>& points, const std::string& style) {
  std::vector<SvgPoint> piece;
  const auto end_piece = [&] {
    if (piece.size() > 1) svg.polyline(thinned(piece), style);
    piece.clear();
  };
  for (const PolarPoint& point : points) {
    if (point.value) {
      piece.push_back(disc.at(point.view_deg, disc.distance(*point.value)));
    } else {
      end_piece();
    }
  }
  end_piece();
}

void draw_polar(Svg& svg, Disc disc, const MeasuredTable* reference, const std::vector<Curve>& models,
                double theta_i_deg, Channel channel) {
  std::vector<PolarPoint> measured;
  if (reference != nullptr) {
    measured =
        polar_points(*reference, theta_i_deg, refined(even_angles(1.5), theta_i_deg, 0.25, 2.0), channel);
  }
  double largest = largest_of(measured);
  std::vector<std::vector<PolarPoint>> curves;
  const std::vector<double> angles =
      refined(refined(even_angles(0.5), -theta_i_deg, 0.02, 3.0), theta_i_deg, 0.02, 3.0);
  for (const Curve& model : models) {
    curves.push_back(polar_points(model.subject, theta_i_deg, angles, channel));
    largest = std::max(largest, largest_of(curves.back()));
  }
  disc.rim = largest > 0.0 ? rounded_up(largest) : 1.0;

  svg.begin_group(R"(class="polar")");
  svg.symbols({disc.centre.first, disc.centre.second - disc.radius - 32.0},
              fmt::format("θ_i = {:.4g}°", theta_i_deg),
              R"(class="angles" font-weight="bold" text-anchor="middle")");
  draw_rings(svg, disc);
  draw_spokes(svg, disc);
  draw_light(svg, disc, theta_i_deg);
  draw_reference(svg, disc, measured);
  for (std::size_t k = 0; k < curves.size(); ++k) draw_curve(svg, disc, curves[k], model_line_style(k));
  const bool is_unmeasured =
      reference != nullptr &&
      std::none_of(measured.begin(), measured.end(), [](const auto& p) { return p.value.has_value(); });
  std::string note;
  if (largest <= 0.0) note = "no value above 0";
  if (is_unmeasured) note = "no cell in this plane was measured";
  if (!note.empty())
    svg.text({disc.centre.first, disc.centre.second + 36.0}, note,
             R"(class="note" font-size="13" fill="#666" text-anchor="middle")");
  svg.end_group();
}

void check_options(const PolarOptions& options) {
  channel_value({}, options.channel);
  if (options.width_px < 320)
    throw std::invalid_argument("polar plots: the width must be 320 pixels or more");
  if (options.theta_i_deg.empty()) throw std::invalid_argument("polar plots: no theta_i is given");
  for (const double theta_i : options.theta_i_deg) {
    if (theta_i >= 0.0 && theta_i < 90.0) continue;
    throw std::invalid_argument(
        fmt::format("polar plots: theta_i is {} deg; it must be in [0, 90)", theta_i));
  }
}

}  // namespace

std::string polar_plots(const MeasuredTable* reference, const std::vector<Curve>& models,
                        const PolarOptions& options) {
  check_options(options);
  PlotHead head{options.title,
                fmt::format("f cos θ_o in the plane of incidence, {}, sr⁻¹; radius: its fourth root; "
                            "arrow: light, dashes: mirror",
                            name_of(options.channel)),
                reference != nullptr,
                {}};
  for (const Curve& model : models) head.models.push_back(model.label);
  const double width = options.width_px;
  const auto count = static_cast<int>(options.theta_i_deg.size());
  const int columns = count > 1 && options.width_px >= 640 ? 2 : 1;
  const int rows = (count + columns - 1) / columns;
  constexpr double kSide = 50.0, kAbove = 62.0, kBelow = 48.0;
  const double radius = 0.5 * width / columns - kSide;
  const double head_height = head.height(width);
  const double height = head_height + rows * (radius + kAbove + kBelow);
  Svg svg(width, height, options.title.empty() ? "Polar plots" : options.title,
          fmt::format("f cos theta_o over the angle of view, light from the left, {} plots", count));
  svg.rect({0.0, 0.0}, width, height, R"(fill="#fff")");
  svg.begin_group(kPlotFont);
  head.draw(svg, width);
  for (int k = 0; k < count; ++k) {
    const Disc disc = {{(k % columns + 0.5) * width / columns,
                        head_height + k / columns * (radius + kAbove + kBelow) + kAbove + radius},
                       radius,
                       1.0};
    draw_polar(svg, disc, reference, models, options.theta_i_deg[static_cast<std::size_t>(k)],
               options.channel);
  }
  svg.end_group();
  return svg.finish();
}

}  // namespace brdfit::render
