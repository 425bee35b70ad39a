// The page of `brdfit cost`.
#include "cli/cost/cost_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/cost/error_keys.h"
#include "cli/cost/paired_timing.h"
#include "cli/version.h"
#include "render/cost_plot.h"
#include "render/report/cost.h"
#include "render/report/html.h"
#include "render/svg.h"

namespace brdfit::cli {
namespace {

using render::exact;
using render::shown;
using render::xml_escaped;

// More runs than that begin folded.
constexpr std::size_t kMostUnfolded = 6;

// The words for what differs between kinds of runs.
struct Words {
  std::string make;
  std::string evaluation;
  std::string bytes;
};

Words words_of(const CostRun& run) {
  if (run.kind == "stack") {
    return {"CPU seconds to bake", "ns per texel and light", "bytes per texel"};
  }
  return {"seconds to fit", "ns per evaluation", "bytes per material"};
}

std::string number_or_dash(double value) {
  return std::isfinite(value) ? shown(value) : "–";
}

double median_of(const RepeatedTime& time) {
  return time.is_measured() ? time.median : kNotMeasured;
}

// What is said of a point wherever it is pointed at.
std::string title_of(const CostPoint& point, const CostRun& run) {
  const Words words = words_of(run);
  std::string text = fmt::format("{} ({}): {} {}", point.name, point.sweep, error_title(run.leading_error),
                                 number_or_dash(error_of(point, run.leading_error)));
  if (std::isfinite(median_of(point.make_seconds))) {
    text += fmt::format(", {} {}", shown(median_of(point.make_seconds)), words.make);
  }
  if (std::isfinite(median_of(point.evaluation_ns))) {
    text += fmt::format(", {} {}", shown(median_of(point.evaluation_ns)), words.evaluation);
  }
  if (std::isfinite(point.bytes)) text += fmt::format(", {} {}", shown(point.bytes), words.bytes);
  return text;
}

render::PlotSpread spread_of(const RepeatedTime& time) {
  if (!time.is_measured() || !std::isfinite(time.low_quartile) || !std::isfinite(time.high_quartile)) {
    return render::PlotSpread::of(median_of(time));
  }
  return {time.median, std::min(time.low_quartile, time.median), std::max(time.high_quartile, time.median)};
}

// The sweeps of runs in the order in which they are first met.
std::vector<std::string> sweeps_of(const std::vector<CostPoint>& points) {
  std::vector<std::string> sweeps;
  for (const CostPoint& point : points) {
    if (std::ranges::find(sweeps, point.sweep) == sweeps.end()) sweeps.push_back(point.sweep);
  }
  return sweeps;
}

std::size_t index_in(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}

render::CostPlot empty_plot(const CostRun& run, std::string title, std::string cost_name) {
  render::CostPlot plot;
  plot.title = std::move(title);
  plot.cost_name = std::move(cost_name);
  plot.error_name = error_title(run.leading_error);
  plot.series = sweeps_of(run.points);
  return plot;
}

render::CostPlotPoint plot_point(const CostRun& run, std::size_t k, const std::vector<std::string>& series,
                                 const render::PlotSpread& cost) {
  const CostPoint& point = run.points[k];
  return {title_of(point, run),
          index_in(series, point.sweep),
          cost,
          render::PlotSpread::of(error_of(point, run.leading_error)),
          false,
          fmt::format("p{}", k)};
}

render::CostPlot plot_against(const CostRun& run, const std::string& cost_name, RepeatedTime CostPoint::*time,
                              bool CostPoint::*is_on_front) {
  render::CostPlot plot =
      empty_plot(run, fmt::format("{}: error against {}", run.input, cost_name), cost_name);
  for (std::size_t k = 0; k < run.points.size(); ++k) {
    plot.points.push_back(plot_point(run, k, plot.series, spread_of(run.points[k].*time)));
    plot.points.back().is_on_front = run.points[k].*is_on_front;
  }
  return plot;
}

// Whether the k-th point is drawn and none other beats it; of points that are alike the first.
bool is_unbeaten(const render::CostPlot& plot, std::size_t k) {
  const render::CostPlotPoint& point = plot.points[k];
  if (!render::is_drawable(point)) return false;
  for (std::size_t j = 0; j < plot.points.size(); ++j) {
    const render::CostPlotPoint& other = plot.points[j];
    const double cost = other.cost.middle - point.cost.middle;
    const double error = other.error.middle - point.error.middle;
    const bool is_better = cost < 0.0 || error < 0.0 || j < k;
    if (render::is_drawable(other) && cost <= 0.0 && error <= 0.0 && is_better) return false;
  }
  return true;
}

void mark_front(render::CostPlot& plot) {
  for (std::size_t k = 0; k < plot.points.size(); ++k) plot.points[k].is_on_front = is_unbeaten(plot, k);
}

// Without devices, which differ in time alone. names: filled with those of the points.
render::CostPlot bytes_plot(const CostRun& run, std::vector<std::string>& names) {
  const std::string cost_name = words_of(run).bytes;
  render::CostPlot plot =
      empty_plot(run, fmt::format("{}: error against {}", run.input, cost_name), cost_name);
  for (std::size_t k = 0; k < run.points.size(); ++k) {
    const CostPoint& point = run.points[k];
    if (point.sweep == "device") continue;
    names.push_back(point.name);
    plot.points.push_back(plot_point(run, k, plot.series, render::PlotSpread::of(point.bytes)));
  }
  mark_front(plot);
  return plot;
}

// What a point is compared with: of effects, the same without any; else the point around which the others
// lie, or the first of its sweep where there is none.
const CostPoint& compared_with(const CostPoint& point, const CostRun& run) {
  const CostPoint* before = nullptr;
  for (const CostPoint& other : run.points) {
    if (before == nullptr && (other.sweep == "default" || other.sweep == point.sweep)) before = &other;
    if (before != nullptr && before->sweep != "default" && other.sweep == "default") before = &other;
  }
  if (point.sweep != "effects") return *before;
  auto without = point.settings;
  for (auto& [key, value] : without) {
    if (key == "effects") value = "none";
  }
  const auto found = std::ranges::find(run.points, without, &CostPoint::settings);
  return found == run.points.end() || &*found == &point ? *before : *found;
}

std::string less_or_more(double value, const std::string& unit) {
  return fmt::format("{}{} {}", number_or_dash(std::abs(value)), unit, value < 0.0 ? "less" : "more");
}

// What a point gains over what it is compared with, and what it costs more.
render::CostPlot gain_plot(const CostRun& run) {
  const Words words = words_of(run);
  render::CostPlot plot = empty_plot(run, run.input + ": what each choice gains against what it costs",
                                     words.evaluation + " more");
  plot.error_name = "% less " + error_title(run.leading_error);
  plot.with_zero = true;
  for (std::size_t k = 0; k < run.points.size(); ++k) {
    const CostPoint& point = run.points[k];
    const CostPoint& before = compared_with(point, run);
    if (&before == &point || point.sweep == "device") continue;
    const double gain =
        100.0 * (1.0 - error_of(point, run.leading_error) / error_of(before, run.leading_error));
    const double extra = median_of(point.evaluation_ns) - median_of(before.evaluation_ns);
    plot.points.push_back({fmt::format("{} ({}) against {}: {} {}, {}", point.name, point.sweep, before.name,
                                       less_or_more(-gain, "%"), error_title(run.leading_error),
                                       less_or_more(extra, " " + words.evaluation)),
                           index_in(plot.series, point.sweep), render::PlotSpread::of(extra),
                           render::PlotSpread::of(gain), false, fmt::format("p{}", k)});
  }
  return plot;
}

// A figure with its plot, the front as a list and what is not drawn; empty where nothing is drawn.
std::string figure_html(const render::CostPlot& plot, const std::vector<std::string>& names) {
  const std::string svg = render::cost_plot(plot);
  if (svg.empty()) return "";
  std::string html =
      "<figure>\n" + svg +
      "<p class=\"named quiet\">A point that is pointed at, or reached by Tab and arrow keys, is "
      "named here.</p>\n<figcaption>" +
      xml_escaped(plot.title);
  const auto left_out =
      std::ranges::count_if(plot.points, [](const auto& point) { return !render::is_drawable(point); });
  if (left_out > 0)
    html += fmt::format(". Not drawn, as a figure is missing: {} of {}", left_out, plot.points.size());
  const std::vector<std::size_t> front = render::front_of(plot);
  html += front.empty() ? ".</figcaption>\n" : ". On the front:</figcaption>\n<ol class=\"front-list\">\n";
  for (const std::size_t k : front) html += "<li>" + xml_escaped(names[k]) + "</li>\n";
  if (!front.empty()) html += "</ol>\n";
  return html + "</figure>\n";
}

std::string plots_html(const CostRun& run) {
  const Words words = words_of(run);
  std::vector<std::string> names;
  std::set<double> bytes;
  for (const CostPoint& point : run.points) {
    names.push_back(point.name);
    if (std::isfinite(point.bytes)) bytes.insert(point.bytes);
  }
  std::string html = "<div class=\"plots\">\n";
  html +=
      figure_html(plot_against(run, words.make, &CostPoint::make_seconds, &CostPoint::on_make_front), names);
  html += figure_html(
      plot_against(run, words.evaluation, &CostPoint::evaluation_ns, &CostPoint::on_run_front), names);
  if (bytes.size() > 1) {
    names.clear();
    const render::CostPlot plot = bytes_plot(run, names);
    html += figure_html(plot, names);
  }
  html += figure_html(gain_plot(run), {});
  return html + "</div>\n";
}

// A column of the table. spoken: for those who do not see what stands around it.
struct Column {
  std::string title;
  std::string spoken;
  std::function<double(const CostPoint&)> value;
  std::function<const RepeatedTime*(const CostPoint&)> spread = {};
};

std::vector<Column> columns_of(const CostRun& run) {
  std::vector<Column> columns;
  std::vector<std::string> errors = {run.leading_error};
  for (const CostPoint& point : run.points) {
    for (const auto& [name, value] : point.errors) {
      if (std::ranges::find(errors, name) == errors.end()) errors.push_back(name);
    }
  }
  for (const std::string& name : errors) {
    columns.push_back({name, name, [name](const CostPoint& point) { return error_of(point, name); }});
  }
  const Words words = words_of(run);
  columns.push_back({words.make, words.make,
                     [](const CostPoint& point) { return median_of(point.make_seconds); },
                     [](const CostPoint& point) { return &point.make_seconds; }});
  columns.push_back({words.evaluation, words.evaluation,
                     [](const CostPoint& point) { return median_of(point.evaluation_ns); },
                     [](const CostPoint& point) { return &point.evaluation_ns; }});
  columns.push_back({words.bytes, words.bytes, [](const CostPoint& point) { return point.bytes; }});
  columns.push_back(
      {"peak MiB", "peak memory in MiB", [](const CostPoint& point) { return point.peak_mib; }});
  std::erase_if(columns, [&](const Column& column) {
    return std::ranges::none_of(run.points,
                                [&](const CostPoint& point) { return std::isfinite(column.value(point)); });
  });
  return columns;
}

std::string title_cell(const std::string& title, const std::string& spoken, bool is_number,
                       std::string_view css_class) {
  return fmt::format(
      "<th scope=\"col\" aria-sort=\"none\" class=\"{}\" data-kind=\"{}\"><button type=\"button\" "
      "aria-label=\"{}\">{}</button></th>",
      css_class, is_number ? "number" : "text", xml_escaped(spoken), xml_escaped(title));
}

std::string number_cell(const Column& column, const CostPoint& point) {
  const double value = column.value(point);
  if (!std::isfinite(value)) return "<td class=\"missing\" data-value=\"\">–</td>";
  std::string note;
  if (column.spread) {
    const RepeatedTime& time = *column.spread(point);
    if (time.repeats > 1) {
      note = fmt::format(" title=\"{} to {}: the middle half of {} repeats\"", shown(time.low_quartile),
                         shown(time.high_quartile), time.repeats);
    }
  }
  return fmt::format("<td data-value=\"{}\"{}>{}</td>", exact(value), note, shown(value));
}

std::string front_words(const CostPoint& point) {
  if (point.on_make_front && point.on_run_front) return "make, run";
  return point.on_make_front ? "make" : point.on_run_front ? "run" : "";
}

std::string settings_text(const CostPoint& point) {
  std::string text;
  for (const auto& [name, value] : point.settings) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, value);
  }
  return text;
}

