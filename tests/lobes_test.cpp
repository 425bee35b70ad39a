// Plots of lobes show the numbers that the table and the models have.
#include "render/lobes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "brdf/models.h"
#include "data/synthetic/generate.h"
#include "data/synthetic/random_material.h"
#include "render/plot.h"
#include "tests/xml_reader.h"

namespace brdfit::render {
namespace {

using testing::HasSubstr;
using tests::XmlElement;
using tests::XmlReader;

constexpr double kDegree = std::numbers::pi / 180.0;

Material some_material(std::uint64_t seed = 1, Model model = Model::kCallisto) {
  return synthetic::random_material(model, Tier::kFull, effects_of(model), {}, seed);
}

MeasuredTable table_of(const Material& material, const Grid& grid = {30, 30, 60, CellAnchor::kLowerEdge}) {
  synthetic::Recipe recipe;
  recipe.name = "test";
  recipe.material = material;
  recipe.grid = grid;
  return synthetic::generate_table(recipe);
}

MeasuredTable constant_table(float f, const Grid& grid = {12, 10, 20, CellAnchor::kLowerEdge}) {
  return {grid, std::vector<float>(3 * grid.cell_count(), f)};
}

// "10⁻³", "1", "0.2", "2×10⁶": what an axis says.
double number_of_label(const std::string& label) {
  const std::map<std::string, char> superscripts = {{"⁰", '0'}, {"¹", '1'}, {"²", '2'}, {"³", '3'},
                                                    {"⁴", '4'}, {"⁵", '5'}, {"⁶", '6'}, {"⁷", '7'},
                                                    {"⁸", '8'}, {"⁹", '9'}, {"⁻", '-'}};
  std::string exponent, mantissa;
  for (std::size_t k = 0; k < label.size();) {
    const auto byte = static_cast<unsigned char>(label[k]);
    const std::size_t length = byte < 0x80 ? 1 : byte < 0xE0 ? 2 : 3;
    const auto found = superscripts.find(label.substr(k, length));
    if (found != superscripts.end()) {
      exponent += found->second;
    } else {
      mantissa += label.substr(k, length);
    }
    k += length;
  }
  if (exponent.empty()) return std::stod(mantissa);
  const std::size_t times = mantissa.find("×");
  const double factor = times == std::string::npos ? 1.0 : std::stod(mantissa.substr(0, times));
  return factor * std::pow(10.0, std::stod(exponent));
}

// A straight axis through two labelled places.
struct Axis {
  double pixel_0, pixel_1, value_0, value_1;
  double value(double pixel) const {
    return value_0 + (pixel - pixel_0) / (pixel_1 - pixel_0) * (value_1 - value_0);
  }
};

struct XyPoint {
  double x, y;
};

// One plot read back from its picture: places in pixels become angles and values by the labels of its axes.
struct ReadLobe {
  std::string angles;
  std::string note;
  Axis root_theta_h, log_f;
  std::vector<XyPoint> measured;
  std::map<std::string, std::vector<std::vector<XyPoint>>> curves;  // by class
  int below = 0;

