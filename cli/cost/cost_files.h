// A sweep as CSV and JSON.
#ifndef BRDFIT_CLI_COST_COST_FILES_H_
#define BRDFIT_CLI_COST_COST_FILES_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/cost/budget.h"
#include "cli/cost/cost_point.h"
#include "cli/cost/findings.h"
#include "io/json.h"

namespace brdfit::cli {

// Where a run came from.
struct CostProvenance {
  std::string sha256;   // of the input
  std::string request;  // of what was asked: two runs with the same did the same
  std::string command;  // the line that was typed
};

// One line per point: name, sweep, the settings and the errors by their names, times with their quartiles,
// repeats and units of the reference, bytes, memory, the fronts; then what is the same in every line: input,
// leading_error, the reference. Empty where a figure was not measured. Numbers round-trip.
std::string cost_csv(const CostRun& run);

// docs/schema/cost.schema.json. What changes from run to run is in the members make_seconds, evaluation_ns,
// reference_seconds, peak_mib, the fronts, the sentences and the budget.
io::Json cost_json(const CostRun& run, const CostProvenance& provenance,
                   const std::vector<Finding>& findings);

// The member "budget".
io::Json budget_json(const BudgetAnswer& answer, const Limits& limits, const CostRun& run,
                     const std::string& material);

// The run of a file that cost_json() was written to, and where it came from. Throws IoError (kInput).
CostRun read_cost_run(const std::filesystem::path& file, CostProvenance* provenance);

// NAME.cost.csv, .json and, where the page is not empty, .html below a folder.
struct CostPaths {
  std::filesystem::path csv;
  std::filesystem::path json;
  std::filesystem::path html;
};
CostPaths cost_paths(const std::filesystem::path& folder, const std::string& name);

// Each is written as a whole or not at all, the JSON last. Throws IoError (kOutput).
void write_cost_files(const CostPaths& paths, const CostRun& run, const io::Json& json,
                      const std::string& page);

// Writes a text as a whole or not at all. Throws IoError (kOutput).
void write_whole(const std::filesystem::path& file, const std::string& text);

// The points of both fronts as a table for people.
std::string fronts_text(const CostRun& run);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_COST_FILES_H_
