// A result table as text, CSV, JSON and Markdown.
#ifndef BRDFIT_CLI_TABLE_OUTPUT_H_
#define BRDFIT_CLI_TABLE_OUTPUT_H_

#include <filesystem>
#include <string>
#include <vector>

#include "cli/result_table.h"
#include "cli/shard.h"
#include "io/json.h"

namespace brdfit::cli {

// A line of a CSV file; cells with commas, quotes or line ends in quotes (RFC 4180).
std::string csv_line(const std::vector<std::string>& cells);

// Errors per material and candidate, mean, median, wins per measure, how often each effect is used, failures.
std::string table_text(const ResultTable& table);
std::string table_markdown(const ResultTable& table);

// One line per material and candidate ("kind" is "result"), then per candidate its mean, median and wins;
// effects are separated by semicolons, and counted in the line of the wins. Numbers round-trip.
std::string table_csv(const ResultTable& table);

// Everything; what changes from run to run is under "timings_seconds". shard: which part of a run it is.
io::Json table_json(const ResultTable& table, const Shard& shard);

// Seconds of every phase of every fit.
std::string timings_csv(const ResultTable& table);
std::string timings_text(const ResultTable& table);
// The same in units of the load floor.
std::string floors_text(const ResultTable& table, double floor_seconds);

// table.txt, table.csv, table.json, table.md and timings.csv. Throws IoError.
void write_tables(const std::filesystem::path& folder, const ResultTable& table, const Shard& shard);

// Throws UsageError when the folder holds a file of one of these names that no run wrote, unless forced.
void require_own_tables(const std::filesystem::path& folder, bool force);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_TABLE_OUTPUT_H_