std::string row_html(const CostPoint& point, std::size_t k, const std::vector<Column>& columns) {
  const auto text_cell = [](const std::string& text, std::string_view css_class) {
    return fmt::format("<td class=\"{}\" data-value=\"{}\">{}</td>", css_class, xml_escaped(text),
                       xml_escaped(text));
  };
  std::string html =
      fmt::format("<tr data-point=\"p{0}\"><th scope=\"row\" class=\"name\" data-value=\"{1}\">{1}</th>", k,
                  xml_escaped(point.name));
  html += text_cell(point.sweep, "text");
  for (const Column& column : columns) html += number_cell(column, point);
  html += text_cell(front_words(point), "text") + text_cell(settings_text(point), "settings");
  return html + "</tr>\n";
}

std::string table_html(const CostRun& run) {
  const std::vector<Column> columns = columns_of(run);
  std::string html = fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"All points of {}\">\n"
      "<table class=\"results\"><thead><tr>",
      xml_escaped(run.input));
  html += title_cell("point", "point", false, "name") + title_cell("sweep", "sweep", false, "text");
  for (const Column& column : columns) html += title_cell(column.title, column.spoken, true, "");
  html += title_cell("front", "front", false, "text") + title_cell("settings", "settings", false, "settings");
  html += "</tr></thead>\n<tbody>\n";
  for (std::size_t k = 0; k < run.points.size(); ++k) html += row_html(run.points[k], k, columns);
  return html + "</tbody></table>\n</div>\n";
}

