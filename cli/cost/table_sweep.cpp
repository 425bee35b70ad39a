// Rounds of fits, evaluations and folds.
#include "cli/cost/table_sweep.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include "cli/cost/paired_timing.h"
#include "cli/cost/pareto.h"
#include "cli/cost/peak_memory.h"
#include "cli/measure_names.h"
#include "cli/run_scaling.h"
#include "fit/held_out.h"

namespace brdfit::cli {
namespace {

// Directions that fit into a core's own cache with their results.
constexpr std::size_t kTimedPairs = 8192;
constexpr int kEvaluationsPerRepeat = 8;

using Errors = std::vector<std::pair<std::string, double>>;

void add_measures(const std::string& prefix, const fit::Measures& measures, Errors& errors) {
  for (const MeasureName& measure : kMeasures)
    errors.emplace_back(prefix + measure.key, measures.*measure.value);
}

// What decides which code an evaluation runs.
using CodeKey = std::tuple<Model, std::uint32_t, Masking, BurleyG, Diffuse>;
CodeKey code_of(const Material& material) {
  const MaterialOptions& options = material.options();
  return {material.model(), material.effects().bits(), options.masking, options.burley_g, options.diffuse};
}

// A Vulkan device without a clock says NaN.
RepeatedTime measured_or_none(const RepeatedTime& time) {
  return std::isnan(time.median) ? RepeatedTime() : time;
}

class Sweep {
 public:
  Sweep(const TableMeter& meter, const std::string& input, const std::vector<PlannedFit>& plan,
        const TableSweepOptions& options, Progress& progress)
      : meter_(meter), plan_(plan), options_(options), progress_(progress), results_(plan.size()) {
    run_.kind = "table";
    run_.input = input;
    run_.leading_error = options.leading_error;
    run_.notes = meter.evaluators().notes;
  }

  CostRun go() {
    time_fits();
    time_evaluations();
    if (results_.front().fitted) compare_evaluators(results_.front());
    hold_out();
    collect_points();
    mark_fronts(run_);
    return std::move(run_);
  }

 private:
  struct Result {
    std::optional<JudgedFit> fitted;
    std::string why;  // it could not be
    RepeatedTime make_seconds;
    RepeatedTime evaluation_ns;
    double peak_mib = kNotMeasured;
    fit::HeldOutEvaluation held_out;
  };

  TurnOptions turns() const {
    TurnOptions result;
    result.repeats = options_.repeats;
    result.before_each = stop_if_interrupted;
    return result;
  }

  double fit_once(std::size_t k) {
    progress_.step(plan_[k].name);
    Result& result = results_[k];
    if (!result.why.empty()) return kNotMeasured;
    const bool is_first = !result.fitted;
    const bool is_peak_known = is_first && reset_peak_memory();
    if (is_first && !is_peak_known) can_reset_peak_ = false;
    try {
      TableMeter::TimedFit timed = meter_.fit(plan_[k]);
      if (is_peak_known) result.peak_mib = peak_memory_mib();
      if (is_first) result.fitted = meter_.judge(std::move(timed.fit));
      return timed.seconds;
    } catch (const std::invalid_argument& error) {
      result.why = error.what();
      return kNotMeasured;
    }
  }

  void time_fits() {
    const TimesInTurns times = time_in_turns(
        plan_.size(), [this](std::size_t k) { return fit_once(k); }, turns());
    run_.reference_seconds = times.reference_seconds;
    for (std::size_t k = 0; k < plan_.size(); ++k) {
      results_[k].make_seconds = measured_or_none(times.works[k]);
      if (!results_[k].why.empty()) {
        run_.notes.push_back(fmt::format("{} is left out: {}", plan_[k].name, results_[k].why));
      }
    }
    if (!can_reset_peak_) {
      run_.notes.emplace_back("the system does not let a process reset its peak memory, so none is given");
    }
    if (std::ranges::none_of(results_, [](const Result& result) { return result.fitted.has_value(); })) {
      throw std::invalid_argument("nothing can be fitted: " + results_.front().why);
    }
  }

