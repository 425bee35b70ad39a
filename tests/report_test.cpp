// The report says what it was given, and nothing in it can be taken for markup.
#include "render/report.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <string>

#include "render/report/html.h"
#include "tests/report_data.h"

namespace brdfit::render {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing_support::sample_report;

std::size_t count_of(const std::string& html, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = html.find(word); at != std::string::npos; at = html.find(word, at + 1)) ++count;
  return count;
}

// What stands between two words, the first time.
std::string between(const std::string& html, const std::string& before, const std::string& behind) {
  const std::size_t begin = html.find(before);
  if (begin == std::string::npos) return "(no " + before + ")";
  const std::size_t end = html.find(behind, begin + before.size());
  return html.substr(begin + before.size(), end - begin - before.size());
}

// One material with one fit, to be changed by a test.
Report small_report() {
  Report report;
  report.title = "t";
  report.version = "1";
  ReportMaterial material;
  material.name = "m";
  ReportFit fit;
  fit.model = "Callisto";
  fit.file = "m.callisto.json";
  material.fits.push_back(fit);
  report.materials.push_back(material);
  return report;
}

TEST(Report, IsOneFileThatLoadsNothing) {
  const std::string html = report_html(sample_report(3));
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>\n<html lang=\"en\">"));
  EXPECT_TRUE(html.ends_with("</html>\n"));
  EXPECT_THAT(html, HasSubstr("default-src 'none'; img-src data:;"));
  EXPECT_EQ(count_of(html, "<link"), 0U);
  EXPECT_EQ(count_of(html, "src="), count_of(html, "src=\"data:image/png;base64,"));
  // The name space of SVG is the only address in it.
  EXPECT_EQ(count_of(html, "http"), count_of(html, "xmlns=\"http://www.w3.org/2000/svg\"") + 1U)
      << "the other is http-equiv";
  EXPECT_EQ(count_of(html, "<section class=\"material\""), 3U);
  EXPECT_EQ(count_of(html, "<article class=\"fit\""), 9U);
}

TEST(Report, HostileTextIsShownAndNotRun) {
  const std::string bad = R"(</script><script>alert("1")</script>'&amp;<img src=x onerror=y>)";
  Report report = small_report();
  report.title = report.version = report.command = bad;
  report.warnings = {bad};
  ReportMaterial& material = report.materials[0];
  material.name = bad;
  material.warnings = {bad};
  ReportPicture picture;
  picture.caption = picture.alt = bad;
  picture.png = {1, 2, 3};
  picture.width_px = picture.height_px = 1;
  material.pictures = {picture};
  picture.png.clear();
  picture.svg = "<svg></svg>";
  material.pictures.push_back(picture);
  ReportFit& fit = material.fits[0];
  fit.model = fit.file = bad;
  fit.measures = {{bad, 1.0, 2.0}};
  fit.effects = fit.notes = {bad};
  fit.parameters = {{bad, bad, {0.5}, 0.0, 1.0, 0.5, bad, bad}};
  fit.timings_seconds = {{bad, 1.0}};
  fit.provenance = {{bad, bad}};
  const std::string html = report_html(report);
  EXPECT_EQ(count_of(html, "<script"), 1U);
  EXPECT_EQ(count_of(html, "</script"), 1U);
  EXPECT_EQ(count_of(html, "<img"), 1U);
  EXPECT_THAT(html, Not(HasSubstr("alert(\"1\")")));
  EXPECT_THAT(html, HasSubstr("alert(&quot;1&quot;)&lt;/script&gt;&#39;&amp;amp;"));
}

TEST(Report, NumbersAreAsGiven) {
  Report report = small_report();
  ReportFit& fit = report.materials[0].fits[0];
  fit.free_parameters = 23;
  fit.sphere_delta_e = 1.0 / 3.0;
  fit.measures = {{"slice %", 12.3456789, std::nullopt}};
  fit.timings_seconds = {{"explore", 1.25}, {"refine", 2.0}};
  const std::string html = report_html(report);
  EXPECT_THAT(html, HasSubstr("<td data-value=\"23\">23</td>"));
  EXPECT_THAT(html, HasSubstr("<td data-value=\"0.3333333333333333\">0.333</td>"));
  EXPECT_THAT(html, HasSubstr("<td data-value=\"12.3456789\">12.3</td>"));
  EXPECT_THAT(html, HasSubstr("<td data-value=\"3.25\">3.25</td>"));
}

