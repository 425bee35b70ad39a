// One table: sweep, budget, files.
#include "cli/cost/table_cost.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "cli/cost/cost_page.h"
#include "cli/cost/paired_timing.h"
#include "cli/fit_request.h"
#include "cli/result_json.h"
#include "cli/table_input.h"
#include "cli/version.h"
#include "fit/metrics.h"
#include "io/material_json.h"
#include "io/sha256.h"

namespace brdfit::cli {
namespace {

using io::Json;
namespace fs = std::filesystem;

fs::path material_path(const TableCostRequest& request, const std::string& file, Model model) {
  return request.output / fmt::format("{}.{}.json", base_name(file), name_of(model));
}

// A bar on a terminal; hundreds of lines elsewhere would say nothing.
bool shows_no_bar(const CommonOptions& common) {
  return common.quiet || isatty(STDERR_FILENO) == 0;
}

class Spender {
 public:
  Spender(const TableCostRequest& request, const std::string& file, const TableMeter& meter,
          const std::vector<PlannedFit>& plan)
      : request_(request), file_(file), meter_(meter), plan_(plan) {}

  BudgetAnswer spend_on(const CostRun& run) {
    return spend(request_.limits, run, [this](const CostPoint& point) { return again(point); });
  }

  // What was measured last, as the file will hold it.
  fs::path write(const io::MerlReadReport& report) const {
    const PlannedFit& planned = *planned_;
    const Provenance provenance = {fs::path(file_).filename().string(),
                                   io::sha256_of_file(file_),
                                   kVersion,
                                   planned.arguments.lenient,
                                   report.non_finite_values,
                                   planned.arguments.cell,
                                   path_from(request_.output, file_),
                                   request_.command,
                                   request_of(planned.options, planned.arguments)};
    const fs::path path = material_path(request_, file_, planned.options.model);
    io::write_material(path, judged_.fit.material, evidence_to_json(judged_, provenance));
    return path;
  }

 private:
  // Fits again, and measures what a reader of the file would get.
  CostPoint again(const CostPoint& point) {
    planned_ = &*std::ranges::find(plan_, point.name, &PlannedFit::name);
    TurnOptions turns;
    turns.repeats = request_.sweep.repeats;
    turns.before_each = stop_if_interrupted;
    CostPoint result = point;
    result.make_seconds = time_in_turns(
                              1,
                              [&](std::size_t) {
                                TableMeter::TimedFit timed = meter_.fit(*planned_);
                                judged_.fit = std::move(timed.fit);
                                return timed.seconds;
                              },
                              turns)
                              .works.front();
    const Material material = io::material_from_json(io::material_to_json(judged_.fit.material), file_);
    judged_.fit.material = material;
    judged_.fit.evaluation = fit::evaluate(material, meter_.table(), planned_->options.max_theta_deg);
    judged_ = meter_.judge(std::move(judged_.fit));
    result.evaluation_ns = time_evaluation_again(material);
    result.bytes = stored_bytes(material);
    // Held-out errors are of the choice, not of one material.
    for (const auto& [key, value] : errors_of(judged_)) {
      std::ranges::find(result.errors, key, &std::pair<std::string, double>::first)->second = value;
    }
    return result;
  }

  RepeatedTime time_evaluation_again(const Material& material) const {
    return time_in_turns(
               1, [&](std::size_t) { return meter_.evaluation_ns(material); },
               evaluation_turns(request_.sweep.repeats))
        .works.front();
  }

  const TableCostRequest& request_;
  const std::string& file_;
  const TableMeter& meter_;
  const std::vector<PlannedFit>& plan_;
  const PlannedFit* planned_ = nullptr;
  JudgedFit judged_;
};

}  // namespace

std::string request_of(const TableCostRequest& request) {
  Json json = {{"repeats", request.sweep.repeats},
               {"folds", request.sweep.folds},
               {"leading_error", request.sweep.leading_error},
               {"device", request.sweep.device}};
  for (const PlannedFit& planned : plan_fits(request.sweep.fit, request.sweep.quick)) {
    json["points"][planned.name] = request_of(planned.options, planned.arguments);
  }
  return io::sha256_of_text(json.dump());
}

void prepare_table_cost(const TableCostRequest& request, const std::string& file) {
  const CostPaths paths = cost_paths(request.output, base_name(file));
  for (const fs::path& path : {paths.csv, paths.json, paths.html}) prepare_output(path, request.common.force);
  if (!request.limits.any()) return;
  for (const Model model : all_models()) {
    prepare_output(material_path(request, file, model), request.common.force);
  }
}

TableCost measure_table_cost(const TableCostRequest& request, const std::string& file,
                             const Evaluators& evaluators) {
  const CostProvenance provenance = {io::sha256_of_file(file), request_of(request), request.command};
  const LoadedTable loaded = load_table(file, make_read_options(request.sweep.fit), request.common);
  const std::vector<PlannedFit> plan = plan_fits(request.sweep.fit, request.sweep.quick);
  const TableMeter meter(loaded.table, plan, evaluators);
  TableCost cost;
  {
    Progress progress(table_sweep_steps(plan, request.sweep, evaluators), shows_no_bar(request.common));
    cost.run = sweep_table(meter, fs::path(file).filename().string(), plan, request.sweep, progress);
  }
  cost.findings = findings_of(cost.run);
  cost.json = cost_json(cost.run, provenance, cost.findings);
  if (request.limits.any()) {
    Spender spender(request, file, meter, plan);
    cost.budget = spender.spend_on(cost.run);
    stop_if_interrupted();
    if (cost.budget->point) cost.material = spender.write(loaded.report);
    cost.json["budget"] =
        budget_json(*cost.budget, request.limits, cost.run, cost.material.filename().string());
  }
  stop_if_interrupted();
  const std::string page = cost_page(std::span(&cost.run, 1), sentences_of(cost.findings));
  write_cost_files(cost_paths(request.output, base_name(file)), cost.run, cost.json, page);
  return cost;
}

}  // namespace brdfit::cli