std::string run_html(const CostRun& run, bool is_open) {
  std::string html = fmt::format("<section class=\"run\">\n<details{}><summary><h2>{}</h2></summary>\n",
                                 is_open ? " open=\"\"" : "", xml_escaped(run.input));
  html += fmt::format("<p class=\"legend\">{} points. The error is {}: lower is better.", run.points.size(),
                      xml_escaped(error_title(run.leading_error)));
  if (std::isfinite(run.reference_seconds.median) && run.reference_seconds.median > 0.0) {
    html += fmt::format(
        " A fixed workload, by which figures of other machines can be compared, took {} ms ({} to {}) "
        "between "
        "the points.",
        shown(1e3 * run.reference_seconds.median), shown(1e3 * run.reference_seconds.low_quartile),
        shown(1e3 * run.reference_seconds.high_quartile));
  }
  html +=
      " Bars are the middle half of repeats; no other point has less error for as little cost as those on "
      "the front.</p>\n";
  return html + plots_html(run) + table_html(run) + "</details>\n</section>\n";
}

render::PlotSpread spread_of(const std::vector<double>& values) {
  return {quantile_of(values, 0.5), quantile_of(values, 0.25), quantile_of(values, 0.75)};
}

// The same point in all runs.
struct Across {
  std::string sweep;
  std::vector<double> errors;  // relative to the least of the run
  std::vector<double> make_seconds;
  std::vector<double> evaluation_ns;
};

