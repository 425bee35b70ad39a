// Rows and their summaries.
#include "cli/result_table.h"

#include <algorithm>
#include <tuple>

#include "brdf/material.h"

namespace brdfit::cli {
namespace {

using io::Json;

const Json& member(const Json& json, const char* key, const std::filesystem::path& file) {
  const auto found = json.is_object() ? json.find(key) : json.end();
  if (!json.is_object() || found == json.end()) {
    throw io::IoError(io::IoError::Side::kInput, file.string(), std::string("lacks \"") + key + "\"",
                      "a result that `brdfit table` wrote");
  }
  return *found;
}

double number(const Json& json, const char* key, const std::filesystem::path& file) {
  const Json& value = member(json, key, file);
  if (!value.is_number()) {
    throw io::IoError(io::IoError::Side::kInput, file.string(), std::string("'") + key + "' is no number",
                      "a result that `brdfit table` wrote");
  }
  return value.get<double>();
}

std::string string(const Json& json, const char* key, const std::filesystem::path& file) {
  const Json& value = member(json, key, file);
  return value.is_string() ? value.get<std::string>() : value.dump();
}

int rank_of(const std::string& model, bool is_published) {
  int rank = is_published ? 1000 : 0;
  for (const Model other : all_models()) {
    if (name_of(other) == model) break;
    ++rank;
  }
  return rank;
}

double median_of(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// Counts for each row of one material whether it is the best.
void count_wins(const std::vector<const ResultRow*>& rivals,
                std::map<std::string, CandidateSummary*>& by_name) {
  if (rivals.size() < 2) return;
  for (std::size_t k = 0; k < kMeasureColumns.size(); ++k) {
    double best = rivals.front()->values[k];
    for (const ResultRow* row : rivals) best = std::min(best, row->values[k]);
    for (const ResultRow* row : rivals) {
      if (row->values[k] == best) ++by_name[row->candidate]->wins[k];
    }
  }
}

CandidateSummary summary_of(const std::string& candidate, const std::vector<const ResultRow*>& rows) {
  CandidateSummary summary;
  summary.candidate = candidate;
  summary.materials = rows.size();
  std::vector<double> values(rows.size());
  for (std::size_t k = 0; k < kMeasureColumns.size(); ++k) {
    std::ranges::transform(rows, values.begin(), [&](const ResultRow* row) { return row->values[k]; });
    summary.mean[k] = mean_of(values);
    summary.median[k] = median_of(values);
  }
  std::ranges::transform(rows, values.begin(), [](const ResultRow* row) { return row->free_parameters; });
  summary.mean_free_parameters = mean_of(values);
  summary.median_free_parameters = median_of(values);
  for (const ResultRow* row : rows) {
    for (const std::string& effect : row->effects) ++summary.effects[effect];
  }
  return summary;
}

HeldOutValues held_out_of(const Json& json, const std::filesystem::path& file) {
  const Json& log_ratio = member(member(json, "table", file), "log_ratio_pct", file);
  HeldOutValues values = {number(log_ratio, "mean", file), number(log_ratio, "deviation", file)};
  const Json& folds = member(json, "folds", file);
  for (const Json& fold : folds) {
    values.free_parameters += number(fold, "free_parameters", file) / static_cast<double>(folds.size());
  }
  return values;
}

}  // namespace

ResultRow row_of_result(const Json& document, const std::filesystem::path& file) {
  const bool is_fit = document.is_object() && document.contains("fit");
  const Json& evidence = is_fit ? document["fit"] : document;
  const Json& material = is_fit ? document : member(document, "material", file);
  const Json& input = member(evidence, "input", file);
  ResultRow row;
  row.file = file.filename().string();
  row.input_name = string(input, "name", file);
  row.input_sha256 = string(input, "sha256", file);
  row.material = std::filesystem::path(row.input_name).stem().string();
  const std::string model = string(material, "model", file);
  row.candidate = model + (is_fit ? "" : " (published)");
  row.rank = rank_of(model, !is_fit);
  row.free_parameters = is_fit ? number(evidence, "free_parameters", file) : 0.0;
  for (std::size_t k = 0; k < kMeasureColumns.size(); ++k) {
    const MeasureColumn& column = kMeasureColumns[k];
    const Json& group = *column.group == '\0' ? evidence : member(evidence, column.group, file);
    row.values[k] = number(group, column.key, file);
  }
  if (evidence.contains("held_out")) row.held_out = held_out_of(evidence["held_out"], file);
  // Finer than effects, where the fit chose among groups of them.
  const Json& effects = evidence.contains("groups") ? evidence["groups"] : member(material, "effects", file);
  for (const Json& effect : effects) {
    if (effect.is_string()) row.effects.push_back(effect.get<std::string>());
  }
  for (const auto& [phase, seconds] : member(evidence, "timings_seconds", file).items()) {
    if (seconds.is_number()) row.phase_seconds.emplace_back(phase, seconds.get<double>());
  }
  return row;
}

void sort_rows(std::vector<ResultRow>& rows) {
  std::ranges::sort(rows, {},
                    [](const ResultRow& row) { return std::tie(row.material, row.rank, row.file); });
}

std::vector<CandidateSummary> summarise(const std::vector<ResultRow>& rows) {
  std::map<std::pair<int, std::string>, std::vector<const ResultRow*>> by_candidate;
  std::map<std::string, std::vector<const ResultRow*>> by_material;
  for (const ResultRow& row : rows) {
    by_candidate[{row.rank, row.candidate}].push_back(&row);
    by_material[row.material].push_back(&row);
  }
  std::vector<CandidateSummary> summaries;
  for (const auto& [key, group] : by_candidate) summaries.push_back(summary_of(key.second, group));
  std::map<std::string, CandidateSummary*> by_name;
  for (CandidateSummary& summary : summaries) by_name[summary.candidate] = &summary;
  for (const auto& [material, rivals] : by_material) count_wins(rivals, by_name);
  return summaries;
}

}  // namespace brdfit::cli