  // Once for each code, by the first material that runs it.
  void time_evaluations() {
    std::map<CodeKey, std::size_t> place;
    std::vector<const Material*> materials;
    for (const Result& result : results_) {
      if (!result.fitted) continue;
      const Material& material = result.fitted->fit.material;
      if (place.emplace(code_of(material), materials.size()).second) materials.push_back(&material);
    }
    progress_.step("evaluations");
    const TimesInTurns times = time_in_turns(
        materials.size(), [&](std::size_t k) { return meter_.evaluation_ns(*materials[k]); },
        evaluation_turns(options_.repeats));
    for (Result& result : results_) {
      if (result.fitted) result.evaluation_ns = times.works[place.at(code_of(result.fitted->fit.material))];
    }
  }

  // The default point through every type and device.
  void compare_evaluators(const Result& fitted) {
    const Material& material = fitted.fitted->fit.material;
    const std::vector<Evaluator>& all = meter_.evaluators().all;
    for (const Evaluator& evaluator : all) {
      time_evaluation(evaluator, material, meter_.pairs());  // compiles a shader
    }
    const TimesInTurns times = time_in_turns(
        all.size(), [&](std::size_t k) { return time_evaluation(all[k], material, meter_.pairs()); },
        evaluation_turns(options_.repeats));
    for (std::size_t k = 0; k < all.size(); ++k) {
      progress_.step(all[k].device);
      stop_if_interrupted();
      CostPoint point;
      point.name = fmt::format("{}, {}, {}", plan_.front().name, all[k].scalar, all[k].device);
      point.sweep = "device";
      point.settings = all_settings(plan_.front(), all[k]);
      const fit::Evaluation evaluation = fit::evaluate(table_by(all[k], material, meter_.table()),
                                                       meter_.table(), plan_.front().options.max_theta_deg);
      add_measures("slice_", evaluation.slice, point.errors);
      add_measures("table_", evaluation.table, point.errors);
      point.evaluation_ns = measured_or_none(times.works[k]);
      point.bytes = stored_bytes(material);
      point.peak_mib = kNotMeasured;
      device_points_.push_back(std::move(point));
    }
  }

  static std::vector<std::pair<std::string, std::string>> all_settings(const PlannedFit& planned,
                                                                       const Evaluator& evaluator) {
    auto settings = settings_of(planned.arguments);
    settings.emplace_back("scalar", evaluator.scalar);
    settings.emplace_back("device", evaluator.device);
    return settings;
  }

  // A fold at a time, as its two tables are as large as the one that is fitted; its points side by side, as
  // nothing is timed.
  void hold_out() {
    for (int fold = 0; fold < options_.folds; ++fold) {
      const fit::SplitTable split =
          fit::split_table(meter_.table(), options_.folds, fold, fit::held_out_seed(options_.fit.seed));
      if (split.seen.valid_count() == 0 || split.held_out.valid_count() == 0) continue;
      run_jobs(plan_.size(), tbb::this_task_arena::max_concurrency(), [&](std::size_t k) {
        if (interrupted()) return;
        progress_.step(fmt::format("fold {}: {}", fold + 1, plan_[k].name));
        if (results_[k].fitted) hold_out(split, k);
      });
      stop_if_interrupted();
    }
  }

  void hold_out(const fit::SplitTable& split, std::size_t k) {
    try {
      const fit::FitResult fitted = fit_part(split.seen, plan_[k].options);
      results_[k].held_out.folds.push_back(
          {fit::evaluate(fitted.material, split.held_out, plan_[k].options.max_theta_deg),
           fitted.observations, fitted.free_parameters, fitted.groups, fitted.options.loss});
    } catch (const std::invalid_argument&) {
      // Nothing left to fit in this fold, as in fit::evaluate_held_out().
    }
  }

