// One stack: sweep, budget, files.
#include "cli/cost/stack_cost.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "cli/cost/cost_page.h"
#include "cli/cost/pareto.h"
#include "cli/exit_codes.h"
#include "cli/progress.h"
#include "io/sha256.h"
#include "io/stack_source.h"

namespace brdfit::cli {
namespace {

namespace fs = std::filesystem;

fs::path asset_path(const StackCostRequest& request) {
  return request.output / (request.name() + ".realis.json");
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
  options.bake.common.json = false;
  options.bake.common.quiet = true;
  if (write_stack_choice(point, options, request.output) != kDone) {
    throw std::runtime_error("the choice could not be baked: " + point.name);
  }
  return asset_path(request);
}

}  // namespace

std::string StackCostRequest::name() const {
  return io::read_stack_source(sweep.bake.stack).name;
}

void prepare_stack_cost(const StackCostRequest& request) {
  const bool force = request.sweep.bake.common.force;
  const CostPaths paths = cost_paths(request.output, request.name());
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
  write_cost_files(cost_paths(request.output, request.name()), cost.run, cost.json,
                   cost_page(std::span(&cost.run, 1), sentences_of(cost.findings)));
  return cost;
}

}  // namespace brdfit::cli
