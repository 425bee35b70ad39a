// Plots of costs: every point is where its figures say and is named, the front is the one that was given.
#include "render/cost_plot.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "tests/xml_reader.h"

namespace brdfit::render {
namespace {

using tests::XmlElement;
using tests::XmlReader;

CostPlot some_plot(std::size_t count, double scale = 1.0) {
  CostPlot plot;
  plot.title = "t";
  plot.cost_name = "seconds";
  plot.error_name = "error";
  plot.series = {"model", "samples", "bits"};
  for (std::size_t k = 0; k < count; ++k) {
    const double at = static_cast<double>(k + 1);
    const double cost = scale * at * at;
    plot.points.push_back({"point " + std::to_string(k),
                           k % 3,
                           {cost, 0.9 * cost, 1.2 * cost},
                           PlotSpread::of(scale / at),
                           k % 2 == 0,
                           "p" + std::to_string(k)});
  }
  return plot;
}

std::vector<const XmlElement*> of_class(const XmlReader& svg, const std::string& name) {
  std::vector<const XmlElement*> found;
  for (const XmlElement& element : svg.elements()) {
    if (element.has_class(name)) found.push_back(&element);
  }
  return found;
}

std::vector<std::pair<double, double>> corners_of(const XmlElement& line) {
  std::vector<std::pair<double, double>> corners;
  std::istringstream text(line.attributes.at("points"));
  double x = 0.0;
  double y = 0.0;
  char comma = 0;
  while (text >> x >> comma >> y) corners.emplace_back(x, y);
  return corners;
}

TEST(CostPlot, EveryPointIsNamedAndTheFirstCanBeReachedByKeyboard) {
  const XmlReader svg(cost_plot(some_plot(60)));
  std::vector<const XmlElement*> points = of_class(svg, "point");
  for (const XmlElement* point : of_class(svg, "point at-front")) points.push_back(point);
  ASSERT_EQ(points.size(), 60U);
  int reachable = 0;
  for (std::size_t k = 0; k < 60; ++k) {
    const std::string name = "point " + std::to_string(k);
    EXPECT_EQ(std::ranges::count_if(points,
                                    [&](const XmlElement* point) {
                                      return point->attributes.at("aria-label") == name &&
                                             point->text.find(name) != std::string::npos;
                                    }),
              1)
        << name;
  }
  for (const XmlElement* point : points) reachable += point->attributes.at("tabindex") == "0" ? 1 : 0;
  EXPECT_EQ(reachable, 1);
}

TEST(CostPlot, TheFrontIsThatOfThePointsFromTheLowestCostOn) {
  const CostPlot plot = some_plot(5);
  EXPECT_THAT(front_of(plot), testing::ElementsAre(0, 2, 4));
  const XmlReader svg(cost_plot(plot));
  ASSERT_EQ(of_class(svg, "front").size(), 1U);
  const auto corners = corners_of(*of_class(svg, "front")[0]);
  const auto rings = of_class(svg, "ring");
  ASSERT_EQ(rings.size(), 3U);
  // Steps: over to the next point's cost, then down to its error; on to the frame behind the last.
  ASSERT_EQ(corners.size(), 6U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(corners[2 * k].first, rings[k]->number("cx"), 0.011);
    EXPECT_NEAR(corners[2 * k].second, rings[k]->number("cy"), 0.011);
    EXPECT_EQ(corners[2 * k + 1].second, corners[2 * k].second);
  }
  std::vector<std::string> numbers;
  for (const XmlElement* number : of_class(svg, "number")) numbers.push_back(number->text);
  EXPECT_THAT(numbers, testing::ElementsAre("1", "2", "3"));
}

TEST(CostPlot, WithoutAFrontThereIsNoLine) {
  CostPlot plot = some_plot(5);
  for (CostPlotPoint& point : plot.points) point.is_on_front = false;
  const XmlReader svg(cost_plot(plot));
  EXPECT_TRUE(of_class(svg, "front").empty());
  EXPECT_TRUE(of_class(svg, "number").empty());
}

TEST(CostPlot, EverythingStaysInThePictureWhateverTheNumbers) {
  for (const double scale : {1e-12, 1.0, 1e12}) {
    for (const std::size_t count : {1U, 2U, 60U}) {
      const XmlReader svg(cost_plot(some_plot(count, scale)));
      const double width = svg.elements().front().number("width");
      const double height = svg.elements().front().number("height");
      for (const XmlElement& element : svg.elements()) {
        for (const auto& [name, limit] : {std::pair("x", width),
                                          {"cx", width},
                                          {"x1", width},
                                          {"x2", width},
                                          {"y", height},
                                          {"cy", height},
                                          {"y1", height},
                                          {"y2", height}}) {
          if (!element.attributes.contains(name)) continue;
          EXPECT_GE(element.number(name), 0.0) << element.name << " " << name;
          EXPECT_LE(element.number(name), limit) << element.name << " " << name;
        }
      }
    }
  }
}

TEST(CostPlot, NumbersOfTheFrontDoNotCoverEachOther) {
  CostPlot plot = some_plot(40);
  for (CostPlotPoint& point : plot.points) point.is_on_front = true;
  const XmlReader svg(cost_plot(plot));
  const auto numbers = of_class(svg, "number");
  ASSERT_EQ(numbers.size(), 40U);
  for (std::size_t a = 0; a < numbers.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double across = std::abs(numbers[a]->number("x") - numbers[b]->number("x"));
      const double down = std::abs(numbers[a]->number("y") - numbers[b]->number("y"));
      EXPECT_TRUE(across > 7.0 || down > 7.0) << numbers[a]->text << " and " << numbers[b]->text;
    }
  }
}

TEST(CostPlot, PointsWithoutAFigureAreLeftOut) {
  CostPlot plot = some_plot(4);
  plot.points[1].cost.middle = std::numeric_limits<double>::quiet_NaN();
  plot.points[2].error.high = std::numeric_limits<double>::infinity();
  const XmlReader svg(cost_plot(plot));
  EXPECT_EQ(of_class(svg, "reach").size(), 2U);
  EXPECT_THAT(front_of(plot), testing::ElementsAre(0));
  for (CostPlotPoint& point : plot.points) point.cost.low = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(cost_plot(plot), "");
}

TEST(CostPlot, HostileNamesAreTextAndAMissingSeriesIsAnError) {
  CostPlot plot = some_plot(2);
  const std::string bad = R"(</title><script>alert("1")</script>'&)";
  plot.title = plot.cost_name = plot.error_name = plot.points[0].name = plot.points[0].key = plot.series[0] =
      bad;
  const XmlReader svg(cost_plot(plot));
  EXPECT_EQ(of_class(svg, "point at-front").at(0)->attributes.at("aria-label"), bad);
  plot.points[0].series = 3;
  EXPECT_THROW(cost_plot(plot), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::render
