// The page of costs says what it was given, and nothing in it can be taken for markup.
#include "cli/cost/cost_page.h"

#include <gmock/gmock.h>

#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "tests/cost_page_data.h"
#include "tests/xml_reader.h"

namespace brdfit::cli {
namespace {

using testing::HasSubstr;
using testing::Not;
using tests::made_up_run;
using tests::XmlReader;

std::size_t count_of(const std::string& html, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = html.find(word); at != std::string::npos; at = html.find(word, at + 1)) ++count;
  return count;
}

std::vector<std::string> plots_of(const std::string& html) {
  std::vector<std::string> plots;
  for (std::size_t at = html.find("<svg"); at != std::string::npos; at = html.find("<svg", at + 1)) {
    plots.push_back(html.substr(at, html.find("</svg>", at) + 6 - at));
  }
  return plots;
}

std::string page_of(const CostRun& run) {
  return cost_page(std::vector<CostRun>{run}, std::vector<std::string>{});
}

TEST(CostPage, IsOneFileThatLoadsNothing) {
  const std::string html =
      cost_page(std::vector<CostRun>{made_up_run(60)}, std::vector<std::string>{"One.", "Two."});
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>\n<html lang=\"en\">"));
  EXPECT_TRUE(html.ends_with("</html>\n"));
  EXPECT_THAT(html, HasSubstr("default-src 'none';"));
  EXPECT_EQ(count_of(html, "<link"), 0U);
  EXPECT_EQ(count_of(html, "src="), 0U);
  EXPECT_EQ(count_of(html, "<script"), 1U);
  EXPECT_THAT(html, HasSubstr("<li>One.</li>\n<li>Two.</li>"));
}

TEST(CostPage, PlotsAreWellFormedAndTheBodyTooAndEveryPointStandsInBothPlotsAndTheTable) {
  const CostRun run = made_up_run(60);
  const std::string html = page_of(run);
  const std::size_t begin = html.find("<main>");
  EXPECT_NO_THROW(XmlReader(html.substr(begin, html.find("</main>") + 7 - begin)));
  const std::vector<std::string> plots = plots_of(html);
  ASSERT_EQ(plots.size(), 3U);
  for (const CostPoint& point : run.points) {
    const std::string label = "aria-label=\"" + point.name + " (" + point.sweep + "): ";
    EXPECT_EQ(count_of(plots[0], label), 1U) << point.name;
    EXPECT_EQ(count_of(plots[1], label), 1U) << point.name;
    EXPECT_EQ(count_of(html, "data-value=\"" + point.name + "\">"), 1U) << point.name;
  }
}

TEST(CostPage, FrontsAreThoseOfTheRun) {
  CostRun run = made_up_run(12);
  for (CostPoint& point : run.points) point.on_make_front = point.on_run_front = false;
  run.points[2].on_make_front = true;
  run.points[5].on_run_front = run.points[7].on_run_front = true;
  const std::string html = page_of(run);
  const std::vector<std::string> plots = plots_of(html);
  EXPECT_EQ(count_of(plots[0], "\"point at-front\""), 1U);
  EXPECT_EQ(count_of(plots[1], "\"point at-front\""), 2U);
  EXPECT_EQ(count_of(html, "<li>"), 3U);
  EXPECT_THAT(html, HasSubstr("<li>" + run.points[2].name + "</li>"));
  EXPECT_EQ(count_of(html, ">make</td>"), 1U);
  EXPECT_EQ(count_of(html, ">run</td>"), 2U);
}

TEST(CostPage, GainsAreThoseOverTheDefaultOrTheFirstOfTheSweep) {
  CostRun run = made_up_run(2);
  run.points[1].sweep = run.points[0].sweep = "effects";
  run.points[0].errors[0].second = 20.0;
  run.points[1].errors[0].second = 15.0;
  run.points[0].evaluation_ns.median = 8.0;
  run.points[1].evaluation_ns.median = 11.0;
  const std::vector<std::string> plots = plots_of(page_of(run));
  ASSERT_EQ(plots.size(), 3U);
  EXPECT_EQ(count_of(plots[2], "data-point="), 1U);
  EXPECT_THAT(plots[2], HasSubstr(run.points[1].name + " (effects) against " + run.points[0].name +
                                  ": 25% less held-out log-ratio %, 3 ns per evaluation more"));
  // A default, wherever it stands, is what all others are compared with.
  run = made_up_run(9);
  run.points[4].sweep = "default";
  const std::string gains = plots_of(page_of(run)).at(2);
  EXPECT_EQ(count_of(gains, " against " + run.points[4].name + ": "), 2 * 8U);
}

