// One stack: sweep, budget, files.
#include "cli/cost/stack_cost.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "cli/cost/cost_page.h"
#include "cli/cost/pareto.h"
#include "cli/cost/table_sweep.h"
#include "cli/exit_codes.h"
#include "cli/table_input.h"
#include "io/sha256.h"

namespace brdfit::cli {
namespace {

namespace fs = std::filesystem;

CostPaths paths_of(const StackCostRequest& request) {
  return cost_paths(request.output, base_name(request.sweep.bake.stack));
}

// The asset of a choice takes the stack's own name for files of the sweep, so that both lie side by side.
fs::path asset_path(const StackCostRequest& request) {
  return request.output / (base_name(request.sweep.bake.stack) + ".realis.json");
}

// All that decides what is measured.
std::string request_of(const StackCostRequest& request) {
  const BakeArguments& bake = request.sweep.bake;
  const io::Json json = {{"quick", request.sweep.quick},
                         {"repeats", request.sweep.repeats},
                         {"device", request.sweep.device},
                         {"leading_error", request.leading_error},
                         {"transfer", bake.transfer},
                         {"base", bake.base},
                         {"model", bake.model},
                         {"gains", bake.gains},
                         {"folds", bake.folds},
                         {"sample", bake.sample_texels},
                         {"memory", bake.memory_mib},
                         {"seed", bake.seed}};
  return io::sha256_of_text(json.dump());
}

fs::path write_asset(const StackCostRequest& request, const CostPoint& point) {
  StackSweepOptions options = request.sweep;
  options.bake.name = base_name(request.sweep.bake.stack);
  options.bake.common.json = false;
  options.bake.common.quiet = true;
  if (write_stack_choice(point, options, request.output) != kDone) {
    throw std::runtime_error("the choice could not be baked: " + point.name);
  }
  return asset_path(request);
}

}  // namespace

void prepare_stack_cost(const StackCostRequest& request) {
  const bool force = request.sweep.bake.common.force;
  const CostPaths paths = paths_of(request);
  for (const fs::path& path : {paths.csv, paths.json, paths.html}) prepare_output(path, force);
  if (request.limits.any()) prepare_output(asset_path(request), force);
}

StackCost measure_stack_cost(const StackCostRequest& request) {
  const CostProvenance provenance = {io::sha256_of_file(request.sweep.bake.stack), request_of(request),
                                     request.command};
  StackCost cost;
  cost.run = sweep_stack(request.sweep);
  if (request.leading_error != cost.run.leading_error) {
    cost.run.leading_error = request.leading_error;
    mark_fronts(cost.run);
  }
  cost.findings = findings_of(cost.run);
  cost.json = cost_json(cost.run, provenance, cost.findings);
  if (request.limits.any()) {
    cost.budget = spend(request.limits, cost.run,
                        [&](const CostPoint& point) { return measure_stack_choice(point, request.sweep); });
    stop_if_interrupted();
    if (cost.budget->point) cost.asset = write_asset(request, cost.run.points[*cost.budget->point]);
    cost.json["budget"] = budget_json(*cost.budget, request.limits, cost.run, cost.asset.filename().string());
  }
  stop_if_interrupted();
  write_cost_files(paths_of(request), cost.run, cost.json,
                   cost_page(std::span(&cost.run, 1), sentences_of(cost.findings)));
  return cost;
}

}  // namespace brdfit::cli
