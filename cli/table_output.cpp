// Formats of a result table.
#include "cli/table_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "cli/common.h"
#include "cli/measure_names.h"
#include "cli/result_text.h"
#include "cli/version.h"
#include "io/atomic_file.h"

namespace brdfit::cli {
namespace {

using io::Json;
using Cells = std::vector<std::string>;
using Rows = std::vector<Cells>;

constexpr const char* kTableFiles[] = {"table.txt", "table.csv", "table.json", "table.md", "timings.csv"};

// The measures side by side, slice|table, as `fit` prints them.
Cells cells_of(const MeasureValues& v) {
  Cells cells;
  for (std::size_t k = 0; k < kMeasures.size(); ++k) {
    cells.push_back(measure_texts(kMeasures[k], v[2 * k], v[2 * k + 1]));
  }
  cells.push_back(sphere_text(v[12]));
  cells.push_back(gap_text(v[13]));
  return cells;
}

Cells heading_of(Cells front) {
  for (const MeasureName& measure : kMeasures) front.emplace_back(measure.title);
  front.emplace_back(kSphereTitle);
  front.emplace_back(kGapTitle);
  return front;
}

Cells joined(Cells front, const Cells& back) {
  front.insert(front.end(), back.begin(), back.end());
  return front;
}

Rows error_rows(const ResultTable& table, const std::vector<CandidateSummary>& summaries) {
  Rows rows;
  for (const ResultRow& row : table.rows) {
    rows.push_back(joined({row.material, row.candidate, fmt::format("{:.0f}", row.free_parameters)},
                          cells_of(row.values)));
  }
  for (const CandidateSummary& s : summaries) {
    rows.push_back(joined(
        {fmt::format("mean of {}", s.materials), s.candidate, fmt::format("{:.1f}", s.mean_free_parameters)},
        cells_of(s.mean)));
  }
  for (const CandidateSummary& s : summaries) {
    rows.push_back(joined({fmt::format("median of {}", s.materials), s.candidate,
                           fmt::format("{:.1f}", s.median_free_parameters)},
                          cells_of(s.median)));
  }
  return rows;
}

Rows win_rows(const std::vector<CandidateSummary>& summaries) {
  Rows rows;
  for (const CandidateSummary& s : summaries) {
    Cells row = {s.candidate};
    for (std::size_t k = 0; k < 12; k += 2) row.push_back(fmt::format("{}|{}", s.wins[k], s.wins[k + 1]));
    row.push_back(std::to_string(s.wins[12]));
    row.push_back(std::to_string(s.wins[13]));
    rows.push_back(std::move(row));
  }
  return rows;
}

Rows effect_rows(const std::vector<CandidateSummary>& summaries) {
  Rows rows;
  for (const CandidateSummary& s : summaries) {
    for (const auto& [effect, count] : s.effects) {
      rows.push_back({s.candidate, effect, fmt::format("{} of {}", count, s.materials)});
    }
  }
  return rows;
}

Rows held_out_rows(const ResultTable& table) {
  Rows rows;
  for (const ResultRow& row : table.rows) {
    if (!row.held_out) continue;
    rows.push_back({row.material, row.candidate, fmt::format("{:.1f}", row.held_out->free_parameters),
                    fmt::format("{:.2f}", row.held_out->log_ratio_pct),
                    fmt::format("{:.2f}", row.held_out->deviation_pct)});
  }
  return rows;
}

// The parts of a table for people, in the form that `format` gives a heading and rows.
std::string describe(const ResultTable& table, const std::string& mark,
                     const std::function<std::string(const Cells&, const Rows&)>& format) {
  const std::vector<CandidateSummary> summaries = summarise(table.rows);
  std::string text = mark + "errors (slice|table)\n\n" +
                     format(heading_of({"material", "candidate", "free"}), error_rows(table, summaries));
  if (!summaries.empty()) {
    text += "\n" + mark + "wins per measure (slice|table)\n\n" +
            format(heading_of({"candidate"}), win_rows(summaries));
  }
  const Rows held_out = held_out_rows(table);
  if (!held_out.empty()) {
    text += "\n" + mark + "errors on blocks of angles that nothing saw, over folds\n\n" +
            format({"material", "candidate", "free", "log-ratio %", "deviation"}, held_out);
  }
  const Rows effects = effect_rows(summaries);
  if (!effects.empty()) {
    text += "\n" + mark + "materials that use each effect\n\n" +
            format({"candidate", "effect", "materials"}, effects);
  }
  if (!table.failures.empty()) {
    text += "\n" + mark + "failed\n\n";
    for (const auto& [file, why] : table.failures) text += fmt::format("- {}: {}\n", file, why);
  }
  return text;
}

std::string markdown_row(const Cells& row) {
  std::string line = "|";
  for (const std::string& cell : row) {
    line += ' ';
    // A bar would end the cell.
    for (const char c : cell) line += c == '|' ? std::string(" / ") : std::string(1, c);
    line += " |";
  }
  return line + "\n";
}

std::string markdown_table(const Cells& heading, const Rows& rows) {
  std::string text = markdown_row(heading) + "|---|";
  for (std::size_t k = 1; k < heading.size(); ++k) text += "---:|";
  text += "\n";
  for (const Cells& row : rows) text += markdown_row(row);
  return text;
}

template <class Values>
Cells plain_cells(const Values& values) {
  Cells cells;
  for (const auto value : values) cells.push_back(fmt::format("{}", value));
  return cells;
}

template <class Values>
Json measures_json(const Values& values) {
  Json json = Json::object();
  for (std::size_t k = 0; k < kMeasureColumns.size(); ++k) json[kMeasureColumns[k].name] = values[k];
  return json;
}

Json row_json(const ResultRow& row) {
  Json json = {{"material", row.material},
               {"candidate", row.candidate},
               {"file", row.file},
               {"input", {{"name", row.input_name}, {"sha256", row.input_sha256}}},
               {"free_parameters", row.free_parameters}};
  json.update(measures_json(row.values));
  if (row.held_out) {
    json["held_out_log_ratio_pct"] = row.held_out->log_ratio_pct;
    json["held_out_deviation_pct"] = row.held_out->deviation_pct;
    json["held_out_free_parameters"] = row.held_out->free_parameters;
  }
  json["effects"] = row.effects;
  return json;
}

Json summary_json(const CandidateSummary& s) {
  Json effects = Json::object();
  for (const auto& [effect, count] : s.effects) effects[effect] = count;
  Json mean = {{"free_parameters", s.mean_free_parameters}};
  mean.update(measures_json(s.mean));
  Json median = {{"free_parameters", s.median_free_parameters}};
  median.update(measures_json(s.median));
  return {{"materials", s.materials},
          {"mean", mean},
          {"median", median},
          {"wins", measures_json(s.wins)},
          {"effects", effects}};
}

double fit_seconds(const ResultRow& row) {
  for (const auto& [phase, seconds] : row.phase_seconds) {
    if (phase == "fit") return seconds;
  }
  return 0.0;
}

// Seconds by candidate, sorted, in the order of the summaries.
std::vector<std::pair<std::string, std::vector<double>>> seconds_by_candidate(const ResultTable& table) {
  std::vector<std::pair<std::string, std::vector<double>>> result;
  for (const CandidateSummary& s : summarise(table.rows)) {
    std::vector<double> seconds;
    for (const ResultRow& row : table.rows) {
      if (row.candidate == s.candidate && fit_seconds(row) > 0.0) seconds.push_back(fit_seconds(row));
    }
    if (seconds.empty()) continue;  // published
    std::ranges::sort(seconds);
    result.emplace_back(s.candidate, std::move(seconds));
  }
  return result;
}

Json timings_json(const ResultTable& table) {
  Json json = Json::array();
  for (const ResultRow& row : table.rows) {
    Json entry = {{"material", row.material}, {"candidate", row.candidate}};
    for (const auto& [phase, seconds] : row.phase_seconds) entry[phase] = seconds;
    json.push_back(entry);
  }
  return json;
}

void write_whole(const std::filesystem::path& file, const std::string& text) {
  io::AtomicFile output(file);
  output.write(text);
  output.commit();
}

}  // namespace

std::string csv_line(const Cells& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    if (&cell != &cells.front()) line += ',';
    if (cell.find_first_of(",\"\r\n") == std::string::npos) {
      line += cell;
      continue;
    }
    line += '"';
    for (const char c : cell) line += c == '"' ? std::string("\"\"") : std::string(1, c);
    line += '"';
  }
  return line + "\n";
}

