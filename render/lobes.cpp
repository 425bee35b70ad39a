// Lobes over theta_h, on a logarithmic scale.
#include "render/lobes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "brdf/half_diff.h"
#include "render/plot.h"
#include "render/svg.h"

namespace brdfit::render {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr int kSteps = 900;  // of a curve, even on the square-root axis: 0.0001 deg wide at the peak
// Closer to the horizon f cos / cos says nothing.
constexpr double kLowestCosine = 1e-6;

// f at a theta_h in degrees.
struct LobePoint {
  double theta_h_deg;
  std::optional<double> f;  // nothing where it is not defined
};

struct Lobe {
  double theta_d_deg;
  double phi_d_deg;
  std::vector<LobePoint> measured;             // valid cells above the horizon
  std::vector<std::vector<LobePoint>> models;  // by curve
};

double on_axis(double theta_h_deg) {
  return std::sqrt(theta_h_deg / 90.0);
}

// f of a model along theta_h. It is the mean of f(wi, wo) and f(wo, wi), which a table does not tell apart.
std::vector<LobePoint> model_lobe(const Subject& subject, double theta_d_deg, double phi_d_deg,
                                  Channel channel) {
  std::vector<LobePoint> points;
  std::vector<Vec3> wi, wo;
  for (int k = 0; k <= kSteps; ++k) {
    const double root = static_cast<double>(k) / kSteps;
    points.push_back({90.0 * root * root, {}});
    const auto pair = directions_from_half_diff(
        {points.back().theta_h_deg * kDegree, theta_d_deg * kDegree, phi_d_deg * kDegree});
    wi.push_back(pair.wi);
    wo.push_back(pair.wo);
  }
  std::vector<Rgb> there(points.size()), back(points.size());
  std::vector<PixelState> state(points.size());
  subject.eval_cos(wi, wo, there, state);
  subject.eval_cos(wo, wi, back, state);
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (state[k] != PixelState::kValue || std::min(wi[k].z, wo[k].z) < kLowestCosine) continue;
    points[k].f =
        0.5 * (channel_value(there[k], channel) / wi[k].z + channel_value(back[k], channel) / wo[k].z);
  }
  return points;
}

std::vector<LobePoint> measured_lobe(const MeasuredTable& table, int i_theta_d, int i_phi_d,
                                     Channel channel) {
  std::vector<LobePoint> points;
  for (int i = 0; i < table.grid().n_theta_h; ++i) {
    const std::size_t cell = table.grid().index(i, i_theta_d, i_phi_d);
    const auto pair = directions_from_half_diff(table.grid().angles(i, i_theta_d, i_phi_d));
    if (!table.is_valid(cell) || std::min(pair.wi.z, pair.wo.z) < kLowestCosine) continue;
    points.push_back({table.grid().theta_h_rad(i) / kDegree, channel_value(table.value(cell), channel)});
  }
  return points;
}

int nearest_theta_d(const Grid& grid, double theta_d_deg) {
  int best = 0;
  const auto distance = [&](int i) { return std::abs(grid.theta_d_rad(i) / kDegree - theta_d_deg); };
  for (int i = 1; i < grid.n_theta_d; ++i) {
    if (distance(i) < distance(best)) best = i;
  }
  return best;
}

int nearest_phi_d(const Grid& grid, double phi_d_deg) {
  int best = 0;
  const auto distance = [&](int i) {
    const double turns = (grid.phi_d_rad(i) / kDegree - phi_d_deg) / 180.0;
    return std::abs(turns - std::round(turns));
  };
  for (int i = 1; i < grid.n_phi_d; ++i) {
    if (distance(i) < distance(best) - 1e-12) best = i;
  }
  return best;
}

Lobe make_lobe(const MeasuredTable* reference, const std::vector<Curve>& models, double theta_d_deg,
               double phi_d_deg, Channel channel) {
  Lobe lobe{theta_d_deg, phi_d_deg, {}, {}};
  if (reference != nullptr) {
    const Grid& grid = reference->grid();
    const int i_theta_d = nearest_theta_d(grid, theta_d_deg);
    const int i_phi_d = nearest_phi_d(grid, phi_d_deg);
    lobe.theta_d_deg = grid.theta_d_rad(i_theta_d) / kDegree;
    lobe.phi_d_deg = grid.phi_d_rad(i_phi_d) / kDegree;
    lobe.measured = measured_lobe(*reference, i_theta_d, i_phi_d, channel);
  }
  for (const Curve& model : models) {
    lobe.models.push_back(model_lobe(model.subject, lobe.theta_d_deg, lobe.phi_d_deg, channel));
  }
  return lobe;
}

// The smallest and the largest positive f of some points; {infinity, 0} if there is none.
struct Extent {
  double smallest = std::numeric_limits<double>::infinity();
  double largest = 0.0;

