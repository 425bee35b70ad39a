// The log-ratio of a material over samples: what held-out errors are.
#ifndef BRDFIT_FIT_LOG_RATIO_H_
#define BRDFIT_FIT_LOG_RATIO_H_

#include <vector>

#include "brdf/material.h"
#include "measured/sampling.h"

namespace brdfit::fit {

// Of each observation: 100 |ln((f cos_i + 1e-3) / (r cos_i + 1e-3))|, mean over channels.
std::vector<double> log_ratios_pct(const Material& material, const SampleSet& samples);

// Their mean by weight, as fit/metrics.h has it over a table.
double log_ratio_pct(const Material& material, const SampleSet& samples);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_LOG_RATIO_H_