TEST(CostPage, FiguresThatAreMissingAreDashesAndNotDrawn) {
  CostRun run = made_up_run(6);
  run.points[1].evaluation_ns = {};
  run.points[2].errors.pop_back();
  for (CostPoint& point : run.points) point.peak_mib = std::numeric_limits<double>::quiet_NaN();
  const std::string html = page_of(run);
  EXPECT_THAT(html, HasSubstr("Not drawn, as a figure is missing: 1 of 6"));
  EXPECT_EQ(count_of(html, "<td class=\"missing\" data-value=\"\">–</td>"), 2U);
  EXPECT_THAT(html, Not(HasSubstr("peak MiB")));
  EXPECT_THAT(html, Not(HasSubstr("not finite")));
}

TEST(CostPage, BytesHaveAPlotWherePointsDifferInThem) {
  CostRun run = made_up_run(9);
  EXPECT_EQ(plots_of(page_of(run)).size(), 3U);
  run.kind = "stack";
  run.points[3].bytes = 8.0;
  run.points[5].sweep = "device";
  const std::vector<std::string> plots = plots_of(page_of(run));
  ASSERT_EQ(plots.size(), 4U);
  EXPECT_THAT(plots[2], HasSubstr(">bytes per texel</text>"));
  // A device differs in time alone, and gains nothing.
  EXPECT_EQ(count_of(plots[1], "data-point=\"p5\""), 1U);
  EXPECT_EQ(count_of(plots[2], "data-point="), 8U);
  EXPECT_EQ(count_of(plots[2], "data-point=\"p5\"") + count_of(plots[3], "data-point=\"p5\""), 0U);
}

TEST(CostPage, SeveralInputsHaveTheirMediansBesideASectionEach) {
  std::vector<CostRun> runs = {made_up_run(5, "a.binary"), made_up_run(5, "b.binary"),
                               made_up_run(5, "c.binary")};
  // The least errors of all runs are the same, so that what is compared is known.
  runs[0].points[1].errors[0].second *= 1.5;
  runs[2].points[1].errors[0].second *= 0.9;
  double least = std::numeric_limits<double>::infinity();
  for (const CostPoint& point : runs[1].points) least = std::min(least, point.errors[0].second);
  const std::string html = cost_page(runs, std::vector<std::string>{});
  EXPECT_EQ(count_of(html, "<section class=\"run\">"), 4U);
  EXPECT_EQ(count_of(html, "<h2>All inputs</h2>"), 1U);
  for (const CostRun& run : runs) EXPECT_EQ(count_of(html, "<h2>" + run.input + "</h2>"), 1U);
  const std::string plot = plots_of(html).at(0);
  std::smatch found;
  ASSERT_TRUE(std::regex_search(
      plot, found,
      std::regex(runs[0].points[1].name + R"( \(\w+\): median ([0-9.]+) times the least error)")));
  EXPECT_NEAR(std::stod(found[1]), runs[1].points[1].errors[0].second / least, 0.006);
}

TEST(CostPage, HostileTextIsShownAndNotRun) {
  const std::string bad = R"(</script><script>alert("1")</script>'&amp;<img src=x onerror=y>)";
  CostRun run = made_up_run(3);
  run.input = run.leading_error = bad;
  for (CostPoint& point : run.points) {
    point.name += bad;
    point.sweep = bad;
    point.settings = {{bad, bad}};
    point.errors[0].first = point.errors[1].first = bad;
  }
  const std::string html = cost_page(std::vector<CostRun>{run, run}, std::vector<std::string>{bad});
  EXPECT_EQ(count_of(html, "<script"), 1U);
  EXPECT_EQ(count_of(html, "</script"), 1U);
  EXPECT_EQ(count_of(html, "<img"), 0U);
  for (const std::string& plot : plots_of(html)) EXPECT_NO_THROW(XmlReader{plot});
}

}  // namespace
}  // namespace brdfit::cli
