// One material's section of the report.
#ifndef BRDFIT_RENDER_REPORT_MATERIAL_H_
#define BRDFIT_RENDER_REPORT_MATERIAL_H_

#include <cstddef>
#include <string>

#include "render/report.h"

namespace brdfit::render {

// The section of report.materials[index]: warnings, pictures and fits; unfolded or not.
std::string material_html(const ReportMaterial& material, std::size_t index, bool is_open);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_REPORT_MATERIAL_H_
