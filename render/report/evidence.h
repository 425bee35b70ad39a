// What the evidence of a fit says besides its parameters: the losses that were tried, and correlated numbers.
#ifndef BRDFIT_RENDER_REPORT_EVIDENCE_H_
#define BRDFIT_RENDER_REPORT_EVIDENCE_H_

#include <string>

#include "render/report.h"

namespace brdfit::render {

// The losses with the sphere dE of their results, which was kept and by how much it is better; nothing where
// the loss was not chosen.
std::string losses_html(const ReportFit& fit);

// Pairs of numbers that the samples hardly tell apart, the closest first; nothing where there are none.
std::string correlated_html(const ReportFit& fit);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_REPORT_EVIDENCE_H_
