// Reports from result folders.
#include "cli/report_data.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <iterator>
#include <mutex>

#include "cli/json_at.h"
#include "cli/measure_names.h"
#include "cli/report_ladder.h"
#include "cli/result_text.h"
#include "cli/version.h"
#include "io/image_file.h"

namespace brdfit::cli {
namespace {

using io::Json;

constexpr int kRungSize = 128;  // pixels

// The standard errors of a parameter: one number, a list of them, or null.
std::vector<std::optional<double>> standard_errors(const Json& state) {
  const Json& errors = at(state, {"standard_error"});
  const auto number = [](const Json& error) {
    return error.is_number() ? std::optional(error.get<double>()) : std::nullopt;
  };
  std::vector<std::optional<double>> result;
  if (errors.is_number()) result.push_back(number(errors));
  if (errors.is_array()) std::ranges::transform(errors, std::back_inserter(result), number);
  return result;
}

render::ReportParameter report_parameter(const FittedMaterial& fitted, const ParameterInfo& info) {
  render::ReportParameter parameter;
  parameter.name = info.name;
  parameter.help = info.help;
  const Rgb values = fitted.material.colour(info.name);
  parameter.values.assign(values.begin(), values.begin() + info.components);
  parameter.lower = info.lower;
  parameter.upper = info.upper;
  parameter.default_value = info.default_value;
  parameter.srgb8 = srgb_text(fitted.material, info);
  const Json& state = at(fitted.evidence, {"parameters", parameter.name.c_str()});
  parameter.status = text_at(state, {"status"});
  parameter.standard_errors = standard_errors(state);
  parameter.reason = text_at(state, {"reason"});
  return parameter;
}

std::vector<std::pair<std::string, std::string>> provenance_of(const FittedMaterial& fitted) {
  std::vector<std::pair<std::string, std::string>> result;
  const auto add = [&](const char* name, std::initializer_list<const char*> path) {
    const std::string text = text_at(fitted.evidence, path);
    if (!text.empty()) result.emplace_back(name, text);
  };
  result.emplace_back("file", fitted.file.filename().string());
  add("input", {"input", "name"});
  add("SHA-256 of the input", {"input", "sha256"});
  add("values belong to", {"input", "cell"});
  add("values that are not finite", {"input", "non_finite_values"});
  add("brdfit version", {"version"});
  add("command", {"command"});
  add("options", {"options"});
  add("observations", {"observations"});
  add("solver", {"termination"});
  return result;
}

std::vector<render::ReportLoss> losses_of(const Json& evidence) {
  std::vector<render::ReportLoss> losses;
  for (const Json& trial : at(evidence, {"losses"})) {
    const std::optional<double> delta_e = number_at(trial, {"sphere_delta_e"});
    if (delta_e) losses.push_back({text_at(trial, {"loss"}), *delta_e, at(trial, {"kept"}) == true});
  }
  return losses;
}

std::vector<render::ReportCorrelation> correlations_of(const Json& evidence) {
  std::vector<render::ReportCorrelation> pairs;
  for (const Json& pair : at(evidence, {"correlated"})) {
    const std::optional<double> correlation = number_at(pair, {"correlation"});
    if (correlation) pairs.push_back({text_at(pair, {"first"}), text_at(pair, {"second"}), *correlation});
  }
  return pairs;
}

render::ReportPicture report_picture(ComparisonPicture drawn) {
  render::ReportPicture picture;
  picture.caption = drawn.caption;
  picture.alt = drawn.alt;
  if (drawn.svg.empty()) {
    picture.width_px = drawn.picture.width;
    picture.height_px = drawn.picture.height;
    picture.png = io::encode_png({drawn.picture.width, drawn.picture.height, 3, drawn.picture.rgb});
    return picture;
  }
  picture.svg = drawn.svg.substr(drawn.svg.find("<svg"));
  return picture;
}

}  // namespace

render::ReportFit report_fit(const FittedMaterial& fitted) {
  render::ReportFit fit;
  fit.model = title_of(fitted.material.model());
  fit.file = fitted.file.filename().string();
  const Json& evidence = fitted.evidence;
  fit.free_parameters = static_cast<int>(number_at(evidence, {"free_parameters"}).value_or(0.0));
  for (const MeasureName& m : kMeasures) {
    fit.measures.push_back(
        {m.title, number_at(evidence, {"slice", m.key}), number_at(evidence, {"table", m.key})});
  }
  fit.sphere_delta_e = number_at(evidence, {"sphere_delta_e"});
  for (const Effect effect : all_effects()) {
    if (fitted.material.effects().has(effect)) fit.effects.emplace_back(effect_name(effect));
  }
  for (const ParameterInfo& info : parameters_of(fitted.material.model())) {
    if (fitted.material.effects().has(info.effect)) fit.parameters.push_back(report_parameter(fitted, info));
  }
  fit.notes = texts_at(evidence, {"notes"});
  fit.losses = losses_of(evidence);
  fit.correlated = correlations_of(evidence);
  if (const Json& timings = at(evidence, {"timings_seconds"}); timings.is_object()) {
    for (const auto& [phase, seconds] : timings.items()) {
      if (seconds.is_number()) fit.timings_seconds.emplace_back(phase, seconds.get<double>());
    }
  }
  fit.provenance = provenance_of(fitted);
  return fit;
}

render::ReportMaterial report_material(const ResultGroup& group, const ReportOptions& options,
                                       const CommonOptions& common) {
  render::ReportMaterial material;
  material.name = group.name;
  std::string why;
  const std::optional<std::filesystem::path> measured = find_measured(group, options.measured, &why);
  if (!measured) material.warnings.push_back(why);
  std::optional<LoadedSubject> reference;
  std::vector<render::Column> columns;
  if (measured) {
    TableReading reading = options.reading;
    // A table that was fitted leniently, or by its cells' centres, is read like that here.
    const Json& evidence = group.fits.front().evidence;
    reading.lenient |= at(evidence, {"input", "non_finite_values"}).is_number();
    if (text_at(evidence, {"input", "cell"}) == "centre") reading.cell = "centre";
    reference = load_subject(measured->string(), reading, common);
    material.warnings = cell_warnings(reference->table->table);
    columns.push_back({"measured", reference->subject(), reference_lines(reference->table->table)});
  }
  RungPictures rungs = {slice_options_of(options.comparison.slice, kRungSize), options.comparison.view};
  if (reference) {
    rungs.measured = &reference->table->table;
    rungs.slice.grid = rungs.measured->grid();
  }
  for (const FittedMaterial& fitted : group.fits) {
    material.fits.push_back(report_fit(fitted));
    material.fits.back().ladder = report_ladder(fitted, rungs);
    const bool same_model =
        std::ranges::count(group.fits, fitted.material.model(),
                           [](const FittedMaterial& f) { return f.material.model(); }) > 1;
    columns.push_back({same_model ? fitted.file.stem().string() : material.fits.back().model,
                       render::Subject(fitted.material),
                       candidate_lines(fitted.material, reference ? &reference->table->table : nullptr)});
  }
  for (ComparisonPicture& drawn : draw_comparison(group.name, columns, options.comparison)) {
    material.pictures.push_back(report_picture(std::move(drawn)));
  }
  return material;
}

render::Report make_report(const std::filesystem::path& folder, const ReportOptions& options,
                           const std::string& command, const CommonOptions& common) {
  const ResultFolder results = read_results(folder);
  render::Report report;
  report.title =
      folder.filename().empty() ? folder.parent_path().filename().string() : folder.filename().string();
  report.version = kVersion;
  report.command = command;
  report.warnings = results.ignored;
  const std::size_t count = results.groups.size();
  report.materials.resize(count);
  std::mutex mutex;
  std::size_t done = 0;
  // One material at a time per thread, so that no more tables are held than there are threads.
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count, 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t k = range.begin(); k < range.end(); ++k) {
          if (interrupted()) return;
          try {
            // Isolated: a thread that waits within one material must not begin another.
            report.materials[k] = tbb::this_task_arena::isolate(
                [&] { return report_material(results.groups[k], options, common); });
          } catch (const io::IoError& error) {
            report.materials[k].name = results.groups[k].name;
            report.materials[k].warnings.emplace_back(error.what());
          }
          const std::lock_guard lock(mutex);
          say(common, fmt::format("[{}/{}] {}", ++done, count, results.groups[k].name));
        }
      },
      tbb::simple_partitioner());
  if (interrupted()) throw std::runtime_error("interrupted; nothing was written");
  return report;
}

}  // namespace brdfit::cli