  void add(const std::vector<LobePoint>& points) {
    for (const LobePoint& point : points) {
      if (!point.f || *point.f <= 0.0) continue;
      smallest = std::min(smallest, *point.f);
      largest = std::max(largest, *point.f);
    }
  }
};

// Shows every measured value and every peak; models that run away below the measured values are cut after two
// decades.
LogScale common_scale(const std::vector<Lobe>& lobes) {
  Extent measured, models;
  for (const Lobe& lobe : lobes) {
    measured.add(lobe.measured);
    for (const auto& points : lobe.models) models.add(points);
  }
  const double largest = std::max(measured.largest, models.largest);
  if (largest <= 0.0) return {-3, 0};
  const double smallest = measured.largest > 0.0 ? std::max(std::min(measured.smallest, models.smallest),
                                                            0.01 * measured.smallest)
                                                 : models.smallest;
  return LogScale::around(smallest, largest);
}

// One plot's place in the picture.
struct Box {
  double left;
  double top;
  double width;
  double height;

  double x(double theta_h_deg) const { return left + width * on_axis(theta_h_deg); }
  double y(double place) const { return top + height * (1.0 - place); }
};

void draw_theta_h_axis(Svg& svg, const Box& box) {
  const double bottom = box.top + box.height;
  for (const int degrees : {0, 1, 5, 10, 20, 30, 45, 60, 90}) {
    const double x = box.x(degrees);
    svg.line({x, box.top}, {x, bottom}, kGridStyle);
    svg.text({x, bottom + 19.0}, fmt::format("{}°", degrees),
             R"(class="x-tick" font-size="14" text-anchor="middle")");
  }
  svg.symbols({box.left + 0.5 * box.width, bottom + 40.0}, "θ_h (square-root axis)",
              R"(text-anchor="middle")");
}

void draw_value_tick(Svg& svg, const Box& box, double place, const std::string& label) {
  const double y = box.y(place);
  svg.line({box.left, y}, {box.left + box.width, y}, kGridStyle);
  svg.text({box.left - 7.0, y + 5.0}, label, R"(class="y-tick" font-size="14" text-anchor="end")");
}

void draw_value_axis(Svg& svg, const Box& box, const LogScale& scale) {
  const int decades = scale.upper - scale.lower;
  // Labels need about 26 pixels each.
  const int step = 1 + static_cast<int>(26.0 * decades / box.height);
  for (int exponent = scale.lower; exponent <= scale.upper; ++exponent) {
    const double value = std::pow(10.0, exponent);
    if ((exponent - scale.lower) % step == 0) {
      draw_value_tick(svg, box, scale.place(value),
                      decades > 2 ? power_label(exponent) : number_label(value));
    }
    if (exponent == scale.upper || decades > 5) continue;
    for (int digit = 2; digit <= 9; ++digit) {
      const double y = box.y(scale.place(digit * value));
      const bool is_labelled = decades <= 2 && (digit == 2 || digit == 5);
      if (is_labelled) draw_value_tick(svg, box, scale.place(digit * value), number_label(digit * value));
      svg.line({box.left, y}, {box.left + 4.0, y}, kFrameStyle);
    }
  }
  const SvgPoint at = {box.left - 56.0, box.top + 0.5 * box.height};
  svg.text(
      at, "f (sr⁻¹)",
      fmt::format("text-anchor=\"middle\" transform=\"rotate(-90 {:.2f} {:.2f})\"", at.first, at.second));
}