  double theta_h_deg(double x) const { return 90.0 * std::pow(root_theta_h.value(x), 2.0); }
  double f(double y) const { return std::pow(10.0, log_f.value(y)); }
};

std::vector<XyPoint> points_of(const XmlElement& polyline) {
  std::vector<XyPoint> points;
  const char* at = polyline.attributes.at("points").c_str();
  while (*at != '\0') {
    char* end = nullptr;
    const double x = std::strtod(at, &end);
    const double y = std::strtod(end + 1, &end);
    points.push_back({x, y});
    at = end;
  }
  return points;
}

// Elements within the groups of a class, by group.
std::vector<std::vector<XmlElement>> groups(const XmlReader& file, const std::string& name) {
  std::vector<std::vector<XmlElement>> result;
  for (std::size_t k = 0; k < file.elements().size(); ++k) {
    if (!file.elements()[k].has_class(name)) continue;
    result.emplace_back();
    for (const XmlElement& element : file.elements()) {
      if (std::count(element.path.begin(), element.path.end(), k) > 0) result.back().push_back(element);
    }
  }
  return result;
}

ReadLobe read_lobe(const std::vector<XmlElement>& group) {
  ReadLobe lobe;
  std::vector<std::pair<double, double>> x_ticks, y_ticks;
  for (const XmlElement& element : group) {
    if (element.has_class("angles")) lobe.angles = element.text;
    if (element.has_class("note")) lobe.note = element.text;
    if (element.has_class("x-tick")) {
      x_ticks.emplace_back(element.number("x"), std::sqrt(std::stod(element.text) / 90.0));
    }
    if (element.has_class("y-tick")) {
      y_ticks.emplace_back(element.number("y") - 5.0, std::log10(number_of_label(element.text)));
    }
    if (element.name == "circle") lobe.measured.push_back({element.number("cx"), element.number("cy")});
    if (element.has_class("below")) ++lobe.below;
    const auto name = element.attributes.find("class");
    if (element.name == "polyline" && name != element.attributes.end() &&
        name->second.starts_with("model-")) {
      lobe.curves[name->second].push_back(points_of(element));
    }
  }
  std::sort(y_ticks.begin(), y_ticks.end());
  lobe.root_theta_h = {x_ticks.front().first, x_ticks.back().first, x_ticks.front().second,
                       x_ticks.back().second};
  lobe.log_f = {y_ticks.front().first, y_ticks.back().first, y_ticks.front().second, y_ticks.back().second};
  return lobe;
}

// "nan" or "inf" as words of their own, anywhere.
bool has_odd_number(const std::string& svg) {
  const auto is_letter = [&](std::size_t k) { return std::isalpha(static_cast<unsigned char>(svg[k])) != 0; };
  for (const char* word : {"nan", "inf"}) {
    for (std::size_t at = svg.find(word); at != std::string::npos; at = svg.find(word, at + 1)) {
      if (!is_letter(at - 1) && !is_letter(at + 3)) return true;
    }
  }
  return false;
}

std::vector<ReadLobe> read_lobes(const std::string& svg) {
  EXPECT_FALSE(has_odd_number(svg));
  const XmlReader file(svg);
  std::vector<ReadLobe> lobes;
  for (const auto& group : groups(file, "lobe")) lobes.push_back(read_lobe(group));
  return lobes;
}

double luminance(const Rgb& rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

// The mean of f over both orders, as a table holds it.
double mean_f(const Material& material, const HalfDiff& angles) {
  const auto pair = directions_from_half_diff(angles);
  return 0.5 * (luminance(eval(material, pair.wi, pair.wo)) + luminance(eval(material, pair.wo, pair.wi)));
}

// A hundredth of a pixel in the 250 pixels of up to ten decades.
constexpr double kRounding = 2e-3;

TEST(LobePlots, PointsAreTheStoredCells) {
  for (const CellAnchor anchor : {CellAnchor::kLowerEdge, CellAnchor::kCentre}) {
    const Grid grid = {30, 30, 60, anchor};
    const MeasuredTable table = table_of(some_material(), grid);
    const auto lobes = read_lobes(lobe_plots(&table, {}, {}));
    ASSERT_EQ(lobes.size(), 4U);
    const int rows[] = {0, 10, 20, 25};  // of 0, 30, 60 and 75 deg
    for (std::size_t p = 0; p < 4; ++p) {
      std::size_t at = 0;
      for (int i = 0; i < grid.n_theta_h; ++i) {
        const int row = anchor == CellAnchor::kLowerEdge ? rows[p] : std::max(rows[p] - 1, 0);
        const int column = anchor == CellAnchor::kLowerEdge ? 30 : 29;
        const std::size_t cell = grid.index(i, row, column);
        if (!table.is_valid(cell)) continue;
        ASSERT_LT(at, lobes[p].measured.size());
        const XyPoint point = lobes[p].measured[at++];
        EXPECT_NEAR(lobes[p].theta_h_deg(point.x), grid.theta_h_rad(i) / kDegree, 5e-3);
        EXPECT_NEAR(lobes[p].f(point.y) / luminance(table.value(cell)), 1.0, kRounding);
      }
      EXPECT_EQ(at, lobes[p].measured.size());
    }
  }
}

TEST(LobePlots, CurvesAreTheModelsAtTheAnglesOfThePlot) {
  const MeasuredTable table = table_of(some_material());
  for (const Model model : all_models()) {
    const Material material = some_material(3, model);
    for (const double phi_d : {90.0, 30.0}) {
      LobeOptions options;
      options.phi_d_deg = phi_d;
      const auto lobes = read_lobes(lobe_plots(&table, {{"m", material}}, options));
      for (std::size_t p = 0; p < lobes.size(); ++p) {
        ASSERT_TRUE(lobes[p].curves.contains("model-0"));
        std::size_t checked = 0;
        for (const auto& piece : lobes[p].curves.at("model-0")) {
          for (const XyPoint& point : piece) {
            const double theta_h = lobes[p].theta_h_deg(point.x);
            // Steep parts turn the rounding of x into more than that of y.
            const HalfDiff angles = {theta_h * kDegree, options.theta_d_deg[p] * kDegree, phi_d * kDegree};
            const HalfDiff beside = {1.001 * angles.theta_h_rad + 1e-4, angles.theta_d_rad, angles.phi_d_rad};
            const double f = mean_f(material, angles);
            if (f == 0.0 || std::abs(mean_f(material, beside) / f - 1.0) > 2e-3) continue;
            EXPECT_NEAR(lobes[p].f(point.y) / f, 1.0, 2.0 * kRounding)
                << name_of(model) << " theta_h " << theta_h << " theta_d " << options.theta_d_deg[p];
            ++checked;
          }
        }
        EXPECT_GT(checked, 3U);
      }
    }
  }
}

// A curve's fine steps show a peak that is narrower than the table's cells.
TEST(LobePlots, ThePeakIsAtTheTopOfTheCurve) {
  Material mirror(Model::kLambertGgx);
  mirror.set("roughness", 0.05);
  mirror.set("metallic", 1.0);
  const MeasuredTable table = table_of(mirror);
  for (const ReadLobe& lobe : read_lobes(lobe_plots(&table, {{"m", mirror}}, {}))) {
    double best = 0.0;
    double place = 90.0;
    for (const XyPoint& point : lobe.curves.at("model-0")[0]) {
      if (lobe.f(point.y) > best * (1.0 + 1e-6)) {
        best = lobe.f(point.y);
        place = lobe.theta_h_deg(point.x);
      }
    }
    EXPECT_LT(place, 0.05);
    EXPECT_NEAR(lobe.f(lobe.measured[0].y) / best, 1.0, kRounding);
  }
}

TEST(LobePlots, NothingIsDrawnBelowTheHorizon) {
  const Material material = some_material();
  const MeasuredTable table = table_of(material);
  LobeOptions options;
  options.phi_d_deg = 0.0;
  options.theta_d_deg = {30.0, 60.0};
  const auto lobes = read_lobes(lobe_plots(&table, {{"m", material}}, options));
  for (std::size_t p = 0; p < 2; ++p) {
    double last = 0.0;
    for (const auto& piece : lobes[p].curves.at("model-0"))
      last = std::max(last, lobes[p].theta_h_deg(piece.back().x));
    // theta_i = theta_h + theta_d in the plane of incidence.
    EXPECT_LT(last, 90.0 - options.theta_d_deg[p] + 1e-6);
    EXPECT_GT(last, 90.0 - options.theta_d_deg[p] - 1.0);
  }
}

TEST(LobePlots, SaysTheAnglesThatTheTableHas) {
  const MeasuredTable table = constant_table(0.5F);  // rows every 9 deg in theta_d and phi_d
  LobeOptions options;
  options.theta_d_deg = {0.0, 30.0};
  options.phi_d_deg = 70.0;
  const auto lobes = read_lobes(lobe_plots(&table, {}, options));
  EXPECT_EQ(lobes[0].angles, "θd = 0°,  φd = 72°");
  EXPECT_EQ(lobes[1].angles, "θd = 27°,  φd = 72°");
  EXPECT_EQ(read_lobes(lobe_plots(nullptr, {{"m", Material()}}, options))[1].angles, "θd = 30°,  φd = 70°");
}

TEST(LobePlots, InvalidCellsHaveNoPoint) {
  const Grid grid = {12, 10, 20, CellAnchor::kLowerEdge};
  std::vector<float> planes(3 * grid.cell_count(), 0.5F);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (const int i : {2, 3, 7}) planes[channel * grid.cell_count() + grid.index(i, 0, 10)] = -1.0F;
  }
  planes[grid.index(9, 0, 10)] = std::numeric_limits<float>::quiet_NaN();
  const MeasuredTable table(grid, planes);
  LobeOptions options;
  options.theta_d_deg = {0.0};
  EXPECT_EQ(read_lobes(lobe_plots(&table, {}, options))[0].measured.size(), 8U);
}

TEST(LobePlots, AnEmptyRowIsSaid) {
  const MeasuredTable table = constant_table(-1.0F);
  for (const ReadLobe& lobe : read_lobes(lobe_plots(&table, {}, {}))) {
    EXPECT_TRUE(lobe.measured.empty());
    EXPECT_EQ(lobe.note, "no cell of this row was measured");
  }
}

TEST(LobePlots, ZerosAreMarkedAtTheLowerEnd) {
  const Grid grid = {12, 10, 20, CellAnchor::kLowerEdge};
  std::vector<float> planes(3 * grid.cell_count(), 0.5F);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (const int i : {2, 3}) planes[channel * grid.cell_count() + grid.index(i, 0, 10)] = 0.0F;
  }
  LobeOptions options;
  options.theta_d_deg = {0.0};
  const MeasuredTable some(grid, planes);
  const auto lobe = read_lobes(lobe_plots(&some, {}, options))[0];
  EXPECT_EQ(lobe.below, 2);
  EXPECT_EQ(lobe.measured.size(), 10U);
  EXPECT_THAT(lobe.note, HasSubstr("2 cells below the scale, or 0"));
  const MeasuredTable all = constant_table(0.0F);
  EXPECT_EQ(read_lobes(lobe_plots(&all, {}, options))[0].below, 12);
}

TEST(LobePlots, ACurveEndsAtTheLowerEndOfTheScale) {
  // Lambert far below the measured values: no line may leave the frame.
  Material dark(Model::kLambertGgx);
  dark.set("base_color", 1e-6);
  dark.set("specular", 1.0);
  dark.set("roughness", 0.05);
  const MeasuredTable table = constant_table(1.0F);
  for (const ReadLobe& lobe : read_lobes(lobe_plots(&table, {{"dark", dark}}, {}))) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto& piece : lobe.curves.at("model-0")) {
      for (const XyPoint& point : piece) lowest = std::min(lowest, lobe.f(point.y));
    }
    EXPECT_GE(lowest, 0.0099);
    EXPECT_LE(lowest, 0.0101);
  }
}

