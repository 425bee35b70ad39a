// One material's section of the report.
#include "render/report/material.h"

#include <fmt/format.h>

#include "render/report/evidence.h"
#include "render/report/html.h"
#include "render/report/ladder.h"
#include "render/report/parameters.h"
#include "render/report/picture.h"
#include "render/svg.h"

namespace brdfit::render {
namespace {

std::string pictures_html(const std::vector<ReportPicture>& pictures) {
  if (pictures.empty()) return "";
  std::string html = "<div class=\"pictures\">\n";
  for (const ReportPicture& picture : pictures) html += figure_html(picture);
  return html + "</div>\n";
}

std::string effects_html(const ReportFit& fit) {
  std::string html = fmt::format("<p class=\"effects\">{} free parameters. Effects:", fit.free_parameters);
  if (fit.effects.empty()) html += " none";
  for (const std::string& effect : fit.effects) html += fmt::format(" <code>{}</code>", xml_escaped(effect));
  return html + "</p>\n";
}

std::string notes_html(const ReportFit& fit) {
  if (fit.notes.empty()) return "";
  std::string html = "<ul class=\"notes\">\n";
  for (const std::string& note : fit.notes) html += fmt::format("<li>{}</li>\n", xml_escaped(note));
  return html + "</ul>\n";
}

std::string timings_html(const ReportFit& fit) {
  if (fit.timings_seconds.empty()) return "";
  std::string html = "<p class=\"timings\">Seconds:";
  for (const auto& [phase, seconds] : fit.timings_seconds) {
    html += fmt::format(" <span>{} <b>{}</b></span>", xml_escaped(phase), shown(seconds));
  }
  return html + "</p>\n";
}

std::string provenance_html(const ReportFit& fit) {
  std::string html = fmt::format("<details class=\"provenance\"><summary>Provenance of {}</summary>\n<dl>\n",
                                 xml_escaped(fit.file));
  for (const auto& [name, text] : fit.provenance) {
    html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", xml_escaped(name), xml_escaped(text));
  }
  if (fit.provenance.empty()) html += "<dt>unknown</dt><dd>the file does not say</dd>\n";
  return html + "</dl></details>\n";
}

std::string fit_html(const ReportFit& fit, const std::string& id) {
  return fmt::format("<article class=\"fit\" id=\"{}\">\n<h3>{}</h3>\n", id, xml_escaped(fit.model)) +
         effects_html(fit) + notes_html(fit) + losses_html(fit) + parameters_html(fit) +
         correlated_html(fit) + timings_html(fit) + provenance_html(fit) + "</article>\n";
}

}  // namespace

std::string material_html(const ReportMaterial& material, std::size_t index, bool is_open) {
  const std::string name = xml_escaped(material.name);
  std::string html = fmt::format(
      "<section class=\"material\" id=\"{0}\" data-name=\"{1}\">\n"
      "<details{2}><summary><h2>{1}</h2></summary>\n",
      section_id(index), name, is_open ? " open" : "");
  html += warning_list(material.warnings) + pictures_html(material.pictures);
  for (const ReportFit& fit : material.fits) html += ladder_html(fit);
  html += "<div class=\"fits\">\n";
  for (std::size_t f = 0; f < material.fits.size(); ++f) html += fit_html(material.fits[f], fit_id(index, f));
  return html + "</div>\n</details>\n</section>\n";
}

}  // namespace brdfit::render