void keep_finite(std::vector<double>& values, double value) {
  if (std::isfinite(value)) values.push_back(value);
}

void collect(const CostRun& run, std::vector<std::string>& order, std::map<std::string, Across>& points) {
  double least = std::numeric_limits<double>::infinity();
  for (const CostPoint& point : run.points) {
    const double error = error_of(point, run.leading_error);
    if (std::isfinite(error)) least = std::min(least, error);
  }
  for (const CostPoint& point : run.points) {
    const double error = error_of(point, run.leading_error) / least;
    if (!std::isfinite(error)) continue;
    const auto [place, is_new] = points.try_emplace(point.name, Across{point.sweep, {}, {}, {}});
    if (is_new) order.push_back(point.name);
    place->second.errors.push_back(error);
    keep_finite(place->second.make_seconds, median_of(point.make_seconds));
    keep_finite(place->second.evaluation_ns, median_of(point.evaluation_ns));
  }
}

render::CostPlot across_plot(const std::string& title, const std::string& cost_name,
                             const std::vector<std::string>& order,
                             const std::map<std::string, Across>& points, std::vector<double> Across::*cost) {
  render::CostPlot plot;
  plot.title = title;
  plot.cost_name = cost_name;
  plot.error_name = "error over the least of the input";
  for (const std::string& name : order) {
    const Across& point = points.at(name);
    const std::vector<double>& costs = point.*cost;
    if (std::ranges::find(plot.series, point.sweep) == plot.series.end()) plot.series.push_back(point.sweep);
    const render::PlotSpread across = costs.empty() ? render::PlotSpread::of(kNotMeasured) : spread_of(costs);
    const render::PlotSpread upwards = spread_of(point.errors);
    plot.points.push_back(
        {fmt::format("{} ({}): median {} times the least error, {} {}, over {} inputs", name, point.sweep,
                     shown(upwards.middle), number_or_dash(across.middle), cost_name, point.errors.size()),
         index_in(plot.series, point.sweep), across, upwards, false, name});
  }
  mark_front(plot);
  return plot;
}

