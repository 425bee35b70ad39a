// Tables of errors, parameters and timings.
#include "cli/result_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/ladder_cost.h"
#include "cli/measure_names.h"
#include "io/material_json.h"

namespace brdfit::cli {
namespace {

std::string range_text(const ParameterInfo& info) {
  if (info.components == 3) return fmt::format("[{:g}, {:g}] = (0..255)", info.lower, info.upper);
  return fmt::format("[{:g}, {:g}]", info.lower, info.upper);
}

std::string error_text(const fit::ParameterState& state) {
  std::string text;
  for (const std::optional<double>& error : state.standard_error) {
    if (!text.empty()) text += " ";
    text += error ? fmt::format("{:.2g}", *error) : "-";
  }
  return text;
}

std::string sample_size_text(const fit::SampleSize& size, const fit::FitResult& result) {
  std::vector<std::string> trials;
  for (const fit::SizeTrial& trial : size.trials) {
    trials.push_back(fmt::format("{} ({:.2f}%)", trial.samples, trial.held_out_pct));
  }
  const fit::SizeTrial& last = size.trials.back();
  const std::string tried = fmt::format("cells fitted, with the log-ratio on {} others: {}", size.check_cells,
                                        fmt::join(trials, ", "));
  if (!size.converged) return fmt::format("{}; that still changed, so all {}", tried, result.observations);
  return fmt::format("{}; the last doubling changes it by {:+.3f} +- {:.3f} points", tried, last.change_pct,
                     last.standard_error_pct);
}

std::string held_out_text(const fit::HeldOutEvaluation& held_out) {
  const auto table = [&](double fit::Measures::*measure) {
    return fit::over_folds(held_out, &fit::Evaluation::table, measure);
  };
  double parameters = 0.0;
  for (const fit::HeldOutFold& fold : held_out.folds) {
    parameters += fold.free_parameters / static_cast<double>(held_out.folds.size());
  }
  const fit::MeanAndSpread log_ratio = table(&fit::Measures::log_ratio_pct);
  return fmt::format(
      "held out (blocks of angles, {} folds, everything done again without each): log-ratio {:.2f}% +- "
      "{:.2f}, slice {:.2f}%, relative {:.3f}, with {:.1f} free parameters",
      held_out.folds.size(), log_ratio.mean, log_ratio.deviation, table(&fit::Measures::slice_pct).mean,
      table(&fit::Measures::relative).mean, parameters);
}

std::string floors(double seconds, double floor_seconds) {
  return fmt::format("{:.2f}x", seconds / floor_seconds);
}

}  // namespace

std::string value_text(const Material& material, const ParameterInfo& info) {
  if (info.components == 1) return fmt::format("{:.4g}", material.number(info.name));
  const Rgb c = material.colour(info.name);
  return fmt::format("{:.4f} {:.4f} {:.4f}", c[0], c[1], c[2]);
}

std::string srgb_text(const Material& material, const ParameterInfo& info) {
  if (info.components == 1) return "";
  const Rgb c = material.colour(info.name);
  return fmt::format("({}, {}, {})", io::srgb8_from_linear(c[0]), io::srgb8_from_linear(c[1]),
                     io::srgb8_from_linear(c[2]));
}

std::string format_table(const std::vector<std::string>& heading,
                         const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const std::string& cell : heading) widths.push_back(cell.size());
  for (const auto& row : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
  }
  std::string text;
  const auto add = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t k = 0; k < row.size(); ++k) {
      line += k == 0 ? fmt::format("{:<{}}", row[k], widths[k]) : fmt::format("  {:>{}}", row[k], widths[k]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  };
  add(heading);
  std::vector<std::string> rule;
  for (const std::size_t width : widths) rule.emplace_back(width, '-');
  add(rule);
  for (const auto& row : rows) add(row);
  return text;
}

std::vector<std::string> measure_heading() {
  std::vector<std::string> heading = {"on"};
  for (const MeasureName& measure : kMeasures) heading.emplace_back(measure.title);
  heading.emplace_back(kSphereTitle);
  return heading;
}

std::vector<std::string> measure_cells(const fit::Evaluation& evaluation,
                                       const render::SphereDeltaE& sphere) {
  // One row per model and place would double the table: slice and table stand side by side in each cell.
  std::vector<std::string> cells = {"slice|table"};
  for (const MeasureName& measure : kMeasures) {
    cells.push_back(measure_texts(measure, evaluation.slice.*measure.value, evaluation.table.*measure.value));
  }
  cells.push_back(sphere_text(sphere.mean));
  return cells;
}

