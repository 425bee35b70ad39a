// Formats of a sweep.
#include "cli/cost/cost_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/cost/error_keys.h"
#include "cli/cost/pareto.h"
#include "cli/result_text.h"
#include "cli/table_output.h"
#include "cli/version.h"
#include "io/atomic_file.h"

namespace brdfit::cli {
namespace {

using io::Json;
using Cells = std::vector<std::string>;

// The names of pairs over all points, in the order in which they are met.
template <class Value>
Cells keys_of(const CostRun& run, std::vector<std::pair<std::string, Value>> CostPoint::*pairs) {
  Cells keys;
  for (const CostPoint& point : run.points) {
    for (const auto& [key, value] : point.*pairs) {
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
    }
  }
  return keys;
}

std::string number_cell(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

void add_time_heading(const std::string& name, Cells& cells) {
  for (const char* part : {"", "_low", "_high", "_repeats", "_units"}) cells.push_back(name + part);
}

void add_time(const RepeatedTime& time, Cells& cells) {
  if (!time.is_measured()) {
    cells.insert(cells.end(), 5, "");
    return;
  }
  for (const double value : {time.median, time.low_quartile, time.high_quartile}) {
    cells.push_back(number_cell(value));
  }
  cells.push_back(std::to_string(time.repeats));
  cells.push_back(number_cell(time.units));
}

Json time_json(const RepeatedTime& time) {
  return {{"median", time.median},
          {"low_quartile", time.low_quartile},
          {"high_quartile", time.high_quartile},
          {"repeats", time.repeats},
          {"units", time.units}};
}

void add_number(const char* key, double value, Json& json) {
  if (std::isfinite(value)) json[key] = value;
}

void add_time(const char* key, const RepeatedTime& time, Json& json) {
  if (time.is_measured()) json[key] = time_json(time);
}

Json point_json(const CostPoint& point) {
  Json json = {{"name", point.name}, {"sweep", point.sweep}};
  json["settings"] = Json::object();
  for (const auto& [key, value] : point.settings) json["settings"][key] = value;
  json["errors"] = Json::object();
  for (const auto& [key, value] : point.errors) add_number(key.c_str(), value, json["errors"]);
  add_time("make_seconds", point.make_seconds, json);
  add_time("evaluation_ns", point.evaluation_ns, json);
  add_number("bytes", point.bytes, json);
  add_number("peak_mib", point.peak_mib, json);
  add_number("free_numbers", point.free_numbers, json);
  add_number("observations", point.observations, json);
  json["on_make_front"] = point.on_make_front;
  json["on_run_front"] = point.on_run_front;
  return json;
}

// Reads what point_json() wrote; Json's own errors are turned into IoError by the caller.
RepeatedTime time_from_json(const Json& json, const char* key) {
  if (!json.contains(key)) return {};
  const Json& time = json.at(key);
  return {time.at("median"), time.at("low_quartile"), time.at("high_quartile"), time.at("repeats"),
          time.at("units")};
}

double number_from_json(const Json& json, const char* key) {
  return json.contains(key) ? json.at(key).get<double>() : kNotMeasured;
}

CostPoint point_from_json(const Json& json) {
  CostPoint point;
  point.name = json.at("name");
  point.sweep = json.at("sweep");
  for (const auto& [key, value] : json.at("settings").items()) point.settings.emplace_back(key, value);
  for (const auto& [key, value] : json.at("errors").items()) point.errors.emplace_back(key, value);
  point.make_seconds = time_from_json(json, "make_seconds");
  point.evaluation_ns = time_from_json(json, "evaluation_ns");
  point.bytes = number_from_json(json, "bytes");
  point.peak_mib = number_from_json(json, "peak_mib");
  point.free_numbers = number_from_json(json, "free_numbers");
  point.observations = number_from_json(json, "observations");
  point.on_make_front = json.at("on_make_front");
  point.on_run_front = json.at("on_run_front");
  return point;
}

CostRun run_from_json(const Json& json, CostProvenance* provenance) {
  CostRun run;
  run.kind = json.at("kind");
  run.input = json.at("input").at("name");
  run.leading_error = json.at("leading_error");
  run.notes = json.at("notes");
  run.reference_seconds = time_from_json(json, "reference_seconds");
  for (const Json& point : json.at("points")) run.points.push_back(point_from_json(point));
  if (provenance != nullptr) {
    *provenance = {json.at("input").at("sha256"), json.at("request"), json.at("command")};
    if (json.at("version") != kVersion) provenance->request.clear();
  }
  return run;
}

Json figures_json(const CostPoint& point) {
  Json json = point_json(point);
  for (const char* key : {"name", "sweep", "settings", "on_make_front", "on_run_front"}) json.erase(key);
  return json;
}

Json limits_json(const Limits& limits) {
  Json json = Json::object();
  const auto add = [&](const char* key, const std::optional<double>& limit) {
    if (limit) json[key] = *limit;
  };
  add("evaluation_ns", limits.evaluation_ns);
  add("bytes", limits.bytes);
  add("make_seconds", limits.make_seconds);
  add("error", limits.error);
  return json;
}

Cells row_of(const CostPoint& point, const CostRun& run) {
  const auto figure = [](double value, const char* form) {
    return std::isfinite(value) ? fmt::format(fmt::runtime(form), value) : std::string("-");
  };
  const auto time = [](const RepeatedTime& t, double scale) {
    if (!t.is_measured()) return std::string("-");
    return fmt::format("{:.3g} ({:.3g}-{:.3g})", scale * t.median, scale * t.low_quartile,
                       scale * t.high_quartile);
  };
  return {point.name,
          figure(error_of(point, run.leading_error), "{:.3g}"),
          time(point.make_seconds, 1e3),
          time(point.evaluation_ns, 1.0),
          figure(point.bytes, "{:g}"),
          figure(point.peak_mib, "{:.0f}"),
          point.on_make_front ? "*" : "",
          point.on_run_front ? "*" : ""};
}

}  // namespace

std::string cost_csv(const CostRun& run) {
  const Cells settings = keys_of(run, &CostPoint::settings);
  const Cells errors = keys_of(run, &CostPoint::errors);
  Cells heading = {"name", "sweep"};
  heading.insert(heading.end(), settings.begin(), settings.end());
  heading.insert(heading.end(), errors.begin(), errors.end());
  add_time_heading("make_seconds", heading);
  add_time_heading("evaluation_ns", heading);
  for (const char* name : {"bytes", "peak_mib", "free_numbers", "observations", "on_make_front",
                           "on_run_front", "kind", "input", "leading_error"}) {
    heading.emplace_back(name);
  }
  add_time_heading("reference_seconds", heading);
  std::string text = csv_line(heading);
  for (const CostPoint& point : run.points) {
    Cells cells = {point.name, point.sweep};
    for (const std::string& key : settings) cells.push_back(setting_of(point, key));
    for (const std::string& key : errors) cells.push_back(number_cell(error_of(point, key)));
    add_time(point.make_seconds, cells);
    add_time(point.evaluation_ns, cells);
    for (const double value : {point.bytes, point.peak_mib, point.free_numbers, point.observations}) {
      cells.push_back(number_cell(value));
    }
    cells.emplace_back(point.on_make_front ? "1" : "0");
    cells.emplace_back(point.on_run_front ? "1" : "0");
    for (const std::string& same : {run.kind, run.input, run.leading_error}) cells.push_back(same);
    add_time(run.reference_seconds, cells);
    text += csv_line(cells);
  }
  return text;
}

Json cost_json(const CostRun& run, const CostProvenance& provenance, const std::vector<Finding>& findings) {
  Json json = {{"brdfit_cost", 1},
               {"version", kVersion},
               {"command", provenance.command},
               {"kind", run.kind},
               {"input", {{"name", run.input}, {"sha256", provenance.sha256}}},
               {"request", provenance.request},
               {"leading_error", run.leading_error},
               {"notes", run.notes},
               {"sentences", Json::array()}};
  for (const Finding& finding : findings) {
    json["sentences"].push_back(
        {{"about", finding.about}, {"text", finding.text}, {"points", finding.points}});
  }
  add_time("reference_seconds", run.reference_seconds, json);
  json["points"] = Json::array();
  for (const CostPoint& point : run.points) json["points"].push_back(point_json(point));
  return json;
}

Json budget_json(const BudgetAnswer& answer, const Limits& limits, const CostRun& run,
                 const std::string& material) {
  Json json = {{"limits", limits_json(limits)}, {"kept", answer.point.has_value()}};
  json["trials"] = Json::array();
  for (const BudgetTrial& trial : answer.trials) {
    json["trials"].push_back({{"point", run.points[trial.point].name},
                              {"kept", trial.excess.empty()},
                              {"again", figures_json(trial.again)}});
  }
  if (answer.point) {
    json["point"] = run.points[*answer.point].name;
    if (!material.empty()) json["material"] = material;
  } else {
    json["nearest"] = run.points[answer.nearest].name;
  }
  return json;
}

CostRun read_cost_run(const std::filesystem::path& file, CostProvenance* provenance) {
  const Json json = io::read_json(file);
  try {
    return run_from_json(json, provenance);
  } catch (const Json::exception&) {
    throw io::IoError(io::IoError::Side::kInput, file.string(), "is not what brdfit cost writes",
                      "a file of docs/schema/cost.schema.json");
  }
}

CostPaths cost_paths(const std::filesystem::path& folder, const std::string& name) {
  const auto path = [&](const char* ending) { return folder / (name + ".cost." + ending); };
  return {path("csv"), path("json"), path("html")};
}

void write_whole(const std::filesystem::path& file, const std::string& text) {
  io::AtomicFile out(file);
  out.write(text);
  out.commit();
}

void write_cost_files(const CostPaths& paths, const CostRun& run, const Json& json, const std::string& page) {
  write_whole(paths.csv, cost_csv(run));
  if (!page.empty()) write_whole(paths.html, page);
  io::write_json(paths.json, json);
}

std::string fronts_text(const CostRun& run) {
  std::vector<Cells> rows;
  for (const std::size_t k : by_cost(run.points, &CostPoint::on_run_front, evaluation_ns_of)) {
    rows.push_back(row_of(run.points[k], run));
  }
  for (const std::size_t k : by_cost(run.points, &CostPoint::on_make_front, make_seconds_of)) {
    if (!run.points[k].on_run_front) rows.push_back(row_of(run.points[k], run));
  }
  return format_table(
      {"point", error_title(run.leading_error), run.kind == "stack" ? "ms to bake" : "ms to fit",
       "ns an evaluation", "bytes", "peak MiB", "making", "run time"},
      rows);
}

}  // namespace brdfit::cli
