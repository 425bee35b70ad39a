// The frame of a page.
#include "render/report/page.h"

#include <fmt/format.h>

#include <string_view>

#include "render/svg.h"

namespace brdfit::render {
namespace {

constexpr std::string_view kStyle =
#include "report_style.inc"
    ;
constexpr std::string_view kSort =
#include "report_sort_table.inc"
    ;

}  // namespace

std::string page_html(const Page& page) {
  // Nothing may be loaded, not even by mistake: the policy makes a browser refuse it.
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"generator\" content=\"brdfit {}\">\n<title>{}</title>\n<style>\n{}{}</style>\n"
      "</head>\n<body>\n{}<p class=\"unseen\" role=\"status\" id=\"said\"></p>\n<script>\n{}{}</script>\n"
      "</body>\n</html>\n",
      xml_escaped(page.version), xml_escaped(page.title), kStyle, page.style, page.body, kSort, page.script);
}

}  // namespace brdfit::render
