// The page of `brdfit cost`: sentences, plots and a table of all points.
#ifndef BRDFIT_CLI_COST_COST_PAGE_H_
#define BRDFIT_CLI_COST_COST_PAGE_H_

#include <span>
#include <string>

#include "cli/cost/cost_point.h"

namespace brdfit::cli {

// One self-contained HTML file. Per run: error against the time to make and against the time of an
// evaluation, fronts as the points say; error against bytes, where points differ in them; and what each
// choice gains against what it costs per evaluation, compared with the default point (effects with none;
// without a default, the first of its sweep). Of several runs also their medians and quartiles, over points
// of the same name, of errors relative to each run's least. Figures that are not finite are left out of
// plots, and dashes in tables.
std::string cost_page(std::span<const CostRun> runs, std::span<const std::string> sentences);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_COST_PAGE_H_