TEST(LobePlots, HugeAndTinyValuesHaveLabelsThatCanBeRead) {
  for (const float f : {1e-30F, 1e-9F, 3e38F}) {
    const MeasuredTable table = constant_table(f);
    for (const ReadLobe& lobe : read_lobes(lobe_plots(&table, {}, {}))) {
      for (const XyPoint& point : lobe.measured)
        EXPECT_NEAR(lobe.f(point.y) / static_cast<double>(f), 1.0, kRounding);
    }
  }
}

TEST(LobePlots, ATableOfOneCellWorks) {
  const MeasuredTable table = constant_table(0.3F, {1, 1, 1, CellAnchor::kLowerEdge});
  const auto lobes = read_lobes(lobe_plots(&table, {{"m", Material()}}, {}));
  ASSERT_EQ(lobes.size(), 4U);
  for (const ReadLobe& lobe : lobes) EXPECT_EQ(lobe.measured.size(), 1U);
}

TEST(LobePlots, AllPlotsShareOneScaleThatHoldsEverything) {
  const MeasuredTable table = table_of(some_material(5));
  const auto lobes = read_lobes(lobe_plots(&table, {{"m", some_material(6)}}, {}));
  for (const ReadLobe& lobe : lobes) {
    EXPECT_DOUBLE_EQ(lobe.log_f.value_0, lobes[0].log_f.value_0);
    EXPECT_DOUBLE_EQ(lobe.log_f.value_1, lobes[0].log_f.value_1);
    for (const auto& piece : lobe.curves.at("model-0")) {
      for (const XyPoint& point : piece) {
        EXPECT_GE(point.y, std::min(lobe.log_f.pixel_0, lobe.log_f.pixel_1) - 0.01);
        EXPECT_LE(point.y, std::max(lobe.log_f.pixel_0, lobe.log_f.pixel_1) + 0.01);
      }
    }
  }
}