std::string table_text(const ResultTable& table) {
  return describe(table, "",
                  [](const Cells& heading, const Rows& rows) { return format_table(heading, rows); });
}

std::string table_markdown(const ResultTable& table) {
  return describe(table, "## ", markdown_table);
}

std::string table_csv(const ResultTable& table) {
  Cells heading = {"kind", "material", "candidate", "free_parameters"};
  for (const MeasureColumn& column : kMeasureColumns) heading.emplace_back(column.name);
  heading.emplace_back("effects");
  const bool has_held_out =
      std::ranges::any_of(table.rows, [](const ResultRow& row) { return row.held_out.has_value(); });
  if (has_held_out) heading.emplace_back("held_out_log_ratio_pct");
  std::string text = csv_line(heading);
  const auto add = [&](const Cells& front, const Cells& values, const Cells& effects,
                       const std::optional<HeldOutValues>& held_out = {}) {
    Cells cells = joined(joined(front, values), {fmt::format("{}", fmt::join(effects, ";"))});
    if (has_held_out) cells.push_back(held_out ? fmt::format("{}", held_out->log_ratio_pct) : "");
    text += csv_line(cells);
  };
  for (const ResultRow& row : table.rows) {
    add({"result", row.material, row.candidate, fmt::format("{}", row.free_parameters)},
        plain_cells(row.values), row.effects, row.held_out);
  }
  for (const CandidateSummary& s : summarise(table.rows)) {
    Cells counts;
    for (const auto& [effect, count] : s.effects) counts.push_back(fmt::format("{}={}", effect, count));
    add({"mean", "", s.candidate, fmt::format("{}", s.mean_free_parameters)}, plain_cells(s.mean), {});
    add({"median", "", s.candidate, fmt::format("{}", s.median_free_parameters)}, plain_cells(s.median), {});
    add({"wins", "", s.candidate, ""}, plain_cells(s.wins), counts);
  }
  return text;
}