// Cells below the scale (0 among them) are marked at its lower end, so that they are not lost.
int draw_measured(Svg& svg, const Box& box, const LogScale& scale, const std::vector<LobePoint>& points) {
  int below = 0;
  svg.begin_group(kMeasuredStyle);
  for (const LobePoint& point : points) {
    const double x = box.x(point.theta_h_deg);
    const double place = scale.place(*point.f);
    if (place < 0.0) {
      const double y = box.y(0.0);
      const SvgPoint triangle[] = {{x - 3.0, y - 6.0}, {x + 3.0, y - 6.0}, {x, y}, {x - 3.0, y - 6.0}};
      svg.polyline(triangle, R"(class="below" fill="#fff" stroke="#222" stroke-width="1")");
      ++below;
      continue;
    }
    svg.circle({x, box.y(place)}, 2.2, "", fmt::format("{:.3g}°: {:.3g}", point.theta_h_deg, *point.f));
  }
  svg.end_group();
  return below;
}

// A curve in pieces: it ends where f is not defined, and at the scale's lower end.
void draw_curve(Svg& svg, const Box& box, const LogScale& scale, const std::vector<LobePoint>& points,
                const std::string& style) {
  std::vector<SvgPoint> piece;
  const auto end_piece = [&] {
    if (piece.size() > 1) svg.polyline(thinned(piece), style);
    piece.clear();
  };
  std::optional<SvgPoint> last;  // x in pixels and place on the scale, also below it
  for (const LobePoint& point : points) {
    if (!point.f) {
      end_piece();
      last.reset();
      continue;
    }
    const SvgPoint here = {box.x(point.theta_h_deg), scale.place(*point.f)};
    if (last && (last->second < 0.0) != (here.second < 0.0)) {
      const double share = last->second / (last->second - here.second);
      piece.emplace_back(last->first + share * (here.first - last->first), box.y(0.0));
    }
    if (here.second < 0.0) {
      end_piece();
    } else {
      piece.emplace_back(here.first, box.y(here.second));
    }
    last = here;
  }
  end_piece();
}

void draw_lobe(Svg& svg, const Box& box, const LogScale& scale, const Lobe& lobe, bool has_reference) {
  svg.begin_group(R"(class="lobe")");
  svg.symbols({box.left, box.top - 9.0},
              fmt::format("θ_d = {:.4g}°,  φ_d = {:.4g}°", lobe.theta_d_deg, lobe.phi_d_deg),
              R"(class="angles" font-weight="bold")");
  draw_theta_h_axis(svg, box);
  draw_value_axis(svg, box, scale);
  const int below = draw_measured(svg, box, scale, lobe.measured);
  for (std::size_t k = 0; k < lobe.models.size(); ++k) {
    draw_curve(svg, box, scale, lobe.models[k], model_line_style(k));
  }
  svg.rect({box.left, box.top}, box.width, box.height, kFrameStyle);
  std::string note;
  if (has_reference && lobe.measured.empty()) note = "no cell of this row was measured";
  if (below > 0) note = fmt::format("▽ {} cells below the scale, or 0", below);
  if (!note.empty())
    svg.text({box.left + box.width - 8.0, box.top + 19.0}, note,
             R"(class="note" font-size="13" fill="#666" text-anchor="end")");
  svg.end_group();
}

void check_options(const LobeOptions& options) {
  channel_value({}, options.channel);
  if (options.width_px < 320) throw std::invalid_argument("lobe plots: the width must be 320 pixels or more");
  if (options.theta_d_deg.empty()) throw std::invalid_argument("lobe plots: no theta_d is given");
  for (const double theta_d : options.theta_d_deg) {
    if (theta_d >= 0.0 && theta_d < 90.0) continue;
    throw std::invalid_argument(fmt::format("lobe plots: theta_d is {} deg; it must be in [0, 90)", theta_d));
  }
  if (!std::isfinite(options.phi_d_deg)) throw std::invalid_argument("lobe plots: phi_d is not finite");
}

}  // namespace

std::string lobe_plots(const MeasuredTable* reference, const std::vector<Curve>& models,
                       const LobeOptions& options) {
  check_options(options);
  std::vector<Lobe> lobes;
  for (const double theta_d_deg : options.theta_d_deg) {
    lobes.push_back(make_lobe(reference, models, theta_d_deg, options.phi_d_deg, options.channel));
  }
  const LogScale scale = common_scale(lobes);

  PlotHead head{options.title,
                fmt::format("f over θ_h at fixed θ_d, {}", name_of(options.channel)),
                reference != nullptr,
                {}};
  for (const Curve& model : models) head.models.push_back(model.label);
  const double width = options.width_px;
  const int columns = lobes.size() > 1 && options.width_px >= 640 ? 2 : 1;
  const auto rows = (static_cast<int>(lobes.size()) + columns - 1) / columns;
  constexpr double kLeft = 74.0, kRight = 18.0, kTop = 34.0, kBottom = 54.0;
  const double plot_width = width / columns - kLeft - kRight;
  const double plot_height = std::max(0.66 * plot_width, 180.0);
  const double head_height = head.height(width);
  Svg svg(width, head_height + rows * (plot_height + kTop + kBottom),
          options.title.empty() ? "Lobes over theta_h" : options.title,
          fmt::format("f in sr^-1 over theta_h on a logarithmic scale, {} plots", lobes.size()));
  svg.rect({0.0, 0.0}, width, head_height + rows * (plot_height + kTop + kBottom), R"(fill="#fff")");
  svg.begin_group(kPlotFont);
  head.draw(svg, width);
  for (int k = 0; k < static_cast<int>(lobes.size()); ++k) {
    const Box box = {k % columns * (width / columns) + kLeft,
                     head_height + k / columns * (plot_height + kTop + kBottom) + kTop, plot_width,
                     plot_height};
    draw_lobe(svg, box, scale, lobes[static_cast<std::size_t>(k)], reference != nullptr);
  }
  svg.end_group();
  return svg.finish();
}

}  // namespace brdfit::render
