// One material's section of the report.
#include "render/report/material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "render/report/html.h"
#include "render/svg.h"

namespace brdfit::render {
namespace {

// A size that the picture's maker left open is in the PNG's own header (IHDR).
int png_size(const std::vector<unsigned char>& png, std::size_t offset) {
  if (png.size() < offset + 4) return 0;
  int size = 0;
  for (std::size_t k = 0; k < 4; ++k) size = (size << 8) | png[offset + k];
  return size;
}

std::string image_html(const ReportPicture& picture) {
  const int width = picture.width_px > 0 ? picture.width_px : png_size(picture.png, 16);
  const int height = picture.height_px > 0 ? picture.height_px : png_size(picture.png, 20);
  return fmt::format(
      "<img src=\"data:image/png;base64,{}\" alt=\"{}\" width=\"{}\" height=\"{}\" "
      "loading=\"lazy\" decoding=\"async\">",
      base64(picture.png), xml_escaped(picture.alt), width, height);
}

// A plot speaks for itself by its own title; what the caller says of it comes first.
std::string plot_html(const ReportPicture& picture) {
  const std::size_t start = picture.svg.find("<svg");
  if (start == std::string::npos) return "";
  return fmt::format("<span role=\"img\" aria-label=\"{}\">{}</span>", xml_escaped(picture.alt),
                     picture.svg.substr(start));
}

std::string figure_html(const ReportPicture& picture) {
  const std::string content = picture.png.empty() ? plot_html(picture) : image_html(picture);
  const std::string caption = xml_escaped(picture.caption);
  if (content.empty()) {
    return fmt::format("<figure><p class=\"missing\">no picture</p><figcaption>{}</figcaption></figure>\n",
                       caption);
  }
  const int width = picture.width_px > 0 ? picture.width_px : png_size(picture.png, 16);
  const int height = picture.height_px > 0 ? picture.height_px : png_size(picture.png, 20);
  const char* wide = 10 * width > 16 * height ? " class=\"wide\"" : "";
  return fmt::format(
      "<figure{}><button type=\"button\" class=\"zoom\" title=\"Full size\">{}</button>"
      "<figcaption>{}</figcaption></figure>\n",
      wide, content, caption);
}

std::string pictures_html(const std::vector<ReportPicture>& pictures) {
  if (pictures.empty()) return "";
  std::string html = "<div class=\"pictures\">\n";
  for (const ReportPicture& picture : pictures) html += figure_html(picture);
  return html + "</div>\n";
}

std::string swatch_html(const std::string& srgb8) {
  // Only numbers may reach the style.
  const bool is_colour = !srgb8.empty() && srgb8.find_first_not_of("(), 0123456789") == std::string::npos;
  return is_colour ? fmt::format("<i class=\"swatch\" style=\"background:rgb{}\"></i>", srgb8) : "";
}

std::string value_html(const ReportParameter& parameter) {
  std::string text, digits;
  for (const double value : parameter.values) {
    if (!text.empty()) text += ' ';
    if (!digits.empty()) digits += ' ';
    text += shown(value);
    digits += exact(value);
  }
  std::string html =
      fmt::format("<span class=\"value\" title=\"{}\">{}</span>", digits, text.empty() ? "–" : text);
  if (!parameter.srgb8.empty()) {
    html += fmt::format("<span class=\"colour\" title=\"8-bit sRGB\">{}{}</span>",
                        swatch_html(parameter.srgb8), xml_escaped(parameter.srgb8));
  }
  return html;
}

bool is_in_range(const ReportParameter& parameter, double value) {
  return value >= parameter.lower && value <= parameter.upper;
}

// Place on the range in percent, for a value in it.
double place(const ReportParameter& parameter, double value) {
  const double width = parameter.upper - parameter.lower;
  return width > 0.0 ? 100.0 * (value - parameter.lower) / width : 0.0;
}

// The range as a bar: a tick at the default, and a marker for each value (three lanes for red, green, blue).
std::string range_html(const ReportParameter& parameter) {
  if (!std::isfinite(parameter.lower) || !std::isfinite(parameter.upper)) return "–";
  std::string marks;
  if (is_in_range(parameter, parameter.default_value)) {
    marks += fmt::format("<i class=\"default\" style=\"left:{:.2f}%\"></i>",
                         place(parameter, parameter.default_value));
  }
  const auto end = [](double value) { return fmt::format("{:.3g}", value); };
  constexpr std::string_view kChannels[] = {"red", "green", "blue"};
  const bool is_colour = parameter.values.size() == 3;
  for (std::size_t k = 0; k < parameter.values.size(); ++k) {
    if (!is_in_range(parameter, parameter.values[k])) continue;
    marks += fmt::format("<i class=\"at {}\" style=\"left:{:.2f}%\"></i>", is_colour ? kChannels[k] : "only",
                         place(parameter, parameter.values[k]));
  }
  return fmt::format(
      "<span class=\"range{}\" role=\"img\" aria-label=\"range {} to {}, default {}\">{}</span>"
      "<span class=\"ends\"><span>{}</span><span>{}</span></span>",
      is_colour ? " three" : "", shown(parameter.lower), shown(parameter.upper),
      shown(parameter.default_value), marks, end(parameter.lower), end(parameter.upper));
}

// The status, and what the file does not say but the numbers do.
std::string status_html(const ReportParameter& parameter) {
  const bool is_outside = std::any_of(parameter.values.begin(), parameter.values.end(),
                                      [&](double value) { return !is_in_range(parameter, value); });
  if (is_outside) return "<span class=\"status bad\">⚠ outside its range</span>";
  const std::string& status = parameter.status;
  if (status.empty()) return "–";
  const std::string text = xml_escaped(status);
  if (status.starts_with("at ")) return fmt::format("<span class=\"status bound\">◂▸&nbsp;{}</span>", text);
  if (status == "unidentifiable")
    return fmt::format("<span class=\"status unseen-by-data\">?&nbsp;{}</span>", text);
  return fmt::format("<span class=\"status\">{}</span>", text);
}

// A name that may be broken behind its underscores.
std::string breakable(const std::string& name) {
  std::string html;
  for (const char c : xml_escaped(name)) {
    html += c;
    if (c == '_') html += "<wbr>";
  }
  return html;
}

std::string parameters_html(const ReportFit& fit) {
  if (fit.parameters.empty()) return "";
  std::string html =
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Parameters\"><table "
      "class=\"parameters\">\n"
      "<thead><tr><th scope=\"col\">parameter</th><th scope=\"col\">value (sRGB)</th><th scope=\"col\">on "
      "its "
      "range</th>"
      "<th scope=\"col\">status</th></tr></thead>\n<tbody>\n";
  for (const ReportParameter& parameter : fit.parameters) {
    html +=
        fmt::format("<tr><th scope=\"row\">{}<small>{}</small></th><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                    breakable(parameter.name), xml_escaped(parameter.help), value_html(parameter),
                    range_html(parameter), status_html(parameter));
  }
  return html + "</tbody>\n</table></div>\n";
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
         effects_html(fit) + notes_html(fit) + parameters_html(fit) + timings_html(fit) +
         provenance_html(fit) + "</article>\n";
}

}  // namespace

std::string material_html(const ReportMaterial& material, std::size_t index, bool is_open) {
  const std::string name = xml_escaped(material.name);
  std::string html = fmt::format(
      "<section class=\"material\" id=\"{0}\" data-name=\"{1}\">\n"
      "<details{2}><summary><h2>{1}</h2></summary>\n",
      section_id(index), name, is_open ? " open" : "");
  html += warning_list(material.warnings) + pictures_html(material.pictures) + "<div class=\"fits\">\n";
  for (std::size_t f = 0; f < material.fits.size(); ++f) html += fit_html(material.fits[f], fit_id(index, f));
  return html + "</div>\n</details>\n</section>\n";
}

}  // namespace brdfit::render
