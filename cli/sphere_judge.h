// Sphere dE beside the other measures of a fit, with the time that it takes.
#ifndef BRDFIT_CLI_SPHERE_JUDGE_H_
#define BRDFIT_CLI_SPHERE_JUDGE_H_

#include <cstddef>
#include <optional>

#include "cli/common.h"
#include "fit/fit.h"
#include "fit/held_out.h"
#include "render/delta_e.h"

namespace brdfit::cli {

struct JudgedSphere {
  render::SphereDeltaE delta_e;
  double seconds = 0.0;
};

// A fit with what its spheres look like. (fit/ does not know how to draw.)
struct JudgedFit {
  fit::FitResult fit;
  JudgedSphere sphere;
  std::optional<fit::HeldOutEvaluation> held_out;  // where it was asked for
  double held_out_seconds = 0.0;

  // Of the fit that was asked for, without the fits to parts of the table.
  double total_seconds() const { return fit.timings.total_seconds + sphere.seconds; }
};

// Judges candidates against one table. The time that its reference takes is shared among the candidates.
class TableJudge {
 public:
  TableJudge(const MeasuredTable& reference, std::size_t candidates);

  JudgedSphere operator()(const render::Subject& candidate) const;

 private:
  Stopwatch watch_;  // begins before the judge does
  render::SphereJudge judge_;
  double share_seconds_;
};

// fit::fit(), or under every loss with the judge's choice where the options ask for that.
fit::FitResult fit_as_asked(const MeasuredTable& table, const fit::FitOptions& options,
                            const TableJudge& judge);

// The same for a part of a table, with a judge of its own where one is needed: the whole table's has seen
// what is held out.
fit::FitResult fit_part(const MeasuredTable& part, const fit::FitOptions& options);

// Fits, judges, and fits again without each block of angles where held-out errors are asked for.
JudgedFit fit_and_judge(const MeasuredTable& table, const fit::FitOptions& options, const TableJudge& judge);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_SPHERE_JUDGE_H_
