// The ladder of a fit.
#include "render/report/ladder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/ladder_plot.h"
#include "render/report/html.h"
#include "render/report/picture.h"
#include "render/svg.h"

namespace brdfit::render {
namespace {

std::string in_words(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return xml_escaped(name);
}

// The effect among others that a group refines; null where it is not there.
const std::string* refined_by(const std::string& group, const std::vector<std::string>& groups) {
  for (const std::string& effect : groups) {
    if (group.starts_with(effect + "_")) return &effect;
  }
  return nullptr;
}

// "diffuse fresnel (tint, tangent falloff), retroreflection"
std::string names_html(const std::vector<std::string>& groups) {
  std::string names;
  for (const std::string& effect : groups) {
    if (refined_by(effect, groups) != nullptr) continue;
    std::string refinements;
    for (const std::string& group : groups) {
      if (refined_by(group, groups) != &effect) continue;
      refinements += (refinements.empty() ? " (" : ", ") + in_words(group.substr(effect.size() + 1));
    }
    if (!refinements.empty()) refinements += ')';
    names += (names.empty() ? "" : ", ") + in_words(effect) + refinements;
  }
  return names;
}

std::string groups_html(const ReportRung& rung, bool is_first) {
  const std::string names = names_html(rung.groups);
  if (is_first) return names.empty() ? " Lambert + GGX" : " held on: " + names;
  return (rung.is_removal ? "&nbsp;− " : "&nbsp;+ ") + names;
}

// "−4.10 ± 0.31"
std::string difference_text(double difference, std::optional<double> standard_error) {
  std::string text = fmt::format("{}{:.2f}", difference < 0.0 ? "−" : "+", std::abs(difference));
  if (standard_error) text += fmt::format(" ± {:.2f}", *standard_error);
  return text;
}

std::string rung_html(const ReportLadder& ladder, std::size_t k) {
  const ReportRung& rung = ladder.rungs[k];
  std::string html = fmt::format("<li class=\"{}\">", rung.is_removal ? "rung removed" : "rung");
  if (!rung.slice.png.empty()) html += image_html(rung.slice);
  if (!rung.difference.png.empty()) html += image_html(rung.difference);
  html += fmt::format("<p><b class=\"at-rung\">{}</b>{}</p>", k, groups_html(rung, k == 0));
  html += fmt::format("<p><b>{:.2f}%</b>", rung.held_out_pct);
  if (k > 0) {
    html += fmt::format(
        " <span class=\"number\">{}</span>",
        difference_text(rung.held_out_pct - ladder.rungs[k - 1].held_out_pct, rung.standard_error_pct));
  }
  html += fmt::format("</p><p class=\"quiet\">{} free", rung.free_parameters);
  if (rung.evaluation_ns) html += fmt::format(", {:.1f} ns", *rung.evaluation_ns);
  return html + "</p></li>\n";
}

std::string measured_html(const ReportLadder& ladder) {
  if (ladder.measured.png.empty()) return "";
  std::string html = "<li class=\"rung\">" + image_html(ladder.measured);
  if (!ladder.colour_bar.png.empty()) html += image_html(ladder.colour_bar);
  return html + "<p><b>measured</b></p></li>\n";
}

std::string plot_html(const ReportFit& fit) {
  const ReportLadder& ladder = *fit.ladder;
  std::vector<LadderPoint> points;
  for (const ReportRung& rung : ladder.rungs) {
    points.push_back({rung.held_out_pct, rung.standard_error_pct, rung.evaluation_ns, rung.is_removal});
  }
  ReportPicture plot;
  plot.caption =
      "Held-out error of each rung (whiskers: one standard error of the step; hollow: something "
      "was removed), and what an evaluation costs.";
  plot.alt = fmt::format("Held-out error and cost of each rung of {}", fit.model);
  plot.svg = ladder_plot(plot.alt, points, ladder.held_out_all_pct);
  return plot.svg.empty() ? "" : figure_html(plot);
}

std::string legend_html(const ReportLadder& ladder) {
  const bool has_slices =
      std::ranges::any_of(ladder.rungs, [](const ReportRung& r) { return !r.slice.png.empty(); });
  const bool has_differences =
      std::ranges::any_of(ladder.rungs, [](const ReportRung& r) { return !r.difference.png.empty(); });
  std::string html = "<p class=\"legend\">";
  html += has_slices
              ? "Each slice is the material fitted with the effects up to there"
              : "The file does not hold the materials of the rungs, so that their slices are not drawn";
  if (has_differences) html += "; below it its log-ratio to the measured slice";
  html += ". Errors are held-out log-ratios in %: of cells that no stage of a fit saw";
  if (ladder.held_out_all_pct) {
    html += fmt::format(". With all effects on: {:.2f}%", *ladder.held_out_all_pct);
    if (ladder.free_parameters_all) html += fmt::format(", {} free", *ladder.free_parameters_all);
  }
  return html + ".</p>\n";
}

}  // namespace

std::string ladder_html(const ReportFit& fit) {
  if (!fit.ladder || fit.ladder->rungs.empty()) return "";
  const ReportLadder& ladder = *fit.ladder;
  std::string html =
      fmt::format("<section class=\"ladder\">\n<h3>{}: effects one by one</h3>\n", xml_escaped(fit.model)) +
      legend_html(ladder) + "<div class=\"beside\">\n<ol class=\"rungs\">\n";
  for (std::size_t k = 0; k < ladder.rungs.size(); ++k) html += rung_html(ladder, k);
  return html + measured_html(ladder) + "</ol>\n" + plot_html(fit) + "</div>\n</section>\n";
}

}  // namespace brdfit::render
