// The frame of a page with plots of costs.
#include "render/report/cost.h"

#include "render/report/page.h"

namespace brdfit::render {
namespace {

constexpr const char* kStyle =
#include "report_cost_style.inc"
    ;
constexpr const char* kScript =
#include "report_cost_script.inc"
    ;

}  // namespace

std::string cost_page_html(const std::string& title, const std::string& version, const std::string& body) {
  return page_html({title, version, body, kStyle, kScript});
}

}  // namespace brdfit::render