Json table_json(const ResultTable& table, const Shard& shard) {
  Json json = {{"brdfit_table", 1}, {"version", kVersion}};
  if (!shard.is_whole()) json["shard"] = {{"index", shard.index}, {"count", shard.count}};
  json["rows"] = Json::array();
  for (const ResultRow& row : table.rows) json["rows"].push_back(row_json(row));
  json["summary"] = Json::object();
  for (const CandidateSummary& s : summarise(table.rows)) json["summary"][s.candidate] = summary_json(s);
  json["failures"] = Json::object();
  for (const auto& [file, why] : table.failures) json["failures"][file] = why;
  json["timings_seconds"] = timings_json(table);
  return json;
}

std::string timings_csv(const ResultTable& table) {
  Cells phases;
  for (const ResultRow& row : table.rows) {
    for (const auto& [phase, seconds] : row.phase_seconds) {
      if (std::ranges::find(phases, phase) == phases.end()) phases.push_back(phase);
    }
  }
  std::string text = csv_line(joined({"material", "candidate"}, phases));
  for (const ResultRow& row : table.rows) {
    Cells cells = {row.material, row.candidate};
    for (const std::string& phase : phases) {
      const auto found = std::ranges::find(row.phase_seconds, phase, [](const auto& p) { return p.first; });
      cells.push_back(found == row.phase_seconds.end() ? "" : fmt::format("{}", found->second));
    }
    text += csv_line(cells);
  }
  return text;
}

namespace {

// Mean, median and longest of each candidate's fits, divided by a unit.
std::string seconds_table(const ResultTable& table, double unit, const char* mark, int digits) {
  Rows rows;
  for (const auto& [candidate, seconds] : seconds_by_candidate(table)) {
    double sum = 0.0;
    for (const double s : seconds) sum += s;
    Cells row = {candidate};
    for (const double value :
         {sum / static_cast<double>(seconds.size()), seconds[(seconds.size() - 1) / 2], seconds.back()}) {
      row.push_back(fmt::format("{:.{}f}{}", value / unit, digits, mark));
    }
    rows.push_back(std::move(row));
  }
  return format_table({"candidate", "mean", "median", "longest"}, rows);
}

}  // namespace

std::string timings_text(const ResultTable& table) {
  return "seconds per fit\n\n" + seconds_table(table, 1.0, "", 3);
}

std::string floors_text(const ResultTable& table, double floor_seconds) {
  return fmt::format("time per fit in units of the load floor, {:.1f} ms\n\n", 1e3 * floor_seconds) +
         seconds_table(table, floor_seconds, "x", 2);
}

void write_tables(const std::filesystem::path& folder, const ResultTable& table, const Shard& shard) {
  // First, as it tells that the others are a run's: one that is killed here may be started again.
  io::write_json(folder / "table.json", table_json(table, shard));
  write_whole(folder / "table.txt", table_text(table));
  write_whole(folder / "table.csv", table_csv(table));
  write_whole(folder / "table.md", table_markdown(table));
  write_whole(folder / "timings.csv", timings_csv(table));
}

void require_own_tables(const std::filesystem::path& folder, bool force) {
  if (force) return;
  try {
    // The first to be written: where it is a run's, so are the others.
    const Json json = io::read_json(folder / "table.json");
    if (json.is_object() && json.contains("brdfit_table")) return;
  } catch (const io::IoError&) {
    // Not there, or not ours: then none of the others may be either.
  }
  for (const char* name : kTableFiles) prepare_output(folder / name, force);
}

}  // namespace brdfit::cli
