// The costs of many tables as quantiles over materials.
#ifndef BRDFIT_CLI_COST_COST_DATABASE_H_
#define BRDFIT_CLI_COST_COST_DATABASE_H_

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/cost/cost_point.h"
#include "io/json.h"

namespace brdfit::cli {

// Over materials.
struct Quantiles {
  double p10 = 0.0;
  double p25 = 0.0;
  double median = 0.0;
  double p75 = 0.0;
  double p90 = 0.0;
};

// One choice over all materials that have it. Ratios are to the default point of the same material, so that
// what makes one material harder than another does not enter.
struct DatabasePoint {
  std::string name;
  std::string sweep;
  std::vector<std::pair<std::string, std::string>> settings;
  std::size_t materials = 0;
  std::optional<Quantiles> error;               // the leading one
  std::optional<Quantiles> accuracy_share_pct;  // of the default point's accuracy; see findings.h
  std::optional<Quantiles> make_ratio;          // of medians of seconds
  std::optional<Quantiles> evaluation_ratio;    // of medians of nanoseconds
  std::size_t on_make_front = 0;                // materials
  std::size_t on_run_front = 0;
};

struct CostDatabase {
  std::string leading_error;
  std::vector<std::string> inputs;
  std::vector<DatabasePoint> points;            // in the order of the first run
  std::map<std::string, std::string> failures;  // why, by file name
};

// Runs of one leading error; those without a default point count for errors and fronts alone.
CostDatabase database_of(std::span<const CostRun> runs);

// What it says: each choice against the default, as median and quartiles, and after how many samples or
// starts nothing improves for nine of ten materials.
std::vector<std::string> database_sentences(const CostDatabase& database, std::span<const CostRun> runs);

std::string database_csv(const CostDatabase& database);

// docs/schema/cost_database.schema.json.
io::Json database_json(const CostDatabase& database, const std::vector<std::string>& sentences);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_COST_DATABASE_H_
