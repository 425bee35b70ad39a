// The best point under limits, and whether it keeps them when it is measured again.
#ifndef BRDFIT_CLI_COST_BUDGET_H_
#define BRDFIT_CLI_COST_BUDGET_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/cost/cost_point.h"

namespace brdfit::cli {

// Each is the most that a point may have; absent: no limit.
struct Limits {
  std::optional<double> evaluation_ns;
  std::optional<double> bytes;
  std::optional<double> make_seconds;
  std::optional<double> error;  // the leading one

  bool any() const { return evaluation_ns || bytes || make_seconds || error; }
};

// A figure that breaks a limit.
struct Excess {
  std::string what;  // "evaluation_ns", "bytes", "make_seconds", "error"
  double value = 0.0;
  double limit = 0.0;
};

// What of a point breaks the limits. Times count by their upper quartile: three of four repeats keep a limit
// that is said to be kept. A figure that was not measured breaks its limit, as infinity.
std::vector<Excess> excess_over(const Limits& limits, const CostPoint& point,
                                const std::string& leading_error);

// The points to choose from, best first: those on the front of the leading error and the limited figures (of
// the error and the time per evaluation where only the error is limited) that keep the limits. Without a
// limit of the error the least error is best; with one the least cost is: the time per evaluation, or where
// that has no limit and others do, the time to make, or the bytes. Points of other evaluators (sweep
// "device") are no choice.
std::vector<std::size_t> choices_under(const Limits& limits, const CostRun& run);

// The point whose largest excess, as a ratio to its limit, is least; the first of equals.
std::size_t nearest_to(const Limits& limits, const CostRun& run);

struct BudgetTrial {
  std::size_t point = 0;       // of the run
  CostPoint again;             // the same, measured again
  std::vector<Excess> excess;  // of that
};

struct BudgetAnswer {
  std::optional<std::size_t> point;  // that kept the limits both times; none: nothing did
  std::vector<BudgetTrial> trials;   // what was measured again, the accepted one last
  std::size_t nearest = 0;           // where there is none
};

// Makes and measures a point again; what it makes is the caller's to keep.
using MeasureAgain = std::function<CostPoint(const CostPoint&)>;

// Goes through choices_under() until one keeps the limits when measured again.
BudgetAnswer spend(const Limits& limits, const CostRun& run, const MeasureAgain& measure_again);

// What came of it, in a sentence or more; measured again and when it was chosen.
std::string budget_text(const BudgetAnswer& answer, const Limits& limits, const CostRun& run);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_BUDGET_H_
