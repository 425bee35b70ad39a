// The report's table.
#include "render/report/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include "render/report/html.h"
#include "render/svg.h"

namespace brdfit::render {
namespace {

// A column of numbers.
struct Column {
  std::string group;  // title above it, shared with neighbours of the same group
  std::string title;
  std::string spoken;  // for those who do not see the group
  bool is_error;       // the lowest is the best
  std::function<std::optional<double>(const ReportFit&)> value;
};

std::optional<double> measure_of(const ReportFit& fit, const std::string& name,
                                 std::optional<double> ReportMeasure::*part) {
  const auto found = std::find_if(fit.measures.begin(), fit.measures.end(),
                                  [&](const ReportMeasure& measure) { return measure.name == name; });
  return found == fit.measures.end() ? std::nullopt : (*found).*part;
}

std::optional<double> seconds_of(const ReportFit& fit) {
  if (fit.timings_seconds.empty()) return std::nullopt;
  for (const auto& [phase, seconds] : fit.timings_seconds) {
    if (phase == "fit" || phase == "total") return seconds;
  }
  return std::accumulate(fit.timings_seconds.begin(), fit.timings_seconds.end(), 0.0,
                         [](double sum, const auto& entry) { return sum + entry.second; });
}

// The names of all measures in the order in which they appear.
std::vector<std::string> measure_names(const Report& report) {
  std::vector<std::string> names;
  for (const ReportMaterial& material : report.materials) {
    for (const ReportFit& fit : material.fits) {
      for (const ReportMeasure& measure : fit.measures) {
        if (std::find(names.begin(), names.end(), measure.name) == names.end()) names.push_back(measure.name);
      }
    }
  }
  return names;
}

bool is_anywhere(const Report& report, const Column& column) {
  return std::any_of(report.materials.begin(), report.materials.end(), [&](const ReportMaterial& material) {
    return std::any_of(material.fits.begin(), material.fits.end(),
                       [&](const ReportFit& fit) { return column.value(fit).has_value(); });
  });
}

// Columns that are empty everywhere are left out.
std::vector<Column> make_columns(const Report& report) {
  std::vector<Column> columns;
  columns.push_back({"", "free", "free parameters", false,
                     [](const ReportFit& fit) { return static_cast<double>(fit.free_parameters); }});
  columns.push_back({"", "sphere ΔE", "sphere colour difference", true,
                     [](const ReportFit& fit) { return fit.sphere_delta_e; }});
  for (const std::string& name : measure_names(report)) {
    columns.push_back({name, "slice", name + " on the slice", true, [name](const ReportFit& fit) {
                         return measure_of(fit, name, &ReportMeasure::slice);
                       }});
    columns.push_back({name, "table", name + " on the table", true, [name](const ReportFit& fit) {
                         return measure_of(fit, name, &ReportMeasure::table);
                       }});
  }
  columns.push_back({"", "seconds", "seconds", false, seconds_of});
  std::erase_if(columns, [&](const Column& column) { return !is_anywhere(report, column); });
  return columns;
}

std::string button(const std::string& title, const std::string& spoken) {
  return fmt::format("<button type=\"button\" aria-label=\"{}\">{}</button>", xml_escaped(spoken),
                     xml_escaped(title));
}

std::string head_html(const std::vector<Column>& columns) {
  std::string above =
      "<tr>"
      "<th rowspan=\"2\" scope=\"col\" aria-sort=\"none\" class=\"name\" data-kind=\"text\">" +
      button("material", "material") +
      "</th><th rowspan=\"2\" scope=\"col\" aria-sort=\"none\" data-kind=\"text\">" +
      button("model", "model") + "</th>";
  std::string below = "<tr>";
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Column& column = columns[k];
    const std::string attributes = "scope=\"col\" aria-sort=\"none\" data-kind=\"number\"";
    if (column.group.empty()) {
      above += fmt::format("<th rowspan=\"2\" {}>{}</th>", attributes, button(column.title, column.spoken));
      continue;
    }
    if (k == 0 || columns[k - 1].group != column.group) {
      const auto width = std::count_if(columns.begin(), columns.end(),
                                       [&](const Column& other) { return other.group == column.group; });
      above += fmt::format("<th colspan=\"{}\" scope=\"colgroup\" class=\"group\">{}</th>", width,
                           xml_escaped(column.group));
    }
    below += fmt::format("<th {}>{}</th>", attributes, button(column.title, column.spoken));
  }
  return "<thead>\n" + above + "</tr>\n" + below + "</tr>\n</thead>\n";
}

// The lowest finite value of a column among a material's fits; nothing where there is no choice.
std::optional<double> best_of(const ReportMaterial& material, const Column& column) {
  double best = std::numeric_limits<double>::infinity();
  int count = 0;
  for (const ReportFit& fit : material.fits) {
    const std::optional<double> value = column.value(fit);
    if (!value || !std::isfinite(*value)) continue;
    best = std::min(best, *value);
    ++count;
  }
  return column.is_error && count > 1 ? std::optional(best) : std::nullopt;
}

std::string number_cell(std::optional<double> value, std::optional<double> best) {
  if (!value) return "<td class=\"missing\" data-value=\"\">–</td>";
  if (best && *value == *best) {
    return fmt::format(
        "<td class=\"best\" data-value=\"{}\">{}<span class=\"mark\" aria-hidden=\"true\">★</span>"
        "<span class=\"unseen\"> (best)</span></td>",
        exact(*value), shown(*value));
  }
  return fmt::format("<td data-value=\"{}\">{}</td>", exact(*value), shown(*value));
}

std::string body_html(const Report& report, const std::vector<Column>& columns) {
  std::string html = "<tbody>\n";
  for (std::size_t m = 0; m < report.materials.size(); ++m) {
    const ReportMaterial& material = report.materials[m];
    std::vector<std::optional<double>> best;
    for (const Column& column : columns) best.push_back(best_of(material, column));
    for (std::size_t f = 0; f < material.fits.size(); ++f) {
      const ReportFit& fit = material.fits[f];
      const std::string name = xml_escaped(material.name);
      const std::string model = xml_escaped(fit.model);
      html += fmt::format(
          "<tr data-section=\"{0}\"><th scope=\"row\" class=\"name\" data-value=\"{1}\">"
          "<a href=\"#{0}\">{1}</a></th>"
          "<td class=\"text\" data-value=\"{2}\"><a href=\"#{3}\">{2}</a></td>",
          section_id(m), name, model, fit_id(m, f));
      for (std::size_t k = 0; k < columns.size(); ++k) html += number_cell(columns[k].value(fit), best[k]);
      html += "</tr>\n";
    }
  }
  return html + "</tbody>\n";
}

// All fits of one model.
struct ModelFits {
  std::string model;
  std::vector<const ReportFit*> fits;
};

std::vector<ModelFits> by_model(const Report& report) {
  std::vector<ModelFits> models;
  for (const ReportMaterial& material : report.materials) {
    for (const ReportFit& fit : material.fits) {
      auto place = std::find_if(models.begin(), models.end(),
                                [&](const ModelFits& entry) { return entry.model == fit.model; });
      if (place == models.end()) place = models.insert(models.end(), {fit.model, {}});
      place->fits.push_back(&fit);
    }
  }
  return models;
}

// A mean, with the number of values where some fits have none.
std::string mean_cell(const ModelFits& model, const Column& column) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const ReportFit* fit : model.fits) {
    const std::optional<double> value = column.value(*fit);
    if (!value || !std::isfinite(*value)) continue;
    sum += *value;
    ++count;
  }
  if (count == 0) return "<td class=\"missing\">–</td>";
  const std::string note = count == model.fits.size() ? "" : fmt::format(" <small>of {}</small>", count);
  return fmt::format("<td>{}{}</td>", shown(sum / static_cast<double>(count)), note);
}

std::string means_html(const Report& report, const std::vector<Column>& columns) {
  if (report.materials.size() < 2) return "";
  std::string html = "<tfoot>\n";
  for (const ModelFits& model : by_model(report)) {
    html += fmt::format("<tr><th scope=\"row\" class=\"name\">mean of {}</th><td class=\"text\">{}</td>",
                        model.fits.size(), xml_escaped(model.model));
    for (const Column& column : columns) html += mean_cell(model, column);
    html += "</tr>\n";
  }
  return html + "</tfoot>\n";
}

}  // namespace

std::string summary_html(const Report& report) {
  const std::vector<Column> columns = make_columns(report);
  if (columns.empty()) return "<p>There are no fitted materials.</p>\n";
  return "<p class=\"legend\" id=\"legend\">Lower is better in all measures; ★ marks the lowest of a "
         "material. "
         "The titles sort the table.</p>\n"
         "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Table of results\">\n"
         "<table class=\"results\" id=\"table\" aria-describedby=\"legend\">\n" +
         head_html(columns) + body_html(report, columns) + means_html(report, columns) + "</table>\n</div>\n";
}

}  // namespace brdfit::render
