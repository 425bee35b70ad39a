// The sweep of a measured table: what each choice of a fit buys and costs.
#ifndef BRDFIT_CLI_COST_TABLE_SWEEP_H_
#define BRDFIT_CLI_COST_TABLE_SWEEP_H_

#include <cstddef>
#include <string>
#include <vector>

#include "cli/cost/cost_point.h"
#include "cli/cost/error_keys.h"
#include "cli/cost/evaluators.h"
#include "cli/cost/paired_timing.h"
#include "cli/cost/sweep_plan.h"
#include "cli/fit_options.h"
#include "cli/progress.h"
#include "cli/sphere_judge.h"
#include "measured/table.h"

namespace brdfit::cli {

struct TableSweepOptions {
  FitArguments fit;  // what holds for all points; see plan_fits()
  bool quick = false;
  int repeats = 5;  // of every time
  int folds = 5;    // for held-out errors; 0: none
  std::string leading_error = kTableLeadingError;
  std::string device;  // for Vulkan; empty: the first, if there is one
};

// What one material costs to keep: four bytes for every number of a parameter that does not stand at its
// default, of effects that are on. The rest need not be stored.
double stored_bytes(const Material& material);

// Fits of one table, timed and measured.
class TableMeter {
 public:
  // The table and the evaluators must outlive it.
  TableMeter(const MeasuredTable& table, const std::vector<PlannedFit>& plan, const Evaluators& evaluators);

  struct TimedFit {
    fit::FitResult fit;
    double seconds = 0.0;  // without the error measures
  };
  TimedFit fit(const PlannedFit& planned) const;

  // Slice, table and sphere. Sizes and counts as well.
  JudgedFit judge(fit::FitResult fitted) const;

  // Nanoseconds of one evaluation by the first evaluator, on the same pairs for all.
  double evaluation_ns(const Material& material) const;

  const Evaluators& evaluators() const { return evaluators_; }
  const DirectionPairs& pairs() const { return pairs_; }
  const MeasuredTable& table() const { return table_; }

 private:
  const MeasuredTable& table_;
  const Evaluators& evaluators_;
  TableJudge judge_;
  DirectionPairs pairs_;
};

// The errors of a fit, by table_error_keys() without those held out.
std::vector<std::pair<std::string, double>> errors_of(const JudgedFit& judged);

// How often sweep_table() steps the progress.
std::size_t table_sweep_steps(const std::vector<PlannedFit>& plan, const TableSweepOptions& options,
                              const Evaluators& evaluators);

// Fits every point `repeats` times in turns, measures errors, memory and evaluations, and fits each again
// without each fold. Points with the same model, effects and options run the same code, which is timed once
// for all of them. All but times, memory and the fronts (which look at times) is the same for any number of
// threads. A point that cannot be fitted is left out, with a note. Throws std::runtime_error when
// interrupted, std::invalid_argument when nothing can be fitted.
CostRun sweep_table(const TableMeter& meter, const std::string& input, const std::vector<PlannedFit>& plan,
                    const TableSweepOptions& options, Progress& progress);

// How evaluations are timed where fits are `repeats` times: more often, in CPU time, in nanoseconds.
TurnOptions evaluation_turns(int repeats);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_TABLE_SWEEP_H_
