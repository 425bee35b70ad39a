// What an evaluation costs with each step's effects.
#ifndef BRDFIT_CLI_LADDER_COST_H_
#define BRDFIT_CLI_LADDER_COST_H_

#include <vector>

#include "fit/fit.h"

namespace brdfit::cli {

// Seconds per evaluation of three channels in spans, by one thread: with the groups that the selection began
// with, then after each step of its ladder; empty where there is no selection. Effects that are off are
// absent from the evaluation, so this is what each step costs. Measured here and now, for about 50 us each.
std::vector<double> ladder_costs(const fit::FitResult& result);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_LADDER_COST_H_