TEST(Report, SecondsAreThoseOfTheWholeFitWhereItSaysThem) {
  Report report = small_report();
  report.materials[0].fits[0].timings_seconds = {{"explore", 1.25}, {"refine", 2.0}, {"fit", 3.5}};
  EXPECT_THAT(report_html(report), HasSubstr("<td data-value=\"3.5\">3.50</td></tr>"));
}

TEST(Report, ShownNumbersHaveThreeDigits) {
  EXPECT_EQ(shown(0.0), "0");
  EXPECT_EQ(shown(1.0), "1");
  EXPECT_EQ(shown(12345.0), "12345");
  EXPECT_EQ(shown(1.5), "1.50");
  EXPECT_EQ(shown(-15.25), "-15.2");
  EXPECT_EQ(shown(1234.5), "1234");
  EXPECT_EQ(shown(0.1), "0.100");
  EXPECT_EQ(shown(0.01), "0.0100");
  EXPECT_EQ(shown(0.00123456), "0.00123");
  EXPECT_EQ(shown(1e-7), "1e-07");
  EXPECT_EQ(shown(1.5e9), "1.5e+09");
  EXPECT_EQ(shown(std::numeric_limits<double>::quiet_NaN()), "not finite");
  EXPECT_EQ(exact(0.1), "0.1");
  EXPECT_EQ(exact(std::numeric_limits<double>::infinity()), "");
}

TEST(Report, AMissingValueIsADash) {
  Report report = sample_report(1, false);
  report.materials[0].fits[0].measures[0].slice.reset();
  EXPECT_THAT(report_html(report), HasSubstr("<td class=\"missing\" data-value=\"\">–</td>"));
}

TEST(Report, ColumnsWithoutAnyValueAreLeftOut) {
  Report report = small_report();
  EXPECT_EQ(count_of(report_html(report), "aria-sort=\"none\""), 3U);  // material, model, free
  report.materials[0].fits[0].measures = {{"relative", std::nullopt, 1.0},
                                          {"sRGB", std::nullopt, std::nullopt}};
  const std::string html = report_html(report);
  EXPECT_EQ(count_of(html, "aria-sort=\"none\""), 4U);
  EXPECT_THAT(html, HasSubstr("aria-label=\"relative on the table\""));
  EXPECT_THAT(html, Not(HasSubstr("sRGB on the")));
}

TEST(Report, TheLowestOfAMaterialIsMarkedInWordsToo) {
  Report report = small_report();
  auto& fits = report.materials[0].fits;
  fits.resize(3, fits[0]);
  fits[0].sphere_delta_e = 2.0;
  fits[1].sphere_delta_e = 1.0;
  fits[2].sphere_delta_e = std::numeric_limits<double>::quiet_NaN();
  const std::string html = report_html(report);
  EXPECT_EQ(count_of(html, "<td class=\"best\""), 1U);
  EXPECT_THAT(between(html, "<td class=\"best\"", "</td>"), HasSubstr("data-value=\"1\">1<span"));
  EXPECT_THAT(between(html, "<td class=\"best\"", "</td>"), HasSubstr("★"));
  EXPECT_THAT(between(html, "<td class=\"best\"", "</td>"), HasSubstr("(best)"));
}

TEST(Report, OneFitAloneIsNotTheBest) {
  Report report = small_report();
  report.materials[0].fits[0].sphere_delta_e = 2.0;
  EXPECT_THAT(report_html(report), Not(HasSubstr("<td class=\"best\"")));
}

TEST(Report, MeansAreOverTheMaterialsThatHaveAValue) {
  Report report = small_report();
  report.materials.resize(3, report.materials[0]);
  report.materials[0].fits[0].sphere_delta_e = 1.0;
  report.materials[1].fits[0].sphere_delta_e = 4.5;
  const std::string foot = between(report_html(report), "<tfoot>", "</tfoot>");
  EXPECT_THAT(foot, HasSubstr("mean of 3</th><td class=\"text\">Callisto</td><td>0</td>"));
  EXPECT_THAT(foot, HasSubstr("<td>2.75 <small>of 2</small></td>"));
  report.materials.resize(1);
  EXPECT_THAT(report_html(report), Not(HasSubstr("<tfoot>")));
}

