// The frame of a page with plots of costs: their style, and a script that names points.
#ifndef BRDFIT_RENDER_REPORT_COST_H_
#define BRDFIT_RENDER_REPORT_COST_H_

#include <string>

namespace brdfit::render {

// The file's text. title, version: plain text. body: HTML, with plots (cost_plot) in
//   <section class="run"> ... <div class="plots"><figure>SVG<p class="named"></p>...</figure></div>
// and tables of class "results", whose rows may have the points' data-point.
std::string cost_page_html(const std::string& title, const std::string& version, const std::string& body);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_REPORT_COST_H_
