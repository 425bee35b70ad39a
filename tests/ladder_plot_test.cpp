// The plot of a choice of effects: every rung is where its numbers say, and nothing breaks it.
#include "render/ladder_plot.h"

#include <gmock/gmock.h>

#include <limits>
#include <regex>

namespace brdfit::render {
namespace {

std::vector<LadderPoint> some_points() {
  return {{40.0, std::nullopt, 8.0}, {30.0, 1.5, 9.0}, {25.0, 0.5, 12.0}, {25.25, 0.1, 10.0, true}};
}

// The numbers of an attribute in all elements that a pattern begins.
std::vector<double> numbers(const std::string& svg, const std::string& element,
                            const std::string& attribute) {
  std::vector<double> found;
  const std::regex pattern(element + "[^>]*" + attribute + "=\"([-0-9.]+)\"");
  for (std::sregex_iterator at(svg.begin(), svg.end(), pattern), end; at != end; ++at) {
    found.push_back(std::stod((*at)[1]));
  }
  return found;
}

TEST(LadderPlot, HeightsAreLinearInTheError) {
  const std::string svg = ladder_plot("t", some_points(), std::nullopt);
  const std::vector<double> y = numbers(svg, "<circle", "cy");
  ASSERT_EQ(y.size(), 4U);
  const double pixels_per_pct = (y[1] - y[0]) / 10.0;
  EXPECT_GT(pixels_per_pct, 0.0);  // downwards: the error falls
  EXPECT_NEAR(y[2] - y[0], 15.0 * pixels_per_pct, 0.02);
  EXPECT_NEAR(y[3] - y[0], 14.75 * pixels_per_pct, 0.02);
}

TEST(LadderPlot, RungsHaveEvenDistancesAndTheirCostsStandBelowThem) {
  const std::string svg = ladder_plot("t", some_points(), std::nullopt);
  const std::vector<double> x = numbers(svg, "<circle", "cx");
  ASSERT_EQ(x.size(), 4U);
  EXPECT_NEAR(x[1] - x[0], x[2] - x[1], 0.02);
  EXPECT_NEAR(x[2] - x[1], x[3] - x[2], 0.02);
  std::vector<double> heights;
  const std::regex bar("height=\"([0-9.]+)\" class=\"cost\"");
  for (std::sregex_iterator at(svg.begin(), svg.end(), bar), end; at != end; ++at) {
    heights.push_back(std::stod((*at)[1]));
  }
  ASSERT_EQ(heights.size(), 4U);
  // From 0 on.
  EXPECT_NEAR(heights[1] / heights[0], 9.0 / 8.0, 1e-2);
  EXPECT_NEAR(heights[2] / heights[0], 12.0 / 8.0, 1e-2);
}

TEST(LadderPlot, EverythingStaysInThePictureWhateverTheNumbers) {
  for (const double scale : {1e-12, 1.0, 1e12}) {
    for (const std::size_t count : {1U, 2U, 40U}) {
      std::vector<LadderPoint> points;
      for (std::size_t k = 0; k < count; ++k) {
        points.push_back({scale / static_cast<double>(k + 1), scale, scale, k % 3 == 1});
      }
      const std::string svg = ladder_plot("t", points, 2.0 * scale);
      EXPECT_EQ(numbers(svg, "<circle", "cx").size(), count);
      for (const char* attribute : {" x", " x1", " x2", " cx"}) {
        for (const double x : numbers(svg, "<(?:line|circle|text|rect)", attribute)) {
          EXPECT_GE(x, 0.0);
          EXPECT_LE(x, 460.0);
        }
      }
      for (const char* attribute : {" y", " y1", " y2", " cy"}) {
        for (const double y : numbers(svg, "<(?:line|circle|text|rect)", attribute)) {
          EXPECT_GE(y, 0.0);
          EXPECT_LE(y, 370.0);
        }
      }
    }
  }
}

TEST(LadderPlot, ShowsWhatIsGivenAndNoMore) {
  std::vector<LadderPoint> points = some_points();
  std::string svg = ladder_plot("t", points, 24.0);
  const auto count_of = [&](const std::string& what) {
    std::size_t count = 0;
    for (std::size_t at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) ++count;
    return count;
  };
  EXPECT_EQ(count_of("class=\"whisker\""), 3U);
  EXPECT_EQ(count_of("class=\"point removed\""), 1U);
  EXPECT_EQ(count_of("class=\"all\""), 1U);
  for (LadderPoint& point : points) point.evaluation_ns.reset();
  svg = ladder_plot("t", points, std::nullopt);
  EXPECT_EQ(count_of("class=\"cost\""), 0U);
  EXPECT_EQ(count_of("ns per"), 0U);
  EXPECT_EQ(count_of("class=\"all\""), 0U);
}

TEST(LadderPlot, IsEmptyWhereThereIsNothingToDraw) {
  EXPECT_EQ(ladder_plot("t", {}, 1.0), "");
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(ladder_plot("t", {{bad}}, std::nullopt), "");
    EXPECT_EQ(ladder_plot("t", {{1.0, bad}}, std::nullopt), "");
    EXPECT_EQ(ladder_plot("t", {{1.0, 0.1, bad}}, std::nullopt), "");
    EXPECT_EQ(ladder_plot("t", {{1.0}}, bad), "");
  }
}

TEST(LadderPlot, TitlesAreEscaped) {
  EXPECT_THAT(ladder_plot("<b> & \"c\"", some_points(), std::nullopt),
              testing::HasSubstr("<title>&lt;b&gt; &amp; &quot;c&quot;</title>"));
}

}  // namespace
}  // namespace brdfit::render