TEST(LobePlots, AChannelIsShownAlone) {
  const Grid grid = {12, 10, 20, CellAnchor::kLowerEdge};
  std::vector<float> planes(3 * grid.cell_count(), 0.25F);
  std::fill_n(planes.begin() + static_cast<std::ptrdiff_t>(grid.cell_count()), grid.cell_count(), 0.5F);
  std::fill_n(planes.begin() + static_cast<std::ptrdiff_t>(2 * grid.cell_count()), grid.cell_count(), 0.75F);
  const MeasuredTable table(grid, planes);
  const std::pair<Channel, double> expected[] = {
      {Channel::kRed, 0.25}, {Channel::kGreen, 0.5}, {Channel::kBlue, 0.75}};
  for (const auto& [channel, f] : expected) {
    LobeOptions options;
    options.channel = channel;
    for (const ReadLobe& lobe : read_lobes(lobe_plots(&table, {}, options))) {
      EXPECT_NEAR(lobe.f(lobe.measured[0].y) / f, 1.0, kRounding);
    }
  }
}

TEST(LobePlots, ModelsDifferInColourAndInDashes) {
  std::vector<Material> materials(6);
  std::vector<Curve> curves;
  for (const Material& material : materials) curves.push_back({"m", material});
  std::vector<std::string> looks;
  const XmlReader file(lobe_plots(nullptr, curves, {}));
  const auto lobes = groups(file, "lobe");
  for (const auto& element : lobes[0]) {
    if (element.name != "polyline") continue;
    const auto dashes = element.attributes.find("stroke-dasharray");
    looks.push_back(element.attributes.at("stroke"));
    looks.push_back(dashes == element.attributes.end() ? "solid" : dashes->second);
  }
  ASSERT_EQ(looks.size(), 12U);
  std::sort(looks.begin(), looks.end());
  EXPECT_EQ(std::unique(looks.begin(), looks.end()), looks.end());
}

