// How a fit came to its effects: a slice for every rung, beside the plot of held-out error and cost.
#ifndef BRDFIT_RENDER_REPORT_LADDER_H_
#define BRDFIT_RENDER_REPORT_LADDER_H_

#include <string>

#include "render/report.h"

namespace brdfit::render {

// A section; nothing where the fit has no ladder.
std::string ladder_html(const ReportFit& fit);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_REPORT_LADDER_H_
