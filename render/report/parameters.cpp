// The list of parameters.
#include "render/report/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "render/report/html.h"
#include "render/svg.h"

namespace brdfit::render {
namespace {

std::string swatch_html(const std::string& srgb8) {
  // Only numbers may reach the style.
  const bool is_colour = !srgb8.empty() && srgb8.find_first_not_of("(), 0123456789") == std::string::npos;
  return is_colour ? fmt::format("<i class=\"swatch\" style=\"background:rgb{}\"></i>", srgb8) : "";
}

// The half-width of the interval that holds the truth 95 times of 100.
std::optional<double> half_width(const ReportParameter& parameter, std::size_t k) {
  constexpr double kNormalQuantile = 1.96;
  if (k >= parameter.standard_errors.size() || !parameter.standard_errors[k]) return std::nullopt;
  const double width = kNormalQuantile * *parameter.standard_errors[k];
  return std::isfinite(width) && width >= 0.0 ? std::optional(width) : std::nullopt;
}

// "± 0.012", of each value where there are several.
std::string errors_html(const ReportParameter& parameter) {
  std::string text;
  bool has_any = false;
  for (std::size_t k = 0; k < parameter.values.size(); ++k) {
    const std::optional<double> width = half_width(parameter, k);
    has_any |= width.has_value();
    if (!text.empty()) text += ' ';
    text += width ? fmt::format("{:.2g}", *width) : "–";
  }
  return has_any ? fmt::format("<span class=\"error\">±&nbsp;{}</span>", text) : "";
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
  html += errors_html(parameter);
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

// The part of the range that an interval covers. An end beyond the range is open: it has an arrow.
std::string interval_html(const ReportParameter& parameter, std::size_t k, std::string_view lane) {
  const std::optional<double> width = half_width(parameter, k);
  if (!width) return "";
  const double lower = parameter.values[k] - *width;
  const double upper = parameter.values[k] + *width;
  const double from = place(parameter, std::max(lower, parameter.lower));
  const double to = place(parameter, std::min(upper, parameter.upper));
  return fmt::format("<i class=\"sure {}{}{}\" style=\"left:{:.2f}%;width:{:.2f}%\"></i>", lane,
                     lower < parameter.lower ? " below" : "", upper > parameter.upper ? " beyond" : "", from,
                     to - from);
}

std::string spoken_intervals(const ReportParameter& parameter) {
  std::string text;
  for (std::size_t k = 0; k < parameter.values.size(); ++k) {
    const std::optional<double> width = half_width(parameter, k);
    if (!width) continue;
    text += fmt::format("{} {} to {}", text.empty() ? ", 95% interval" : " and",
                        shown(std::max(parameter.values[k] - *width, parameter.lower)),
                        shown(std::min(parameter.values[k] + *width, parameter.upper)));
  }
  return text;
}

// The range as a bar: a tick at the default, and a marker with its interval for each value (three lanes for
// red, green, blue).
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
    const std::string_view lane = is_colour ? kChannels[k] : "only";
    marks += interval_html(parameter, k, lane);
    marks += fmt::format("<i class=\"at {}\" style=\"left:{:.2f}%\"></i>", lane,
                         place(parameter, parameter.values[k]));
  }
  return fmt::format(
      "<span class=\"range{}\" role=\"img\" aria-label=\"range {} to {}, default {}{}\">{}</span>"
      "<span class=\"ends\"><span>{}</span><span>{}</span></span>",
      is_colour ? " three" : "", shown(parameter.lower), shown(parameter.upper),
      shown(parameter.default_value), spoken_intervals(parameter), marks, end(parameter.lower),
      end(parameter.upper));
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
  if (status == "unidentifiable") {
    const std::string reason =
        parameter.reason.empty() ? "" : fmt::format("<small>{}</small>", xml_escaped(parameter.reason));
    return fmt::format("<span class=\"status unseen-by-data\">?&nbsp;{}</span>{}", text, reason);
  }
  return fmt::format("<span class=\"status\">{}</span>", text);
}

}  // namespace

std::string parameters_html(const ReportFit& fit) {
  if (fit.parameters.empty()) return "";
  // The roles are those of the elements, said for browsers that forget them where rows become
  // blocks.
  std::string html =
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Parameters\">"
      "<table class=\"parameters\" role=\"table\">\n<thead role=\"rowgroup\"><tr role=\"row\">"
      "<th scope=\"col\" role=\"columnheader\">parameter</th>"
      "<th scope=\"col\" role=\"columnheader\" "
      "title=\"1.96 standard errors: intervals that hold the truth 95 times of 100\">value ± 95% (sRGB)</th>"
      "<th scope=\"col\" role=\"columnheader\">on its range</th>"
      "<th scope=\"col\" role=\"columnheader\">status</th></tr></thead>\n<tbody role=\"rowgroup\">\n";
  for (const ReportParameter& parameter : fit.parameters) {
    html += fmt::format(
        "<tr role=\"row\"><th scope=\"row\" role=\"rowheader\">{}<small>{}</small></th>"
        "<td role=\"cell\">{}</td><td role=\"cell\">{}</td><td role=\"cell\">{}</td></tr>\n",
        breakable(parameter.name), xml_escaped(parameter.help), value_html(parameter), range_html(parameter),
        status_html(parameter));
  }
  return html + "</tbody>\n</table></div>\n";
}

}  // namespace brdfit::render