TEST(LobePlots, OptionsThatMakeNoSenseAreRefused) {
  const auto refused = [](auto change) {
    LobeOptions options;
    change(options);
    EXPECT_THROW(lobe_plots(nullptr, {}, options), std::invalid_argument);
  };
  refused([](LobeOptions& o) { o.channel = Channel::kRgb; });
  refused([](LobeOptions& o) { o.theta_d_deg = {}; });
  refused([](LobeOptions& o) { o.theta_d_deg = {90.0}; });
  refused([](LobeOptions& o) { o.theta_d_deg = {-1.0}; });
  refused([](LobeOptions& o) { o.theta_d_deg = {std::nan("")}; });
  refused([](LobeOptions& o) { o.phi_d_deg = std::nan(""); });
  refused([](LobeOptions& o) { o.width_px = 100; });
}

TEST(LobePlots, TheSameInputGivesTheSameFile) {
  const Material material = some_material();
  const MeasuredTable table = table_of(material);
  EXPECT_EQ(lobe_plots(&table, {{"m", material}}, {}), lobe_plots(&table, {{"m", material}}, {}));
  EXPECT_EQ(polar_plots(&table, {{"m", material}}, {}), polar_plots(&table, {{"m", material}}, {}));
}

TEST(LobePlots, TitlesAndLabelsAreEscaped) {
  LobeOptions options;
  options.title = "<b> & co";
  const std::string svg = lobe_plots(nullptr, {{"a<b", Material()}}, options);
  const XmlReader file(svg);
  std::vector<std::string> texts;
  for (const auto& element : file.elements()) texts.push_back(element.text);
  EXPECT_THAT(texts, testing::Contains("<b> & co"));
  EXPECT_THAT(texts, testing::Contains("a<b"));
}