std::string across_html(std::span<const CostRun> runs) {
  std::vector<std::string> order;
  std::map<std::string, Across> points;
  for (const CostRun& run : runs) collect(run, order, points);
  if (order.empty()) return "";
  const Words words = words_of(runs.front());
  std::string html = fmt::format(
      "<section class=\"run\">\n<h2>All inputs</h2>\n<p class=\"legend\">Medians over {} inputs; bars reach "
      "from "
      "the lower to the upper quartile.</p>\n<div class=\"plots\">\n",
      runs.size());
  html += figure_html(across_plot("All inputs: error against " + words.make, words.make, order, points,
                                  &Across::make_seconds),
                      order);
  html += figure_html(across_plot("All inputs: error against " + words.evaluation, words.evaluation, order,
                                  points, &Across::evaluation_ns),
                      order);
  return html + "</div>\n</section>\n";
}

std::string list_html(std::span<const std::string> sentences) {
  if (sentences.empty()) return "";
  std::string html = "<ul class=\"sentences\">\n";
  for (const std::string& sentence : sentences) html += "<li>" + xml_escaped(sentence) + "</li>\n";
  return html + "</ul>\n";
}

}  // namespace

std::string cost_page(std::span<const CostRun> runs, std::span<const std::string> sentences) {
  const std::string what = runs.size() == 1 ? runs.front().input : fmt::format("{} inputs", runs.size());
  std::string html =
      fmt::format("<header>\n<h1>What accuracy costs: {}</h1>\n<p>brdfit {}.</p>\n</header>\n<main>\n",
                  xml_escaped(what), xml_escaped(kVersion)) +
      list_html(sentences);
  if (runs.size() > 1) html += across_html(runs);
  for (const CostRun& run : runs) html += run_html(run, runs.size() <= kMostUnfolded);
  return render::cost_page_html("What accuracy costs: " + what, kVersion, html + "</main>\n");
}

}  // namespace brdfit::cli
