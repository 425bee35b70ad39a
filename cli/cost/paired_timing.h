// Times that can be compared: measured in turns, several times, with a fixed piece of work next to each.
//
// A machine's pace changes while it measures (other programs, clock frequency), so times that were taken one
// after another do not compare. Here every work is measured once in each round, in an order that moves on by
// one from round to round, and the same reference workload runs before each: what slows one slows the others.
#ifndef BRDFIT_CLI_COST_PAIRED_TIMING_H_
#define BRDFIT_CLI_COST_PAIRED_TIMING_H_

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "cli/cost/cost_point.h"

namespace brdfit::cli {

// CPU time of the calling thread since it began.
double thread_cpu_seconds();

// Quantile q in [0, 1] of values, linear between neighbours in order. Throws std::invalid_argument where
// there is no value.
double quantile_of(std::vector<double> values, double q);

// Collects repeats of one time, each with that of the reference next to it, both in one unit.
class Repeats {
 public:
  void add(double time, double reference);
  // Not measured where nothing was added.
  RepeatedTime summary() const;

 private:
  std::vector<double> times_;
  std::vector<double> ratios_;
};

// Seconds of the reference workload on the clock of the wall, and of its thread's CPU time: two million
// quotients that are added in turn, by one thread, in registers. About 3 to 5 ms on a machine of 2020.
struct ReferenceTime {
  double wall_seconds = 0.0;
  double cpu_seconds = 0.0;
};
ReferenceTime time_reference();

// Does a piece of work once and says how long it took: `what` of the pieces.
using TimedWork = std::function<double(std::size_t what)>;

struct TurnOptions {
  int repeats = 5;
  // Which of the two clocks of the reference the works' times are held against, times `per_second` (1e9 where
  // works say nanoseconds).
  bool cpu_time = false;
  double per_second = 1.0;
  // Asked before every piece of work; what it throws ends the measurement.
  std::function<void()> before_each = [] {};
};

struct TimesInTurns {
  std::vector<RepeatedTime> works;
  RepeatedTime reference_seconds;
};

// Measures `count` pieces of work `repeats` times each, in turns.
TimesInTurns time_in_turns(std::size_t count, const TimedWork& work, const TurnOptions& options);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_PAIRED_TIMING_H_
