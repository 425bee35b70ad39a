// Quantiles over materials.
#include "cli/cost/cost_database.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/cost/findings.h"
#include "cli/cost/paired_timing.h"
#include "cli/cost/pareto.h"
#include "cli/table_output.h"
#include "cli/version.h"

namespace brdfit::cli {
namespace {

using io::Json;
using Cells = std::vector<std::string>;

constexpr double kMostMaterials = 0.9;

const CostPoint* default_of(const CostRun& run) {
  const auto found = std::ranges::find(run.points, "default", &CostPoint::sweep);
  return found == run.points.end() ? nullptr : &*found;
}

std::optional<Quantiles> quantiles_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return std::nullopt;
  const auto at = [&](double q) { return quantile_of(values, q); };
  return Quantiles{at(0.1), at(0.25), at(0.5), at(0.75), at(0.9)};
}

// What is collected of one choice before its quantiles are taken.
struct Collected {
  DatabasePoint point;
  std::vector<double> errors;
  std::vector<double> shares;
  std::vector<double> make_ratios;
  std::vector<double> evaluation_ratios;

  void add(const CostPoint& of, const CostPoint* base, const std::string& leading_error) {
    const double error = error_of(of, leading_error);
    ++point.materials;
    point.on_make_front += of.on_make_front ? 1 : 0;
    point.on_run_front += of.on_run_front ? 1 : 0;
    errors.push_back(error);
    if (base == nullptr) return;
    shares.push_back(accuracy_share_pct(error, error_of(*base, leading_error)));
    make_ratios.push_back(make_seconds_of(of) / make_seconds_of(*base));
    evaluation_ratios.push_back(evaluation_ns_of(of) / evaluation_ns_of(*base));
  }

  DatabasePoint finish() {
    point.error = quantiles_of(errors);
    point.accuracy_share_pct = quantiles_of(shares);
    point.make_ratio = quantiles_of(make_ratios);
    point.evaluation_ratio = quantiles_of(evaluation_ratios);
    return point;
  }
};

std::string range(const Quantiles& q, const char* form) {
  return fmt::format("{} ({} to {})", fmt::format(fmt::runtime(form), q.median),
                     fmt::format(fmt::runtime(form), q.p25), fmt::format(fmt::runtime(form), q.p75));
}

// The value after which nothing improves for nine of ten materials, for sweeps of numbers.
std::optional<double> common_plateau(std::span<const CostRun> runs, const std::string& sweep) {
  std::vector<double> values;
  for (const CostRun& run : runs) {
    if (const std::optional<Plateau> plateau = plateau_of(run, sweep)) values.push_back(plateau->value);
  }
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  const auto enough =
      static_cast<std::size_t>(std::ceil(kMostMaterials * static_cast<double>(values.size())));
  return values[enough - 1];
}

constexpr std::pair<const char*, std::optional<Quantiles> DatabasePoint::*> kColumns[] = {
    {"error", &DatabasePoint::error},
    {"accuracy_share_pct", &DatabasePoint::accuracy_share_pct},
    {"make_ratio", &DatabasePoint::make_ratio},
    {"evaluation_ratio", &DatabasePoint::evaluation_ratio}};
constexpr std::pair<const char*, double Quantiles::*> kQuantiles[] = {{"p10", &Quantiles::p10},
                                                                      {"p25", &Quantiles::p25},
                                                                      {"median", &Quantiles::median},
                                                                      {"p75", &Quantiles::p75},
                                                                      {"p90", &Quantiles::p90}};

}  // namespace

CostDatabase database_of(std::span<const CostRun> runs) {
  CostDatabase database;
  std::vector<Collected> all;
  for (const CostRun& run : runs) {
    database.leading_error = run.leading_error;
    database.inputs.push_back(run.input);
    const CostPoint* base = default_of(run);
    for (const CostPoint& point : run.points) {
      auto found = std::ranges::find(all, point.name, [](const Collected& one) { return one.point.name; });
      if (found == all.end()) {
        all.emplace_back();
        found = std::prev(all.end());
        found->point.name = point.name;
        found->point.sweep = point.sweep;
        found->point.settings = point.settings;
      }
      found->add(point, base, run.leading_error);
    }
  }
  for (Collected& one : all) database.points.push_back(one.finish());
  return database;
}

