// Comparison pictures and the lines below their columns.
#include "cli/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "cli/measure_names.h"
#include "cli/result_text.h"
#include "fit/metrics.h"
#include "measured/symmetry.h"
#include "render/delta_e.h"
#include "render/lobes.h"

namespace brdfit::cli {
namespace {

using render::Column;

std::string words(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '_', ' ');
  return text;
}

std::string names_of(std::span<const Column> columns) {
  std::string names;
  for (const Column& column : columns) names += (names.empty() ? "" : ", ") + column.title;
  return names;
}

// A seam in a sphere of a table is explained by this.
std::string asymmetry_line(const MeasuredTable& table) {
  return fmt::format("φd against 180° − φd\t{:.1f}%", mirror_asymmetry_pct(table));
}

// Columns without the lines, for pictures that stand below the first.
std::vector<Column> bare(std::span<const Column> columns) {
  std::vector<Column> result(columns.begin(), columns.end());
  for (Column& column : result) {
    column.lines.clear();
    const MeasuredTable* table = column.subject.table();
    if (table != nullptr) column.lines.push_back(asymmetry_line(*table));
  }
  return result;
}

// The reference's table, and the others as curves. Without a table every column is a curve.
struct Curves {
  const MeasuredTable* table = nullptr;
  std::vector<render::Curve> models;
};

Curves curves_of(std::span<const Column> columns) {
  Curves curves;
  curves.table = columns.front().subject.table();
  for (const Column& column : columns.subspan(curves.table != nullptr ? 1 : 0)) {
    curves.models.push_back({column.title, column.subject});
  }
  return curves;
}

}  // namespace

bool ComparisonOptions::has(const std::string& picture) const {
  return pictures.empty() || std::ranges::find(pictures, picture) != pictures.end();
}

std::vector<ComparisonPicture> draw_comparison(const std::string& title, std::span<const Column> columns,
                                               const ComparisonOptions& options) {
  if (columns.empty()) throw std::invalid_argument("draw_comparison: nothing to draw");
  render::PanelOptions panel;
  panel.title = title;
  panel.view = options.view;
  panel.range = options.range;
  panel.regions = options.slice.regions;
  const std::vector<Column> plain = bare(columns);
  const std::string of = fmt::format(" of {}: {}", title, names_of(columns));
  std::vector<ComparisonPicture> result;
  const auto add = [&](const char* name, const std::string& caption) -> ComparisonPicture& {
    return result.emplace_back(ComparisonPicture{name, caption, caption + of, {}, ""});
  };
  if (options.has("slices")) {
    const render::SliceOptions slice = slice_options_of(options.slice, options.slice_size);
    panel.difference = options.difference.value_or(render::DifferenceKind::kLogRatio);
    add("slices", fmt::format("BRDF slices at φd = {:g}°, and differences", slice.phi_d_deg)).picture =
        render::slice_panel(columns, slice, panel);
  }
  panel.difference = options.difference.value_or(render::DifferenceKind::kSigned);
  if (options.has("spheres")) {
    add("spheres", "Spheres with the light at 0°, 90°, 120° and 140°, and differences").picture =
        render::sphere_panel(plain, render::Shape::kSphere, render::kLightAnglesDeg, options.sphere_size,
                             panel);
  }
  if (options.has("patches")) {
    add("patches", "Flat patches turned half-way to the light, and differences").picture =
        render::sphere_panel(plain, render::Shape::kPatch, render::kLightAnglesDeg, options.sphere_size,
                             panel);
  }
  if (options.has("environments")) {
    add("environments", "Spheres in a uniform and in a gradient environment, and differences").picture =
        render::environment_panel(plain, options.sphere_size, panel);
  }
  const Curves curves = curves_of(columns);
  const render::Channel channel =
      options.view.channel == render::Channel::kRgb ? render::Channel::kLuminance : options.view.channel;
  if (options.has("lobes")) {
    render::LobeOptions lobes;
    lobes.title = title;
    lobes.phi_d_deg = options.slice.phi_d_deg;
    lobes.channel = channel;
    add("lobes", "f over θh at fixed θd, logarithmic").svg =
        render::lobe_plots(curves.table, curves.models, lobes);
  }
  if (options.has("polar")) {
    render::PolarOptions polar;
    polar.title = title;
    polar.channel = channel;
    add("polar", "f cos θo in the plane of incidence").svg =
        render::polar_plots(curves.table, curves.models, polar);
  }
  return result;
}

std::vector<std::string> material_lines(const Material& material) {
  std::vector<std::string> lines;
  std::string effects;
  for (const Effect effect : all_effects()) {
    if (material.effects().has(effect)) effects += (effects.empty() ? "" : ", ") + words(effect_name(effect));
  }
  if (effects_of(material.model()) != Effects())
    lines.push_back("effects: " + (effects.empty() ? "none" : effects));
  for (const ParameterInfo& info : parameters_of(material.model())) {
    if (!material.effects().has(info.effect)) continue;
    lines.push_back(
        fmt::format("{}\t{}", words(info.name),
                    info.components == 1 ? value_text(material, info) : srgb_text(material, info)));
  }
  return lines;
}

std::vector<std::string> reference_lines(const MeasuredTable& reference) {
  const auto counts = reference.state_counts();
  std::vector<std::string> lines = {
      fmt::format("cells measured\t{} of {}", reference.valid_count(), reference.grid().cell_count()),
      fmt::format("largest f\t{:.4g}", reference.largest())};
  const auto add = [&](const char* name, CellState state) {
    const std::size_t count = counts[static_cast<std::size_t>(state)];
    if (count > 0) lines.push_back(fmt::format("{}\t{}", name, count));
  };
  lines.push_back(asymmetry_line(reference));
  add("cells with NaN or infinity", CellState::kNotFinite);
  add("cells partly negative", CellState::kNegative);
  return lines;
}

std::vector<std::string> candidate_lines(const render::Subject& candidate, const MeasuredTable* reference) {
  std::vector<std::string> lines;
  const bool comparable = reference != nullptr &&
                          (candidate.table() == nullptr || candidate.table()->grid() == reference->grid());
  if (comparable) {
    const fit::Evaluation e = candidate.material() != nullptr
                                  ? fit::evaluate(*candidate.material(), *reference)
                                  : fit::evaluate(*candidate.table(), *reference);
    lines.emplace_back("error\tslice | table");
    for (const MeasureName& measure : kMeasures) {
      lines.push_back(std::string(measure.title) + "\t" +
                      measure_texts(measure, e.slice.*measure.value, e.table.*measure.value, " | "));
    }
    lines.push_back(std::string(kSphereTitle) + "\t" +
                    sphere_text(render::SphereJudge(*reference)(candidate).mean));
  }
  if (candidate.material() == nullptr) return lines;
  if (!lines.empty()) lines.emplace_back();
  std::ranges::copy(material_lines(*candidate.material()), std::back_inserter(lines));
  return lines;
}

}  // namespace brdfit::cli
