// The cost of one measured table from file to files.
#ifndef BRDFIT_CLI_COST_TABLE_COST_H_
#define BRDFIT_CLI_COST_TABLE_COST_H_

#include <filesystem>
#include <optional>
#include <string>

#include "cli/common.h"
#include "cli/cost/budget.h"
#include "cli/cost/cost_files.h"
#include "cli/cost/evaluators.h"
#include "cli/cost/table_sweep.h"

namespace brdfit::cli {

struct TableCostRequest {
  CommonOptions common;
  TableSweepOptions sweep;
  Limits limits;
  std::filesystem::path output;  // folder
  std::string command;           // the line that was typed
};

// What was asked of every table, as one text: see CostProvenance::request.
std::string request_of(const TableCostRequest& request);

struct TableCost {
  CostRun run;
  std::vector<Finding> findings;
  std::optional<BudgetAnswer> budget;
  std::filesystem::path material;  // that the budget was spent on; empty: none
  io::Json json;
};

// Throws UsageError where one of the files that a run would write is there and --force is off.
void prepare_table_cost(const TableCostRequest& request, const std::string& file);

// Sweeps, spends the budget if there are limits, and writes NAME.cost.csv, .html, .json, and the material
// that the budget bought as NAME.MODEL.json. A material is written only when it kept the limits when it was
// measured again as the file holds it. Throws IoError, std::runtime_error when interrupted (then nothing of
// this table is written).
TableCost measure_table_cost(const TableCostRequest& request, const std::string& file,
                             const Evaluators& evaluators);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_TABLE_COST_H_