std::vector<std::string> database_sentences(const CostDatabase& database, std::span<const CostRun> runs) {
  std::vector<std::string> sentences;
  const auto base = std::ranges::find(database.points, "default", &DatabasePoint::sweep);
  if (base == database.points.end()) return sentences;
  for (const std::string sweep : {"samples", "starts"}) {
    if (const std::optional<double> value = common_plateau(runs, sweep)) {
      sentences.push_back(
          fmt::format("After {:g} {} nothing improves by more than {:g}%, for {:g}% of the {} materials.",
                      *value, sweep, 100.0 * kNoImprovement, 100.0 * kMostMaterials, runs.size()));
    }
  }
  for (const DatabasePoint& point : database.points) {
    if (!point.accuracy_share_pct || point.sweep == "default" || point.sweep == "device") continue;
    std::string text = fmt::format("{} reaches {}% of the accuracy of {}", point.name,
                                   range(*point.accuracy_share_pct, "{:.0f}"), base->name);
    if (point.evaluation_ratio)
      text += fmt::format(" at {}x its run-time cost", range(*point.evaluation_ratio, "{:.2f}"));
    if (point.make_ratio) text += fmt::format(" and {}x its time to fit", range(*point.make_ratio, "{:.2f}"));
    sentences.push_back(text + fmt::format(": median and quartiles over {} materials.", point.materials));
  }
  return sentences;
}

std::string database_csv(const CostDatabase& database) {
  Cells heading = {"name", "sweep", "materials"};
  for (const auto& [column, member] : kColumns) {
    for (const auto& [quantile, value] : kQuantiles)
      heading.push_back(fmt::format("{}_{}", column, quantile));
  }
  heading.emplace_back("on_make_front");
  heading.emplace_back("on_run_front");
  heading.emplace_back("leading_error");
  std::string text = csv_line(heading);
  for (const DatabasePoint& point : database.points) {
    Cells cells = {point.name, point.sweep, std::to_string(point.materials)};
    for (const auto& [column, member] : kColumns) {
      const std::optional<Quantiles>& quantiles = point.*member;
      for (const auto& [quantile, value] : kQuantiles) {
        cells.push_back(quantiles ? fmt::format("{}", (*quantiles).*value) : "");
      }
    }
    cells.push_back(std::to_string(point.on_make_front));
    cells.push_back(std::to_string(point.on_run_front));
    cells.push_back(database.leading_error);
    text += csv_line(cells);
  }
  return text;
}

Json database_json(const CostDatabase& database, const std::vector<std::string>& sentences) {
  Json json = {
      {"brdfit_cost_database", 1}, {"version", kVersion},    {"leading_error", database.leading_error},
      {"inputs", database.inputs}, {"sentences", sentences}, {"points", Json::array()},
      {"failures", Json::object()}};
  for (const DatabasePoint& point : database.points) {
    Json entry = {{"name", point.name}, {"sweep", point.sweep}, {"settings", Json::object()}};
    for (const auto& [key, value] : point.settings) entry["settings"][key] = value;
    entry["materials"] = point.materials;
    for (const auto& [column, member] : kColumns) {
      if (!(point.*member)) continue;
      for (const auto& [quantile, value] : kQuantiles) entry[column][quantile] = (*(point.*member)).*value;
    }
    entry["on_make_front"] = point.on_make_front;
    entry["on_run_front"] = point.on_run_front;
    json["points"].push_back(std::move(entry));
  }
  for (const auto& [file, why] : database.failures) json["failures"][file] = why;
  return json;
}

}  // namespace brdfit::cli
