// The report's page.
#include "render/report.h"

#include <fmt/format.h>

#include <string_view>

#include "render/report/html.h"
#include "render/report/material.h"
#include "render/report/page.h"
#include "render/report/summary.h"
#include "render/svg.h"

namespace brdfit::render {
namespace {

constexpr std::string_view kScript =
#include "report_script.inc"
    ;

// More sections than that begin folded, and have a list and a filter.
constexpr std::size_t kMostUnfolded = 12;
constexpr std::size_t kFewMaterials = 3;

std::string count_of(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string title_html(const Report& report) {
  std::size_t fits = 0;
  for (const ReportMaterial& material : report.materials) fits += material.fits.size();
  std::string html = fmt::format("<header>\n<h1>{}</h1>\n<p>{}, {}. brdfit {}.", xml_escaped(report.title),
                                 count_of(report.materials.size(), "material"), count_of(fits, "fit"),
                                 xml_escaped(report.version));
  if (!report.command.empty()) html += fmt::format(" Made by <code>{}</code>", xml_escaped(report.command));
  return html + "</p>\n</header>\n";
}

std::string contents_html(const Report& report) {
  if (report.materials.size() <= kFewMaterials) return "";
  std::string html =
      "<div class=\"tools\"><label>Show materials with <input type=\"search\" id=\"filter\" "
      "autocomplete=\"off\" "
      "placeholder=\"part of the name\"></label>\n"
      "<button type=\"button\" id=\"unfold\">Unfold all</button>\n"
      "<button type=\"button\" id=\"fold\">Fold all</button></div>\n"
      "<nav aria-label=\"Materials\"><ul class=\"contents\">\n";
  for (std::size_t m = 0; m < report.materials.size(); ++m) {
    html += fmt::format("<li data-section=\"{0}\"><a href=\"#{0}\">{1}</a></li>\n", section_id(m),
                        xml_escaped(report.materials[m].name));
  }
  return html + "</ul></nav>\n";
}

// Shows a picture at its full size, above the page.
constexpr std::string_view kViewer =
    "<dialog id=\"viewer\" aria-labelledby=\"viewer-caption\"><div class=\"bar\"><p "
    "id=\"viewer-caption\"></p>"
    "<button type=\"button\" id=\"viewer-close\">Close</button></div>"
    "<div class=\"pane\" tabindex=\"0\"></div></dialog>\n";

}  // namespace

std::string report_html(const Report& report) {
  std::string html = "<a class=\"skip\" href=\"#results\">Skip to the results</a>\n" + title_html(report) +
                     "<main>\n" + warning_list(report.warnings) +
                     "<section id=\"results\" tabindex=\"-1\" aria-label=\"Results\">\n" +
                     contents_html(report) + summary_html(report) + "</section>\n";
  const bool is_open = report.materials.size() <= kMostUnfolded;
  for (std::size_t m = 0; m < report.materials.size(); ++m) {
    html += material_html(report.materials[m], m, is_open);
  }
  html += "</main>\n";
  html += kViewer;
  return page_html({report.title + " – brdfit report", report.version, html, "", std::string(kScript)});
}

}  // namespace brdfit::render