// One polar plot read back: its centre and its rings give places their angle and value.
struct ReadPolar {
  XyPoint centre;
  double radius = 0.0;
  double rim = 0.0;
  std::vector<std::pair<double, double>> rings;  // distance and value as labelled
  std::vector<XyPoint> measured;
  std::map<std::string, std::vector<std::vector<XyPoint>>> curves;
  std::string note;

  double view_deg(const XyPoint& p) const { return std::atan2(p.x - centre.x, centre.y - p.y) / kDegree; }
  double distance(const XyPoint& p) const { return std::hypot(p.x - centre.x, p.y - centre.y); }
  double value(const XyPoint& p) const { return rim * std::pow(distance(p) / radius, 4.0); }
};

std::vector<ReadPolar> read_polars(const std::string& svg) {
  EXPECT_FALSE(has_odd_number(svg));
  const XmlReader file(svg);
  std::vector<ReadPolar> polars;
  for (const auto& group : groups(file, "polar")) {
    ReadPolar polar;
    // The first arc is the rim, from -90 to 90 deg.
    for (const XmlElement& element : group) {
      if (element.name != "polyline") continue;
      const auto arc = points_of(element);
      polar.radius = 0.5 * (arc.back().x - arc.front().x);
      polar.centre = {0.5 * (arc.back().x + arc.front().x), arc.front().y};
      break;
    }
    for (const XmlElement& element : group) {
      if (element.has_class("note")) polar.note = element.text;
      if (element.has_class("ring")) {
        polar.rings.emplace_back(element.number("x") - polar.centre.x, number_of_label(element.text));
      }
      if (element.name == "circle") polar.measured.push_back({element.number("cx"), element.number("cy")});
      const auto name = element.attributes.find("class");
      if (element.name == "polyline" && name != element.attributes.end() &&
          name->second.starts_with("model-")) {
        polar.curves[name->second].push_back(points_of(element));
      }
    }
    polar.rim = polar.rings.front().second;
    polars.push_back(polar);
  }
  return polars;
}

double f_cos_o(const Material& material, double theta_i_deg, double view_deg) {
  const Vec3 wi = {-std::sin(theta_i_deg * kDegree), 0.0, std::cos(theta_i_deg * kDegree)};
  const Vec3 wo = {std::sin(view_deg * kDegree), 0.0, std::cos(view_deg * kDegree)};
  return luminance(eval(material, wi, wo)) * wo.z;
}

TEST(PolarPlots, CurvesAreTheModelTimesTheCosineOfTheView) {
  for (const Model model : all_models()) {
    const Material material = some_material(2, model);
    const PolarOptions options;
    const auto polars = read_polars(polar_plots(nullptr, {{"m", material}}, options));
    ASSERT_EQ(polars.size(), options.theta_i_deg.size());
    for (std::size_t p = 0; p < polars.size(); ++p) {
      std::size_t checked = 0;
      for (const XyPoint& point : polars[p].curves.at("model-0").at(0)) {
        // Near the centre a hundredth of a pixel is a large part of the value.
        if (polars[p].distance(point) < 20.0) continue;
        const double f = f_cos_o(material, options.theta_i_deg[p], polars[p].view_deg(point));
        EXPECT_NEAR(polars[p].value(point) / f, 1.0, 0.01) << name_of(model) << " " << options.theta_i_deg[p];
        ++checked;
      }
      EXPECT_GT(checked, 10U);
    }
  }
}

