// Which fits a sweep makes: each choice alone around the defaults, and model, tier and effects with each
// other.
#ifndef BRDFIT_CLI_COST_SWEEP_PLAN_H_
#define BRDFIT_CLI_COST_SWEEP_PLAN_H_

#include <string>
#include <utility>
#include <vector>

#include "cli/fit_options.h"
#include "fit/fit.h"

namespace brdfit::cli {

struct PlannedFit {
  std::string name;        // as CostPoint::name
  std::string sweep;       // as CostPoint::sweep
  FitArguments arguments;  // of one model
  fit::FitOptions options;
};

// The plan, the point around which the others lie first: Callisto, full tier, all effects, 20,000 cells of
// the table. common: what holds for all (seed, cell, angles, masking, ...); its models, tier, effects,
// samples, starts, loss and what is fitted are not looked at. No two fits have the same free parameters,
// cells, starts and loss. quick: about a third of the points. Throws UsageError as make_fit_options().
std::vector<PlannedFit> plan_fits(const FitArguments& common, bool quick);

// The choices of a fit by the names of the options of `brdfit fit`, as that takes them.
std::vector<std::pair<std::string, std::string>> settings_of(const FitArguments& arguments);

// "brdfit fit INPUT --model callisto ...": the same fit by itself.
std::string fit_command(const FitArguments& arguments, const std::string& input);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_SWEEP_PLAN_H_