TEST(Report, ParametersStandOnTheirRanges) {
  Report report = small_report();
  report.materials[0].fits[0].parameters = {
      {"base_color", "", {0.0, 0.25, 1.0}, 0.0, 1.0, 0.18, "(0, 137, 255)", "ok"},
      {"fresnel", "", {15.0}, 10.0, 20.0, 10.0, "", "at lower bound"},
      {"odd", "", {-1.0}, 0.0, 1.0, 0.5, "", "ok"},
      {"broken", "", {std::numeric_limits<double>::quiet_NaN()}, 0.0, 1.0, 0.5, "", "unidentifiable"},
      {"single", "", {3.0}, 3.0, 3.0, 3.0, "", "fixed"}};
  const std::string html = report_html(report);
  EXPECT_THAT(html, HasSubstr("<i class=\"default\" style=\"left:18.00%\">"));
  EXPECT_THAT(html, HasSubstr("<i class=\"at red\" style=\"left:0.00%\">"));
  EXPECT_THAT(html, HasSubstr("<i class=\"at green\" style=\"left:25.00%\">"));
  EXPECT_THAT(html, HasSubstr("<i class=\"at blue\" style=\"left:100.00%\">"));
  EXPECT_THAT(html, HasSubstr("<i class=\"at only\" style=\"left:50.00%\">"));
  EXPECT_THAT(html, HasSubstr("style=\"background:rgb(0, 137, 255)\""));
  EXPECT_THAT(html, HasSubstr("class=\"status bound\">◂▸&nbsp;at lower bound<"));
  EXPECT_EQ(count_of(html, "outside its range"), 2U);
  EXPECT_THAT(html, HasSubstr("not finite"));
  EXPECT_THAT(html, Not(HasSubstr("left:nan")));
  EXPECT_THAT(html, Not(HasSubstr("left:inf")));
}

// The marks on the range of one parameter.
std::string marks_of(const ReportParameter& parameter) {
  Report report = small_report();
  report.materials[0].fits[0].parameters = {parameter};
  return between(report_html(report), "<span class=\"range", "<span class=\"ends");
}

TEST(Report, ErrorBarsSpan196StandardErrorsToBothSides) {
  // 0.5 +- 0.196 of a range from 0 to 1.
  const std::string marks = marks_of({"x", "", {0.5}, 0.0, 1.0, 0.5, "", "ok", {0.1}});
  EXPECT_THAT(marks, HasSubstr("<i class=\"sure only\" style=\"left:30.40%;width:39.20%\">"));
  EXPECT_THAT(marks, HasSubstr("95% interval 0.304 to 0.696"));
}

TEST(Report, ErrorBarsEndOpenWhereTheyLeaveTheRange) {
  EXPECT_THAT(marks_of({"x", "", {0.1}, 0.0, 1.0, 0.5, "", "ok", {0.1}}),
              HasSubstr("<i class=\"sure only below\" style=\"left:0.00%;width:29.60%\">"));
  EXPECT_THAT(marks_of({"x", "", {30.0}, 10.0, 30.0, 20.0, "", "ok", {5.0}}),
              HasSubstr("<i class=\"sure only beyond\" style=\"left:51.00%;width:49.00%\">"));
  EXPECT_THAT(marks_of({"x", "", {0.4}, 0.0, 1.0, 0.5, "", "ok", {1e300}}),
              HasSubstr("<i class=\"sure only below beyond\" style=\"left:0.00%;width:100.00%\">"));
}

TEST(Report, ErrorBarsAreThoseOfTheChannelsThatHaveOne) {
  const std::string marks =
      marks_of({"c", "", {0.2, 0.5, 0.8}, 0.0, 1.0, 0.5, "", "ok", {0.01, std::nullopt, 0.02}});
  EXPECT_EQ(count_of(marks, "class=\"sure"), 2U);
  EXPECT_EQ(count_of(marks, "sure red"), 1U);
  EXPECT_EQ(count_of(marks, "sure green"), 0U);
  EXPECT_EQ(count_of(marks, "sure blue"), 1U);
}

