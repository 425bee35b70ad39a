// Runs of `brdfit cost` as a test makes them up.
#ifndef BRDFIT_TESTS_COST_PAGE_DATA_H_
#define BRDFIT_TESTS_COST_PAGE_DATA_H_

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "cli/cost/cost_point.h"

namespace brdfit::tests {

inline cli::RepeatedTime spread(double median, double share) {
  return {median, median * (1.0 - share), median * (1.0 + share), 7};
}

// The points that none beats, by one of the two times.
inline void mark_front(cli::CostRun& run, cli::RepeatedTime cli::CostPoint::*time,
                       bool cli::CostPoint::*flag) {
  for (cli::CostPoint& point : run.points) {
    point.*flag = true;
    for (const cli::CostPoint& other : run.points) {
      const double cost = (point.*time).median - (other.*time).median;
      const double error = point.errors[0].second - other.errors[0].second;
      if (cost >= 0.0 && error >= 0.0 && cost + error > 0.0) point.*flag = false;
    }
  }
}

// Errors fall with cost, with some disorder; sweeps in turn.
inline cli::CostRun made_up_run(std::size_t count, const std::string& input = "made-up.binary") {
  const std::vector<std::string> sweeps = {"model", "tier", "effects", "samples", "starts", "loss", "data"};
  cli::CostRun run;
  run.kind = "table";
  run.input = input;
  run.leading_error = "held-out log-ratio %";
  run.reference_seconds = spread(0.0123, 0.02);
  for (std::size_t k = 0; k < count; ++k) {
    const double at = static_cast<double>(k * 37 % count) / static_cast<double>(count);
    const double disorder = std::sin(1.7 * static_cast<double>(k));
    cli::CostPoint point;
    point.name = "callisto " + std::to_string(100 * k) + " of something";
    point.sweep = sweeps[k % sweeps.size()];
    point.settings = {{"model", "callisto"}, {"samples", std::to_string(100 * k)}};
    point.errors = {{run.leading_error, 12.0 + 20.0 * std::exp(-4.0 * at) + 4.0 * (1.0 + disorder)},
                    {"log-ratio %", 11.0 + 20.0 * std::exp(-4.0 * at)}};
    point.make_seconds = spread(0.05 * std::exp(5.0 * at) * (1.5 + disorder), 0.15);
    point.evaluation_ns = spread(12.0 + 30.0 * at + 4.0 * disorder, 0.03);
    point.bytes = 200.0;
    point.peak_mib = 60.0;
    run.points.push_back(point);
  }
  mark_front(run, &cli::CostPoint::make_seconds, &cli::CostPoint::on_make_front);
  mark_front(run, &cli::CostPoint::evaluation_ns, &cli::CostPoint::on_run_front);
  return run;
}

}  // namespace brdfit::tests

#endif  // BRDFIT_TESTS_COST_PAGE_DATA_H_
