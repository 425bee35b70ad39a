// The cost of one light stack from manifest to files.
#ifndef BRDFIT_CLI_COST_STACK_COST_H_
#define BRDFIT_CLI_COST_STACK_COST_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/cost/budget.h"
#include "cli/cost/cost_files.h"
#include "cli/cost/stack_sweep.h"

namespace brdfit::cli {

struct StackCostRequest {
  StackSweepOptions sweep;  // its bake has the stack and the common options
  std::string leading_error = kStackLeadingError;
  Limits limits;
  std::filesystem::path output;  // folder
  std::string command;           // the line that was typed

  // Of the files that are written: the stack's, as `brdfit bake` has it. Throws IoError.
  std::string name() const;
};

struct StackCost {
  CostRun run;
  std::vector<Finding> findings;
  std::optional<BudgetAnswer> budget;
  std::filesystem::path asset;  // that the budget was spent on; empty: none
  io::Json json;
};

// Throws UsageError where one of the files that a run would write is there and --force is off.
void prepare_stack_cost(const StackCostRequest& request);

// Sweeps, spends the budget if there are limits, and writes NAME.cost.csv, .html, .json, and what the budget
// bought as `brdfit bake` writes it. A choice is baked only when it kept the limits when it was measured
// again. Throws as sweep_stack().
StackCost measure_stack_cost(const StackCostRequest& request);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_STACK_COST_H_
