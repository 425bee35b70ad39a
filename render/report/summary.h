// The report's table: one row for every fit, and means over materials.
#ifndef BRDFIT_RENDER_REPORT_SUMMARY_H_
#define BRDFIT_RENDER_REPORT_SUMMARY_H_

#include <string>

#include "render/report.h"

namespace brdfit::render {

// The table with its caption; a sentence where there are no fits.
std::string summary_html(const Report& report);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_REPORT_SUMMARY_H_
