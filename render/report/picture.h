// Pictures in the page.
#ifndef BRDFIT_RENDER_REPORT_PICTURE_H_
#define BRDFIT_RENDER_REPORT_PICTURE_H_

#include <string>

#include "render/report.h"

namespace brdfit::render {

// An <img> with the PNG in it.
std::string image_html(const ReportPicture& picture);

// A figure with its caption, whose picture a click shows at its full size; says so where there is none.
std::string figure_html(const ReportPicture& picture);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_REPORT_PICTURE_H_