TEST(PolarPlots, PointsAreTheInterpolatedTable) {
  const Material material = some_material(4);
  const MeasuredTable table = table_of(material);
  const PolarOptions options;
  const auto polars = read_polars(polar_plots(&table, {}, options));
  for (std::size_t p = 0; p < polars.size(); ++p) {
    EXPECT_GT(polars[p].measured.size(), 100U);
    for (const XyPoint& point : polars[p].measured) {
      if (polars[p].distance(point) < 20.0) continue;
      const double theta_i = options.theta_i_deg[p] * kDegree;
      const double view = polars[p].view_deg(point) * kDegree;
      const Vec3 wo = {std::sin(view), 0.0, std::cos(view)};
      const auto f = table.interpolate(Vec3{-std::sin(theta_i), 0.0, std::cos(theta_i)}, wo);
      ASSERT_TRUE(f.has_value());
      EXPECT_NEAR(polars[p].value(point) / (luminance(*f) * wo.z), 1.0, 0.01);
    }
  }
}

TEST(PolarPlots, TheMirrorDirectionIsOnTheRight) {
  Material mirror(Model::kLambertGgx);
  mirror.set("roughness", 0.1);
  mirror.set("metallic", 1.0);
  const PolarOptions options;
  const auto polars = read_polars(polar_plots(nullptr, {{"m", mirror}}, options));
  for (std::size_t p = 0; p + 1 < polars.size(); ++p) {  // at 80 deg the peak is off specular
    const auto& curve = polars[p].curves.at("model-0").at(0);
    const auto peak = std::max_element(curve.begin(), curve.end(), [&](const XyPoint& a, const XyPoint& b) {
      return polars[p].distance(a) < polars[p].distance(b);
    });
    EXPECT_NEAR(polars[p].view_deg(*peak), options.theta_i_deg[p], 0.3);
  }
}

TEST(PolarPlots, RingsAreWhereTheirLabelsSay) {
  const auto polars = read_polars(polar_plots(nullptr, {{"m", some_material()}}, {}));
  for (const ReadPolar& polar : polars) {
    EXPECT_GE(polar.rings.size(), 2U);
    for (const auto& [distance, value] : polar.rings) {
      EXPECT_NEAR(polar.rim * std::pow(distance / polar.radius, 4.0) / value, 1.0, 2e-3);
    }
  }
}

TEST(PolarPlots, UnusualTablesWork) {
  for (const float f : {-1.0F, 0.0F, 1e-30F, 3e38F}) {
    for (const Grid& grid : {Grid{12, 10, 20, CellAnchor::kLowerEdge}, Grid{1, 1, 1, CellAnchor::kCentre}}) {
      const MeasuredTable table = constant_table(f, grid);
      const auto polars = read_polars(polar_plots(&table, {}, {}));
      for (const ReadPolar& polar : polars) {
        for (const XyPoint& point : polar.measured) EXPECT_LE(polar.distance(point), polar.radius + 0.02);
        const char* note = f < 0.0F    ? "no cell in this plane was measured"
                           : f == 0.0F ? "no value above 0"
                                       : "";
        EXPECT_EQ(polar.note, note);
        EXPECT_EQ(polar.measured.empty(), f < 0.0F);
      }
    }
  }
}

TEST(PolarPlots, OptionsThatMakeNoSenseAreRefused) {
  const auto refused = [](auto change) {
    PolarOptions options;
    change(options);
    EXPECT_THROW(polar_plots(nullptr, {}, options), std::invalid_argument);
  };
  refused([](PolarOptions& o) { o.channel = Channel::kRgb; });
  refused([](PolarOptions& o) { o.theta_i_deg = {}; });
  refused([](PolarOptions& o) { o.theta_i_deg = {90.0}; });
  refused([](PolarOptions& o) { o.theta_i_deg = {std::nan("")}; });
  refused([](PolarOptions& o) { o.width_px = 0; });
}

TEST(PlotLabels, ReadBackAsTheirNumber) {
  for (const double value : {0.0, 0.25, 1.0, 1000.0, 2e-5, 5e7, 1e-12, 1e38, 3e-38}) {
    const double read = number_of_label(number_label(value));
    EXPECT_NEAR(read, value, 1e-9 * value) << number_label(value);
  }
  EXPECT_EQ(power_label(-3), "10⁻³");
  EXPECT_EQ(power_label(38), "10³⁸");
}

}  // namespace
}  // namespace brdfit::render
