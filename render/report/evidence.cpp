// Losses and correlations.
#include "render/report/evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/report/html.h"
#include "render/svg.h"

namespace brdfit::render {
namespace {

// More pairs than that are folded away.
constexpr std::size_t kMostPairs = 4;

// All with the same digits, as they stand below each other.
std::string shown_delta_e(double delta_e) {
  return fmt::format("{:.2f}", delta_e);
}

// Which won and by how much. The kept one leads the list.
std::string verdict(const std::vector<ReportLoss>& losses) {
  if (!losses.front().is_kept || losses.size() < 2) return "";
  const ReportLoss& kept = losses[0];
  const ReportLoss& next = losses[1];
  const std::string name = xml_escaped(kept.name);
  if (!(next.sphere_delta_e > kept.sphere_delta_e)) {
    return fmt::format("<b>{}</b> was kept, the first of equals", name);
  }
  const double gain = next.sphere_delta_e - kept.sphere_delta_e;
  return fmt::format("<b>{}</b> was kept: ΔE {} less ({}%) than the next, {}", name, shown_delta_e(gain),
                     fmt::format("{:.1f}", 100.0 * gain / next.sphere_delta_e), xml_escaped(next.name));
}

std::string pair_html(const ReportCorrelation& pair) {
  return fmt::format("<li>{} and {} <span class=\"number\">({})</span></li>\n", breakable(pair.first),
                     breakable(pair.second), fmt::format("{:+.3f}", pair.correlation));
}

}  // namespace

std::string losses_html(const ReportFit& fit) {
  std::vector<ReportLoss> losses = fit.losses;
  std::erase_if(losses, [](const ReportLoss& loss) { return !std::isfinite(loss.sphere_delta_e); });
  if (losses.empty()) return "";
  std::ranges::stable_sort(losses, [](const ReportLoss& a, const ReportLoss& b) {
    return a.is_kept != b.is_kept ? a.is_kept : a.sphere_delta_e < b.sphere_delta_e;
  });
  double largest = 0.0;
  for (const ReportLoss& loss : losses) largest = std::max(largest, loss.sphere_delta_e);
  std::string html = fmt::format(
      "<table class=\"losses\"><caption>Losses by the sphere ΔE of their results. {}</caption>\n"
      "<thead class=\"unseen\"><tr><th scope=\"col\">loss</th><th scope=\"col\">sphere ΔE</th></tr></thead>\n"
      "<tbody>\n",
      verdict(losses));
  for (const ReportLoss& loss : losses) {
    html += fmt::format(
        "<tr{}><th scope=\"row\">{}{}</th><td><i class=\"bar\" style=\"width:{:.1f}%\"></i>"
        "<span>{}</span></td></tr>\n",
        loss.is_kept ? " class=\"kept\"" : "", xml_escaped(loss.name),
        loss.is_kept ? "<span class=\"unseen\"> (kept)</span>" : "",
        largest > 0.0 ? 70.0 * loss.sphere_delta_e / largest : 0.0, shown_delta_e(loss.sphere_delta_e));
  }
  return html + "</tbody></table>\n";
}

std::string correlated_html(const ReportFit& fit) {
  if (fit.correlated.empty()) return "";
  std::vector<ReportCorrelation> pairs = fit.correlated;
  std::ranges::stable_sort(pairs, std::ranges::greater{},
                           [](const ReportCorrelation& pair) { return std::abs(pair.correlation); });
  std::string html =
      "<div class=\"correlated\"><p>Hardly told apart by the samples (correlation of their "
      "estimates):</p>\n<ul>\n";
  for (std::size_t k = 0; k < std::min(pairs.size(), kMostPairs); ++k) html += pair_html(pairs[k]);
  html += "</ul>\n";
  if (pairs.size() > kMostPairs) {
    html += fmt::format("<details><summary>{} more</summary><ul>\n", pairs.size() - kMostPairs);
    for (std::size_t k = kMostPairs; k < pairs.size(); ++k) html += pair_html(pairs[k]);
    html += "</ul></details>\n";
  }
  return html + "</div>\n";
}

}  // namespace brdfit::render
