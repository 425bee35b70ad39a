// What a sweep says, in sentences that a person can act on.
//
// Accuracy is the inverse of the leading error: a point with twice the error of another has half its
// accuracy. So "A reaches 94% of the accuracy of B" says 100 x (error of B) / (error of A) = 94. No baseline
// enters, and 100% is the accuracy of B, not of a perfect fit. (Both 0: 100%.) "At 0.40x its run-time cost"
// is the ratio of the medians of nanoseconds per evaluation; "at 0.40x its time to fit" that of seconds.
// Where the intervals of
// two medians overlap (half widths of 1.57 x the distance of the quartiles / the root of the repeats: notches
// of McGill, Tukey and Larsen 1978), the times are called about the same. Every number in a sentence comes
// from the figures of the run's points alone, which are those of its CSV.
#ifndef BRDFIT_CLI_COST_FINDINGS_H_
#define BRDFIT_CLI_COST_FINDINGS_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cli/cost/cost_point.h"

namespace brdfit::cli {

struct Finding {
  std::string about;                // "best", "run time", "making", "model", "samples", ...
  std::string text;                 // one sentence
  std::vector<std::string> points;  // the names of those that it compares
};

// An improvement by less than this share of the error is none.
inline constexpr double kNoImprovement = 0.01;

// 100 x (error of b) / (error of a).
double accuracy_share_pct(double error_a, double error_b);

// The smallest value of a numeric setting after which no larger value has an error that is lower by more than
// kNoImprovement of its own.
struct Plateau {
  double value = 0.0;
  double largest = 0.0;   // that was tried; `value` itself where the error still falls
  std::size_t point = 0;  // indices of the two in run.points
  std::size_t last = 0;
};

// Over the points of a sweep and the default point whose setting of that name is a positive number. Nothing
// where there are fewer than two.
std::optional<Plateau> plateau_of(const CostRun& run, const std::string& sweep);

// The sentences of a run, in the order in which they are printed.
std::vector<Finding> findings_of(const CostRun& run);

// Their texts.
std::vector<std::string> sentences_of(const std::vector<Finding>& findings);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_FINDINGS_H_
