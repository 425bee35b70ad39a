// Pictures look as they did when somebody looked at them, and the comparison that says so sees real changes.
#include "tests/golden.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "brdf/half_diff.h"
#include "brdf/material.h"
#include "brdf/models.h"
#include "measured/table.h"
#include "render/canvas.h"
#include "render/figure.h"
#include "render/panel.h"
#include "render/slice.h"
#include "render/sphere.h"

namespace brdfit::render {
namespace {

using tests::compare_pictures;
using tests::is_golden;

constexpr Grid kGrid = {45, 30, 18, CellAnchor::kLowerEdge};

Material gold(double roughness = 0.35) {
  Material material(Model::kLambertGgx);
  material.set("base_color", Rgb{0.55, 0.32, 0.12});
  material.set("specular", 0.9);
  material.set("roughness", roughness);
  return material;
}

Material burley() {
  Material material(Model::kBurley);
  material.set("base_color", Rgb{0.5, 0.33, 0.15});
  material.set("roughness", 0.45);
  return material;
}

Material callisto() {
  Material material(Model::kCallisto);
  material.set("base_color", Rgb{0.6, 0.3, 0.1});
  material.set("specular", 0.7);
  material.set("roughness", 0.3);
  return material;
}

// A measurement of gold with fixed holes: a block that was not measured, cells with NaN and negative
// channels.
MeasuredTable measured_gold() {
  std::vector<float> planes(3 * kGrid.cell_count(), -1.0F);
  for (std::size_t cell = 0; cell < kGrid.cell_count(); ++cell) {
    const DirectionPair pair = directions_from_half_diff(kGrid.angles_of(cell));
    if (pair.wi.z < 1e-6 || pair.wo.z < 1e-6) continue;
    const Rgb f = eval(gold(), pair.wi, pair.wo);
    for (std::size_t c = 0; c < 3; ++c) planes[c * kGrid.cell_count() + cell] = static_cast<float>(f[c]);
  }
  const auto at = [&](int h, int d, int p, std::size_t c) -> float& {
    return planes[c * kGrid.cell_count() + kGrid.index(h, d, p)];
  };
  for (int p = 0; p < kGrid.n_phi_d; ++p) {
    for (int h = 24; h < 30; ++h) {
      for (int d = 3; d < 7; ++d) {
        for (std::size_t c = 0; c < 3; ++c) at(h, d, p, c) = -1.0F;
      }
    }
    for (int d = 12; d < 15; ++d) at(20, d, p, 0) = std::numeric_limits<float>::quiet_NaN();
    for (int d = 18; d < 21; ++d) at(12, d, p, 2) = -0.5F;
  }
  return {kGrid, std::move(planes)};
}

ViewOptions view_of(double stops) {
  ViewOptions view;
  view.exposure_stops = stops;
  return view;
}

Picture slice_figure_of(const Material& material, double stops) {
  SliceOptions slice;
  slice.size = 128;
  slice.axis = ThetaHAxis::kSquareRoot;
  FigureOptions options;
  options.title = "gold";
  options.view = view_of(stops);
  options.regions = true;
  return slice_figure(draw_slice(material, slice), slice, options);
}

Picture side_by_side(const std::vector<Picture>& pictures) {
  Canvas canvas(static_cast<int>(pictures.size()) * pictures[0].width, pictures[0].height, {});
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    canvas.paste(pictures[k], static_cast<int>(k) * pictures[0].width, 0);
  }
  return canvas.picture();
}

Picture spheres_of(const Material& material, double stops) {
  std::vector<Picture> pictures;
  for (const double light : kLightAnglesDeg) {
    pictures.push_back(to_picture(draw_lit(material, Shape::kSphere, light, 64), view_of(stops)));
  }
  return side_by_side(pictures);
}

Picture environments_of(const Material& material, double stops) {
  std::vector<Picture> pictures;
  for (const Environment environment : {Environment::kUniform, Environment::kGradient}) {
    pictures.push_back(to_picture(draw_environment(material, environment, 64).image, view_of(stops)));
  }
  return side_by_side(pictures);
}

// The material is the last column.
Picture panel_of(const Material& material, double stops) {
  const MeasuredTable table = measured_gold();
  const Material first = burley();
  const std::vector<Column> columns = {
      {"measured", table, {"cells\t24300"}},
      {"Burley", first, {"log-ratio\t0.142", "", "roughness\t0.45"}},
      {"Callisto", material, {"log-ratio\t0.087", "", "roughness\t0.3", "θ, φ, Δ, sr⁻¹, −1"}}};
  SliceOptions slice;
  slice.size = 96;
  slice.sampling = SliceSampling::kStored;
  PanelOptions options;
  options.title = "gold";
  options.view = view_of(stops);
  options.difference = DifferenceKind::kLogRatio;
  return slice_panel(columns, slice, options);
}

struct Case {
  std::string name;
  Material material;
  double stops;
  std::function<Picture(const Material&, double)> draw;
  friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }
};