TEST(Report, WhatTheSamplesDoNotSayHasNoErrorBarAndTheReasonInWords) {
  Report report = small_report();
  report.materials[0].fits[0].parameters = {
      {"a", "", {0.5}, 0.0, 1.0, 0.5, "", "unidentifiable", {std::nullopt}, "metallic is 1 & <b>"},
      {"b", "", {0.5}, 0.0, 1.0, 0.5, "", "ok"},
      {"c", "", {0.5}, 0.0, 1.0, 0.5, "", "ok", {std::numeric_limits<double>::quiet_NaN()}},
      {"d", "", {2.0}, 0.0, 1.0, 0.5, "", "ok", {0.1}}};
  const std::string html = report_html(report);
  EXPECT_EQ(count_of(html, "class=\"sure"), 0U);
  EXPECT_THAT(html, HasSubstr("unidentifiable</span><small>metallic is 1 &amp; &lt;b&gt;</small>"));
}

TEST(Report, CorrelatedPairsStandByNameTheClosestFirst) {
  Report report = small_report();
  ReportFit& fit = report.materials[0].fits[0];
  EXPECT_THAT(report_html(report), Not(HasSubstr("class=\"correlated\"")));
  fit.correlated = {{"specular", "metallic", 0.96}, {"sheen_tint", "base_color.r", -0.99}};
  std::string list = between(report_html(report), "class=\"correlated\"", "</div>");
  EXPECT_THAT(list, HasSubstr("sheen_<wbr>tint and base_<wbr>color.r"));
  EXPECT_LT(list.find("(-0.990)"), list.find("(+0.960)"));
  EXPECT_THAT(list, Not(HasSubstr("<details>")));
  fit.correlated.resize(20, {"a", "b", 0.97});
  list = between(report_html(report), "class=\"correlated\"", "</div>");
  EXPECT_THAT(list, HasSubstr("<summary>16 more</summary>"));
  EXPECT_EQ(count_of(list, "<li>"), 20U);
}

TEST(Report, LossesSayWhichWonAndByHowMuch) {
  Report report = small_report();
  ReportFit& fit = report.materials[0].fits[0];
  EXPECT_THAT(report_html(report), Not(HasSubstr("class=\"losses\"")));
  fit.losses = {{"log-ratio", 3.0, false}, {"srgb", 2.0, true}, {"linear", 2.5, false}};
  const std::string html = between(report_html(report), "class=\"losses\"", "</table>");
  EXPECT_THAT(html, HasSubstr("<b>srgb</b> was kept: ΔE 0.50 less (20.0%) than the next, linear"));
  EXPECT_LT(html.find("srgb<span"), html.find(">linear<"));
  EXPECT_LT(html.find(">linear<"), html.find(">log-ratio<"));
  EXPECT_EQ(count_of(html, "(kept)"), 1U);
  fit.losses = {{"log-ratio", 2.0, true}, {"srgb", 2.0, false}};
  EXPECT_THAT(report_html(report), HasSubstr("<b>log-ratio</b> was kept, the first of equals"));
}

TEST(Report, ALadderHasATileForEveryRungAndOneForTheMeasurement) {
  Report report = small_report();
  report.materials[0].fits[0].ladder = testing_support::sample_ladder(5);
  const std::string html = between(report_html(report), "<section class=\"ladder\"", "</section>");
  EXPECT_EQ(count_of(html, "<li "), 6U);
  EXPECT_EQ(count_of(html, "<img "), 12U);
  EXPECT_EQ(count_of(html, "class=\"rung removed\""), 1U);
  EXPECT_THAT(html,
              HasSubstr("</b> Lambert + GGX</p><p><b>38.00%</b></p><p class=\"quiet\">6 free, 8.0 ns</p>"));
  EXPECT_THAT(html,
              HasSubstr("</b>&nbsp;+ diffuse fresnel tangent falloff, retroreflection</p><p><b>29.00%</b> "
                        "<span class=\"number\">−9.00 ± 0.80</span></p>"));
  EXPECT_THAT(html, HasSubstr("</b>&nbsp;− diffuse fresnel (tangent falloff)<"));
  EXPECT_THAT(html, HasSubstr("With all effects on: 22.50%, 29 free."));
  EXPECT_EQ(count_of(html, "<svg "), 1U);
}