  void collect_points() {
    for (std::size_t k = 0; k < plan_.size(); ++k) {
      Result& result = results_[k];
      if (!result.fitted) continue;
      CostPoint point;
      point.name = plan_[k].name;
      point.sweep = plan_[k].sweep;
      point.settings = all_settings(plan_[k], meter_.evaluators().all.front());
      point.errors = errors_of(*result.fitted);
      add_held_out(result.held_out, point.errors);
      point.make_seconds = result.make_seconds;
      point.evaluation_ns = result.evaluation_ns;
      point.bytes = stored_bytes(result.fitted->fit.material);
      point.peak_mib = result.peak_mib;
      point.free_numbers = result.fitted->fit.free_parameters;
      point.observations = static_cast<double>(result.fitted->fit.observations);
      run_.points.push_back(std::move(point));
    }
    std::ranges::move(device_points_, std::back_inserter(run_.points));
  }

  static void add_held_out(const fit::HeldOutEvaluation& held_out, Errors& errors) {
    if (held_out.folds.empty()) return;
    for (const MeasureName& measure : kMeasures) {
      std::string key = "held_out_";
      errors.emplace_back(key += measure.key,
                          fit::over_folds(held_out, &fit::Evaluation::table, measure.value).mean);
    }
  }

  const TableMeter& meter_;
  const std::vector<PlannedFit>& plan_;
  const TableSweepOptions& options_;
  Progress& progress_;
  CostRun run_;
  std::vector<Result> results_;
  std::vector<CostPoint> device_points_;
  bool can_reset_peak_ = true;
};

}  // namespace

TurnOptions evaluation_turns(int repeats) {
  TurnOptions turns;
  // Evaluations take milliseconds: more repeats cost nothing.
  turns.repeats = kEvaluationsPerRepeat * repeats;
  turns.cpu_time = true;
  turns.per_second = 1e9;
  turns.before_each = stop_if_interrupted;
  return turns;
}

double stored_bytes(const Material& material) {
  constexpr double kBytesPerNumber = 4.0;
  double numbers = 0.0;
  for (const ParameterInfo& info : parameters_of(material.model())) {
    if (!material.effects().has(info.effect)) continue;
    const auto values = material.values().subspan(static_cast<std::size_t>(info.offset),
                                                  static_cast<std::size_t>(info.components));
    const bool is_default = std::ranges::all_of(values, [&](double v) { return v == info.default_value; });
    if (!is_default) numbers += info.components;
  }
  return kBytesPerNumber * numbers;
}

TableMeter::TableMeter(const MeasuredTable& table, const std::vector<PlannedFit>& plan,
                       const Evaluators& evaluators)
    : table_(table),
      evaluators_(evaluators),
      judge_(table, plan.size()),
      pairs_(pairs_to_time(kTimedPairs)) {}

TableMeter::TimedFit TableMeter::fit(const PlannedFit& planned) const {
  const Stopwatch watch;
  TimedFit timed;
  timed.fit = fit_as_asked(table_, planned.options, judge_);
  timed.seconds = watch.seconds() - timed.fit.timings.measure_seconds;
  return timed;
}

JudgedFit TableMeter::judge(fit::FitResult fitted) const {
  JudgedFit judged;
  judged.fit = std::move(fitted);
  judged.sphere = judge_(judged.fit.material);
  return judged;
}

double TableMeter::evaluation_ns(const Material& material) const {
  return time_evaluation(evaluators_.all.front(), material, pairs_);
}

std::vector<std::pair<std::string, double>> errors_of(const JudgedFit& judged) {
  Errors errors;
  add_measures("slice_", judged.fit.evaluation.slice, errors);
  add_measures("table_", judged.fit.evaluation.table, errors);
  errors.emplace_back("sphere_delta_e", judged.sphere.delta_e.mean);
  errors.emplace_back("reciprocity_gap_pct", judged.fit.evaluation.reciprocity_gap_pct);
  return errors;
}

std::size_t table_sweep_steps(const std::vector<PlannedFit>& plan, const TableSweepOptions& options,
                              const Evaluators& evaluators) {
  return plan.size() * static_cast<std::size_t>(options.repeats + options.folds) + 1 + evaluators.all.size();
}

CostRun sweep_table(const TableMeter& meter, const std::string& input, const std::vector<PlannedFit>& plan,
                    const TableSweepOptions& options, Progress& progress) {
  return Sweep(meter, input, plan, options, progress).go();
}

}  // namespace brdfit::cli
