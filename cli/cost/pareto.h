// Which points nothing beats: less error for as little cost.
#ifndef BRDFIT_CLI_COST_PARETO_H_
#define BRDFIT_CLI_COST_PARETO_H_

#include <functional>
#include <span>
#include <vector>

#include "cli/cost/cost_point.h"

namespace brdfit::cli {

// A figure of a point, the less the better; NaN where it was not measured.
using CostFigure = std::function<double(const CostPoint&)>;

double make_seconds_of(const CostPoint& point);   // the median
double evaluation_ns_of(const CostPoint& point);  // the median
double bytes_of(const CostPoint& point);

// Whether each point is on the front of the figures: no other point is at least as good in all and better in
// one. Of points that are alike in all figures the first is on it. Points that lack one of the figures are
// not.
std::vector<bool> front_of(std::span<const CostPoint> points, std::span<const CostFigure> figures);

// Marks the two fronts of a run: its leading error against the time to make and against that per evaluation.
// Points of the sweep "device" are the default point on other devices, whose times are compared with each
// other alone: they are on no front and beat nothing.
void mark_fronts(CostRun& run);

// The indices of the points that a test holds for, by rising cost.
std::vector<std::size_t> by_cost(std::span<const CostPoint> points, bool CostPoint::*is_on_front,
                                 const CostFigure& cost);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_PARETO_H_
