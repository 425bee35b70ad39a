// The list of a fit's parameters: values, places on their ranges with error bars, and what is to be said of
// them.
#ifndef BRDFIT_RENDER_REPORT_PARAMETERS_H_
#define BRDFIT_RENDER_REPORT_PARAMETERS_H_

#include <string>

#include "render/report.h"

namespace brdfit::render {

// A table; nothing where the fit has no parameters.
std::string parameters_html(const ReportFit& fit);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_REPORT_PARAMETERS_H_