Picture draw(const Case& c) {
  return c.draw(c.material, c.stops);
}

std::vector<Case> cases() {
  return {{"slice_figure", gold(), 0.0, slice_figure_of},
          {"spheres", gold(), 0.0, spheres_of},
          {"environments", gold(), 0.0, environments_of},
          {"panel", callisto(), 0.5, panel_of}};
}

class Golden : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Pictures, Golden, testing::ValuesIn(cases()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(Golden, IsAsItWas) {
  EXPECT_TRUE(is_golden(draw(GetParam()), GetParam().name));
}

TEST_P(Golden, TenPercentMoreRoughnessIsNoticed) {
  const Case& c = GetParam();
  Material rougher = c.material;
  rougher.set("roughness", 1.1 * c.material.number("roughness"));
  const auto difference = compare_pictures(draw(c), c.draw(rougher, c.stops));
  EXPECT_TRUE(difference.is_noticed()) << difference;
  RecordProperty("difference", testing::PrintToString(difference));
}

TEST_P(Golden, AQuarterStopOfExposureIsNoticed) {
  const Case& c = GetParam();
  const auto difference = compare_pictures(draw(c), c.draw(c.material, c.stops + 0.25));
  EXPECT_TRUE(difference.is_noticed()) << difference;
  RecordProperty("difference", testing::PrintToString(difference));
}

TEST_P(Golden, AShiftByOneColumnIsNoticed) {
  const Picture picture = draw(GetParam());
  Canvas shifted(picture.width, picture.height, {});
  shifted.paste(picture, 0, 0);
  shifted.paste(picture, 1, 0);
  const auto difference = compare_pictures(picture, shifted.picture());
  EXPECT_TRUE(difference.is_noticed()) << difference;
  RecordProperty("difference", testing::PrintToString(difference));
}

TEST_P(Golden, RoundingIsNotNoticed) {
  const Picture picture = draw(GetParam());
  Picture rounded = picture;
  for (std::size_t k = 0; k < rounded.rgb.size(); ++k) {
    const int code = rounded.rgb[k] + static_cast<int>(k * 7919 % 3) - 1;
    rounded.rgb[k] = static_cast<std::uint8_t>(std::clamp(code, 0, 255));
  }
  const auto difference = compare_pictures(picture, rounded);
  EXPECT_FALSE(difference.is_noticed()) << difference;
}

TEST(IsGolden, FailsForAMissingFileAndNamesWhatWasDrawn) {
  if (std::getenv("BRDFIT_UPDATE_GOLDEN") != nullptr) GTEST_SKIP() << "would write the file";
  const testing::AssertionResult result = is_golden(Picture(3, 2), "there_is_no_such_picture");
  EXPECT_FALSE(result);
  EXPECT_THAT(result.message(), testing::HasSubstr("there_is_no_such_picture.png"));
  const auto drawn = std::filesystem::path(BRDFIT_GOLDEN_NEW) / "there_is_no_such_picture.png";
  EXPECT_TRUE(std::filesystem::exists(drawn));
  EXPECT_EQ(tests::read_picture(drawn).width, 3);
  std::filesystem::remove(drawn);
}

TEST(ComparePictures, OfOneSizeAlone) {
  EXPECT_TRUE(compare_pictures(Picture(3, 2), Picture(2, 3)).is_noticed());
  EXPECT_FALSE(compare_pictures(Picture(3, 2), Picture(3, 2)).is_noticed());
}

}  // namespace
}  // namespace brdfit::render