TEST(Report, ALadderWithoutMaterialsSaysSoAndKeepsItsPlot) {
  Report report = small_report();
  ReportLadder ladder = testing_support::sample_ladder(3);
  for (ReportRung& rung : ladder.rungs) rung.slice = rung.difference = {};
  ladder.measured = ladder.colour_bar = {};
  ladder.rungs[1].groups = {"<b>"};
  report.materials[0].fits[0].ladder = ladder;
  const std::string html = between(report_html(report), "<section class=\"ladder\"", "</section>");
  EXPECT_EQ(count_of(html, "<img "), 0U);
  EXPECT_EQ(count_of(html, "<svg "), 1U);
  EXPECT_THAT(html, HasSubstr("their slices are not drawn"));
  EXPECT_THAT(html, HasSubstr("&nbsp;+ &lt;b&gt;"));
}

TEST(Report, OnlyColoursReachTheStyle) {
  Report report = small_report();
  report.materials[0].fits[0].parameters = {
      {"base_color", "", {0.1, 0.1, 0.1}, 0.0, 1.0, 0.1, "(0, 0, 0);background:url(x)", "ok"}};
  EXPECT_THAT(report_html(report), Not(HasSubstr("style=\"background")));
}

TEST(Report, PicturesSayTheirSizeAndWhatTheyShow) {
  Report report = small_report();
  auto picture = testing_support::gradient_picture(320, 200);
  picture.width_px = picture.height_px = 0;  // taken from the PNG then
  ReportPicture nothing;
  nothing.caption = "gone";
  report.materials[0].pictures = {picture, nothing};
  const std::string html = report_html(report);
  EXPECT_THAT(html,
              HasSubstr("alt=\"Reference and three models side by side\" width=\"320\" height=\"200\""));
  EXPECT_THAT(html, HasSubstr("no picture</p><figcaption>gone"));
  const std::string data = between(html, "base64,", "\"");
  EXPECT_EQ(data, base64(picture.png));
}

TEST(Report, PlotsStandInThePageWithoutTheirHeader) {
  Report report = small_report();
  ReportPicture plot;
  plot.svg = "<?xml version=\"1.0\"?>\n<svg viewBox=\"0 0 1 1\"></svg>\n";
  plot.alt = "lobes";
  report.materials[0].pictures = {plot};
  const std::string html = report_html(report);
  EXPECT_THAT(html, HasSubstr("<span role=\"img\" aria-label=\"lobes\"><svg viewBox"));
  EXPECT_THAT(html, Not(HasSubstr("<?xml")));
}

TEST(Report, Base64IsThatOfTheStandard) {
  const auto encoded = [](const std::string& text) {
    return base64(std::vector<unsigned char>(text.begin(), text.end()));
  };
  EXPECT_THAT((std::vector<std::string>{encoded(""), encoded("f"), encoded("fo"), encoded("foo"),
                                        encoded("foob"), encoded("fooba"), encoded("foobar")}),
              ElementsAre("", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"));
  EXPECT_EQ(base64(std::vector<unsigned char>{0xFB, 0xFF, 0xFE}), "+//+");
}

TEST(Report, ManyMaterialsBeginFolded) {
  EXPECT_THAT(report_html(sample_report(3, false)), HasSubstr("<details open>"));
  EXPECT_THAT(report_html(sample_report(3, false)), Not(HasSubstr("id=\"filter\"")));
  EXPECT_THAT(report_html(sample_report(40, false)), Not(HasSubstr("<details open>")));
  EXPECT_THAT(report_html(sample_report(40, false)), HasSubstr("id=\"filter\""));
}

TEST(Report, NothingToShowIsSaid) {
  Report report;
  report.title = "empty";
  EXPECT_THAT(report_html(report), HasSubstr("There are no fitted materials."));
  EXPECT_THAT(report_html(report), HasSubstr("0 materials, 0 fits."));
}

TEST(Report, IsTheSameEveryTime) {
  EXPECT_EQ(report_html(sample_report(2)), report_html(sample_report(2)));
}

}  // namespace
}  // namespace brdfit::render