std::string format_errors(std::span<const JudgedFit> results) {
  std::vector<std::string> heading = {"model", "free"};
  std::ranges::copy(measure_heading(), std::back_inserter(heading));
  heading.emplace_back(kGapTitle);
  heading.emplace_back("seconds");
  std::vector<std::vector<std::string>> rows;
  for (const JudgedFit& judged : results) {
    const fit::FitResult& result = judged.fit;
    std::vector<std::string> row = {std::string(title_of(result.material.model())),
                                    std::to_string(result.free_parameters)};
    std::ranges::copy(measure_cells(result.evaluation, judged.sphere.delta_e), std::back_inserter(row));
    row.push_back(gap_text(result.evaluation.reciprocity_gap_pct));
    row.push_back(fmt::format("{:.3f}", judged.total_seconds()));
    rows.push_back(std::move(row));
  }
  return format_table(heading, rows);
}

std::string format_parameters(const fit::FitResult& result) {
  std::vector<std::vector<std::string>> rows;
  for (const fit::ParameterState& state : result.parameters) {
    const ParameterInfo& info = *find_parameter(result.material.model(), state.name);
    rows.push_back({state.name, value_text(result.material, info), error_text(state),
                    srgb_text(result.material, info), range_text(info), std::string(name_of(state.status))});
  }
  std::string text =
      std::string(title_of(result.material.model())) + "\n" +
      format_table({"parameter", "value", "+- (std. error)", "8-bit sRGB", "range", "status"}, rows);
  for (const fit::ParameterState& state : result.parameters) {
    if (!state.reason.empty()) text += "  " + state.name + ": " + state.reason + "\n";
  }
  for (const std::string& note : result.notes) text += "  note: " + note + "\n";
  return text;
}

std::string format_evidence(const JudgedFit& judged) {
  std::string text;
  if (judged.fit.sample_size) text += "  " + sample_size_text(*judged.fit.sample_size, judged.fit) + "\n";
  if (judged.held_out) text += "  " + held_out_text(*judged.held_out) + "\n";
  return text;
}

std::string format_ladder(const fit::FitResult& result) {
  const fit::Selection& selection = *result.selection;
  const std::vector<double> costs = ladder_costs(result);
  int parameters = selection.parameters_without;
  std::vector<std::vector<std::string>> rows = {
      {selection.required.empty() ? "Lambert + GGX" : "what is held on",
       fmt::format("{:.2f}", selection.held_out_without.log_ratio_pct), "", std::to_string(parameters),
       fmt::format("{:.1f}", 1e9 * costs[0])}};
  for (std::size_t k = 0; k < selection.ladder.size(); ++k) {
    const fit::LadderStep& step = selection.ladder[k];
    parameters += step.parameters;
    rows.push_back({fmt::format("{}{}", step.removed ? "- " : "+ ", fmt::join(step.groups, ", ")),
                    fmt::format("{:.2f}", step.held_out_after_pct),
                    fmt::format("{:+.2f} +- {:.2f}", step.held_out_after_pct - step.held_out_before_pct,
                                step.standard_error_pct),
                    std::to_string(parameters), fmt::format("{:.1f}", 1e9 * costs[k + 1])});
  }
  rows.push_back({"all", fmt::format("{:.2f}", selection.held_out_all.log_ratio_pct), "",
                  std::to_string(selection.parameters_all), ""});
  return fmt::format(
             "{}: effects by the error on blocks of angles ({} folds, threshold {:g}%), the least of many\n",
             title_of(result.material.model()), selection.held_out.folds_pct.size(),
             100.0 * selection.threshold) +
         format_table({"step", kMeasures[0].title, "difference", "free", "ns"}, rows);
}

std::string format_timings(std::span<const JudgedFit> results, double load_seconds, double floor_seconds,
                           std::size_t peak_bytes) {
  std::vector<std::vector<std::string>> rows;
  for (const JudgedFit& judged : results) {
    const fit::FitTimings& t = judged.fit.timings;
    rows.push_back({std::string(title_of(judged.fit.material.model())),
                    floors(t.sample_seconds, floor_seconds), floors(t.select_seconds, floor_seconds),
                    floors(t.explore_seconds, floor_seconds), floors(t.refine_seconds, floor_seconds),
                    floors(t.evidence_seconds, floor_seconds), floors(t.measure_seconds, floor_seconds),
                    floors(judged.sphere.seconds, floor_seconds),
                    floors(judged.total_seconds(), floor_seconds)});
  }
  return fmt::format(
             "times in units of the load floor, {:.1f} ms (reading and converting the file's bytes); load "
             "{}\n",
             1e3 * floor_seconds, floors(load_seconds, floor_seconds)) +
         format_table(
             {"model", "sample", "select", "explore", "refine", "evidence", "measure", "sphere", "all"},
             rows) +
         fmt::format("peak memory {:.0f} MB\n", static_cast<double>(peak_bytes) / 1e6);
}

}  // namespace brdfit::cli
