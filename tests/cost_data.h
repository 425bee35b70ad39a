// Runs of made-up points, for the tests of what is said and chosen about them.
#ifndef BRDFIT_TESTS_COST_DATA_H_
#define BRDFIT_TESTS_COST_DATA_H_

#include <string>
#include <utility>
#include <vector>

#include "cli/cost/cost_point.h"
#include "cli/cost/pareto.h"

namespace brdfit::testing_support {

using Settings = std::vector<std::pair<std::string, std::string>>;

// A time whose quartiles are 1% away.
inline cli::RepeatedTime time_of(double median) {
  return {median, 0.99 * median, 1.01 * median, 5, median / 1e-3};
}

inline cli::CostPoint cost_point(const std::string& name, const std::string& sweep, const Settings& settings,
                                 double error, double make_seconds, double evaluation_ns,
                                 double bytes = 40.0) {
  cli::CostPoint point;
  point.name = name;
  point.sweep = sweep;
  point.settings = settings;
  point.errors = {{"error", error}};
  point.make_seconds = time_of(make_seconds);
  point.evaluation_ns = time_of(evaluation_ns);
  point.bytes = bytes;
  return point;
}

inline cli::CostRun cost_run(std::vector<cli::CostPoint> points) {
  cli::CostRun run;
  run.kind = "table";
  run.input = "made-up.binary";
  run.leading_error = "error";
  run.reference_seconds = time_of(1e-3);
  run.points = std::move(points);
  cli::mark_fronts(run);
  return run;
}

}  // namespace brdfit::testing_support

#endif  // BRDFIT_TESTS_COST_DATA_H_
