// Ladders for the report.
#include "cli/report_ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cli/json_at.h"
#include "io/image_file.h"
#include "io/material_json.h"
#include "render/difference.h"

namespace brdfit::cli {
namespace {

using io::Json;
using render::ReportLadder;
using render::ReportPicture;
using render::ReportRung;

// The member of the evidence with the errors that the choice went by.
constexpr const char* kErrors = "selection";

// The numbers of all rungs; the first begins with what the evidence calls ladder_start.
std::vector<ReportRung> rungs_of(const Json& evidence) {
  const Json& steps = at(evidence, {"ladder"});
  const std::optional<double> without = number_at(evidence, {kErrors, "without_pct"});
  const std::optional<double> free = number_at(evidence, {"free_parameters"});
  if (!steps.is_array() || !without || !free) return {};
  ReportRung first;
  first.groups = texts_at(evidence, {"ladder_start", "effects"});
  first.held_out_pct = *without;
  first.free_parameters = static_cast<int>(*free);
  std::vector<ReportRung> rungs = {first};
  for (const Json& step : steps) {
    const std::optional<double> after = number_at(step, {"held_out_after_pct"});
    const std::optional<double> parameters = number_at(step, {"parameters"});
    if (!after || !parameters) return {};
    ReportRung rung;
    rung.groups = texts_at(step, {"groups"});
    rung.is_removal = text_at(step, {"action"}) == "removed";
    rung.held_out_pct = *after;
    rung.standard_error_pct = number_at(step, {"standard_error_pct"});
    rung.free_parameters = static_cast<int>(*parameters);  // that it added, so far
    rungs.front().free_parameters -= rung.free_parameters;
    rungs.push_back(std::move(rung));
  }
  for (std::size_t k = 1; k < rungs.size(); ++k) rungs[k].free_parameters += rungs[k - 1].free_parameters;
  const Json& seconds = at(evidence, {"timings_seconds", "evaluation"});
  for (std::size_t k = 0; k < rungs.size() && seconds.is_array() && seconds.size() == rungs.size(); ++k) {
    if (seconds[k].is_number()) rungs[k].evaluation_ns = 1e9 * seconds[k].get<double>();
  }
  return rungs;
}

ReportPicture as_png(const render::Picture& drawn, std::string alt) {
  ReportPicture picture;
  picture.alt = std::move(alt);
  picture.width_px = drawn.width;
  picture.height_px = drawn.height;
  picture.png = io::encode_png({drawn.width, drawn.height, 3, drawn.rgb});
  return picture;
}

std::optional<Material> material_of(const FittedMaterial& fitted, std::size_t rung) {
  const Json& json = rung == 0 ? at(fitted.evidence, {"ladder_start"})
                               : at(at(fitted.evidence, {"ladder"})[rung - 1], {"material"});
  if (!json.is_object()) return std::nullopt;
  try {
    return io::material_from_effects_and_values(fitted.material, json, fitted.file.string(), "fit");
  } catch (const io::IoError&) {
    return std::nullopt;
  }
}

// The bar in a square of the slices' size.
render::Picture in_square(const render::Picture& bar, int size) {
  render::Picture square(size, size);
  square.rgb.assign(square.rgb.size(), 255);
  const int left = std::max(0, (size - bar.width) / 2);
  const int top = std::max(0, (size - bar.height) / 2);
  for (int y = 0; y < std::min(bar.height, size); ++y) {
    const auto from = bar.rgb.begin() + 3 * std::ptrdiff_t{y} * bar.width;
    std::copy_n(from, 3 * std::min(bar.width, size - left),
                square.rgb.begin() + 3 * (std::ptrdiff_t{top + y} * size + left));
  }
  return square;
}

void draw_rungs(const FittedMaterial& fitted, const RungPictures& pictures, ReportLadder& ladder) {
  std::vector<std::optional<render::Image>> slices;
  for (std::size_t k = 0; k < ladder.rungs.size(); ++k) {
    const std::optional<Material> material = material_of(fitted, k);
    slices.emplace_back();
    if (!material) continue;
    slices.back() = render::draw_slice(*material, pictures.slice);
    ladder.rungs[k].slice =
        as_png(render::to_picture(*slices.back(), pictures.view), fmt::format("slice of rung {}", k));
  }
  if (pictures.measured == nullptr) return;
  const render::Image measured = render::draw_slice(*pictures.measured, pictures.slice);
  ladder.measured = as_png(render::to_picture(measured, pictures.view), "measured slice");
  constexpr render::DifferenceKind kKind = render::DifferenceKind::kLogRatio;
  std::vector<render::Difference> differences;
  std::vector<std::size_t> rungs;
  for (std::size_t k = 0; k < slices.size(); ++k) {
    if (!slices[k]) continue;
    differences.push_back(render::difference_of(*slices[k], measured, kKind, pictures.view));
    rungs.push_back(k);
  }
  if (differences.empty()) return;
  const double range = render::difference_range(differences);
  for (std::size_t d = 0; d < differences.size(); ++d) {
    ladder.rungs[rungs[d]].difference =
        as_png(render::difference_picture(differences[d], kKind, range),
               fmt::format("log-ratio of rung {} to the measured slice", rungs[d]));
  }
  const int size = pictures.slice.size;
  ladder.colour_bar = as_png(in_square(render::colour_bar(kKind, range, "", size - 16, 12), size),
                             fmt::format("colours of log-ratios from {:g} to {:g}", -range, range));
}

}  // namespace

std::optional<ReportLadder> report_ladder(const FittedMaterial& fitted, const RungPictures& pictures) {
  ReportLadder ladder;
  ladder.rungs = rungs_of(fitted.evidence);
  if (ladder.rungs.empty()) return std::nullopt;
  ladder.held_out_all_pct = number_at(fitted.evidence, {kErrors, "all_pct"});
  const std::optional<double> all = number_at(fitted.evidence, {kErrors, "free_parameters_all"});
  if (all) ladder.free_parameters_all = static_cast<int>(*all);
  draw_rungs(fitted, pictures, ladder);
  return ladder;
}

}  // namespace brdfit::cli
