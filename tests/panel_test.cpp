// Panels show every column on one pixel grid, with its own numbers below it.
#include "render/panel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "brdf/half_diff.h"
#include "brdf/material.h"
#include "brdf/models.h"
#include "render/text_layout.h"
#include "tests/picture_tools.h"

namespace brdfit::render {
namespace {

using tests::Box;
using tests::cut;
using tests::pixel_at;
using tests::Place;
using tests::places_of;
using tests::shows_text;

constexpr int kSize = 96;
constexpr int kTextPx = 16;
constexpr int kColumnWidth = 11 * kTextPx;
constexpr int kGap = kTextPx;
constexpr Grid kGrid = {30, 20, 12, CellAnchor::kLowerEdge};

Material material_of(double roughness) {
  Material material(Model::kLambertGgx);
  material.set("roughness", roughness);
  return material;
}

// f of a material at the stored angles, where both directions are above the horizon; in some cells NaN,
// nothing measured, or some channels negative.
MeasuredTable table_of(const Material& material, bool with_holes) {
  std::vector<float> planes(3 * kGrid.cell_count(), -1.0F);
  for (std::size_t cell = 0; cell < kGrid.cell_count(); ++cell) {
    const DirectionPair pair = directions_from_half_diff(kGrid.angles_of(cell));
    if (pair.wi.z < 1e-6 || pair.wo.z < 1e-6) continue;
    const Rgb f = eval(material, pair.wi, pair.wo);
    for (std::size_t c = 0; c < 3; ++c) planes[c * kGrid.cell_count() + cell] = static_cast<float>(f[c]);
    if (!with_holes) continue;
    if (cell % 29 == 0) planes[cell] = std::numeric_limits<float>::quiet_NaN();
    if (cell % 31 == 0) planes[cell] = -1.0F;
    if (cell % 37 == 0) {
      for (std::size_t c = 0; c < 3; ++c) planes[c * kGrid.cell_count() + cell] = -1.0F;
    }
  }
  return {kGrid, std::move(planes)};
}

SliceOptions slice_options() {
  SliceOptions options;
  options.size = kSize;
  options.sampling = SliceSampling::kStored;
  return options;
}

SliceOptions on_the_tables_grid() {
  SliceOptions options = slice_options();
  options.grid = kGrid;
  return options;
}

PanelOptions titled() {
  PanelOptions options;
  options.title = "gold paint";
  return options;
}

PanelOptions without_difference() {
  PanelOptions options = titled();
  options.show_difference = false;
  return options;
}

// The one place of a picture in a panel.
Place place_of(const Picture& picture, const Picture& panel) {
  const std::vector<Place> places = places_of(picture, panel);
  EXPECT_EQ(places.size(), 1U);
  return places.empty() ? Place{} : places.front();
}

bool is_paper(const Picture& picture, const Box& box) {
  return tests::ink_box(cut(picture, box)).is_empty();
}

// Three columns: a table with holes and two materials.
struct Three {
  Material truth = material_of(0.4);
  Material near = material_of(0.45);
  Material far = material_of(0.7);
  MeasuredTable table = table_of(truth, true);

  std::vector<Column> columns() const {
    return {{"measured", table, {}}, {"Burley", near, {}}, {"Callisto", far, {}}};
  }
};

TEST(SlicePanel, ShowsAllColumnsOnThePixelGridOfTheReference) {
  const Three three;
  const Picture panel = slice_panel(three.columns(), slice_options(), titled());
  std::vector<Place> places;
  for (const Column& column : three.columns()) {
    places.push_back(place_of(to_picture(draw_slice(column.subject, on_the_tables_grid()), {}), panel));
  }
  for (std::size_t c = 1; c < places.size(); ++c) {
    EXPECT_EQ(places[c].y, places[0].y);
    EXPECT_EQ(places[c].x - places[c - 1].x, kColumnWidth + kGap);
  }
}

TEST(SlicePanel, ShowsDifferencesBelowTheirColumns) {
  const Three three;
  for (const DifferenceKind kind :
       {DifferenceKind::kSigned, DifferenceKind::kAbsolute, DifferenceKind::kLogRatio}) {
    PanelOptions options = titled();
    options.difference = kind;
    options.view.exposure_stops = 1.0;
    const Picture panel = slice_panel(three.columns(), slice_options(), options);
    std::vector<Image> images;
    for (const Column& column : three.columns()) {
      images.push_back(draw_slice(column.subject, on_the_tables_grid()));
    }
    const std::vector<Difference> all = {difference_of(images[1], images[0], kind, options.view),
                                         difference_of(images[2], images[0], kind, options.view)};
    const double range = difference_range(all);
    for (std::size_t c = 1; c < 3; ++c) {
      const Place model = place_of(to_picture(images[c], options.view), panel);
      const Place difference = place_of(difference_picture(all[c - 1], kind, range), panel);
      EXPECT_EQ(difference.x, model.x);
      EXPECT_GT(difference.y, model.y + kSize);
    }
    place_of(colour_bar(kind, range, "", kSize, kTextPx), panel);
  }
}

TEST(SlicePanel, TakesTheRangeThatIsAskedFor) {
  const Three three;
  PanelOptions options = titled();
  options.range = 0.125;
  const Picture panel = slice_panel(three.columns(), slice_options(), options);
  place_of(colour_bar(DifferenceKind::kSigned, 0.125, "", kSize, kTextPx), panel);
  options.range = 1e-9;
  EXPECT_TRUE(shows_text(slice_panel(three.columns(), slice_options(), options), "beyond"));
  options.range = 1e9;
  EXPECT_FALSE(shows_text(slice_panel(three.columns(), slice_options(), options), "beyond"));
}

TEST(SlicePanel, ShowsAndCountsWhatTheTableDoesNotHold) {
  const Three three;
  const Image image = draw_slice(three.table, on_the_tables_grid());
  const auto counts = image.counts();
  const Picture panel = slice_panel(three.columns(), slice_options(), titled());
  const auto count_of = [&](PixelState state) { return counts[static_cast<std::size_t>(state)]; };
  const auto expect_note = [&](PixelState state, const std::string& words) {
    ASSERT_GT(count_of(state), 0U);
    EXPECT_TRUE(shows_text(panel, std::to_string(count_of(state)) + words)) << words;
    Image sample(kTextPx, kTextPx);
    sample.state.assign(sample.pixel_count(), state);
    // One swatch, in the reference's column.
    const Picture swatch = cut(to_picture(sample, {}), {{1, 1}, {kTextPx - 1, kTextPx - 1}});
    const std::vector<Place> places = places_of(swatch, panel);
    const Place pictures = place_of(to_picture(image, {}), panel);
    EXPECT_EQ(std::count_if(places.begin(), places.end(),
                            [&](const Place& place) {
                              return place.x == pictures.x + 1 && place.y > pictures.y + 2 * kSize;
                            }),
              1);
  };
  expect_note(PixelState::kUnmeasured, " pixels not");
  expect_note(PixelState::kNotFinite, " pixels NaN or");
  expect_note(PixelState::kNegative, " pixels");
  // A table without holes has no such notes.
  const MeasuredTable complete = table_of(three.truth, false);
  const std::vector<Column> columns = {{"measured", complete, {}}};
  EXPECT_FALSE(shows_text(slice_panel(columns, slice_options(), titled()), " pixels NaN or"));
}

TEST(SlicePanel, WritesTheColumnsLinesBelowThem) {
  const Three three;
  std::vector<Column> columns = three.columns();
  const Picture without = slice_panel(columns, slice_options(), without_difference());
  columns[0].lines = {"valid cells\t5123"};
  columns[1].lines = {"", "roughness\t0.45"};
  columns[2].lines = {"", "log-ratio error\t0.021", "", "Δ 7.5%"};
  const Picture with = slice_panel(columns, slice_options(), without_difference());
  EXPECT_GE(with.height, without.height);
  const auto column_of = [&](std::size_t c) {
    const Place at = place_of(to_picture(draw_slice(columns[c].subject, on_the_tables_grid()), {}), with);
    return cut(with, {{at.x, at.y + kSize}, {at.x + kColumnWidth, with.height}});
  };
  EXPECT_TRUE(shows_text(column_of(0), "valid cells"));
  EXPECT_TRUE(shows_text(column_of(0), "5123"));
  EXPECT_TRUE(shows_text(column_of(1), "roughness"));
  EXPECT_TRUE(shows_text(column_of(1), "0.45"));
  EXPECT_FALSE(shows_text(column_of(1), "5123"));
  EXPECT_TRUE(shows_text(column_of(2), "log-ratio"));
  EXPECT_TRUE(shows_text(column_of(2), "Δ 7.5%"));
}

TEST(SlicePanel, LongLinesDoNotRunIntoTheNeighbour) {
  const Three three;
  std::vector<Column> columns = three.columns();
  const Picture without = slice_panel(columns, slice_options(), without_difference());
  const std::string word = "an_effect_with_a_name_that_no_column_is_wide_enough_for";
  for (Column& column : columns) {
    column.lines = {word, word + "\t" + word, "specular fresnel falloff and diffuse fresnel falloff\t0.25"};
  }
  const Picture with = slice_panel(columns, slice_options(), without_difference());
  ASSERT_GT(with.height, without.height + 10 * row_height(kTextPx));
  ASSERT_EQ(with.width, without.width);
  const int begin = without.height - kTextPx;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const int x = place_of(to_picture(draw_slice(columns[c].subject, on_the_tables_grid()), {}), with).x;
    EXPECT_FALSE(is_paper(with, {{x, begin}, {x + kColumnWidth, with.height}}));
    EXPECT_TRUE(is_paper(with, {{x + kColumnWidth + 2, begin}, {x + kColumnWidth + kGap - 2, with.height}}));
  }
}

TEST(SlicePanel, LongTitlesDoNotRunIntoTheNeighbour) {
  const Three three;
  std::vector<Column> columns = three.columns();
  for (Column& column : columns) column.title = "Callisto_with_all_its_effects_and_correlated_masking";
  PanelOptions options = without_difference();
  options.title = "";
  const Picture panel = slice_panel(columns, slice_options(), options);
  const Place first = place_of(to_picture(draw_slice(three.table, on_the_tables_grid()), {}), panel);
  const int gap = first.x + kColumnWidth;
  EXPECT_TRUE(is_paper(panel, {{gap + 2, first.y - 2 * row_height(kTextPx)}, {gap + kGap - 2, first.y}}));
}

TEST(SlicePanel, OfOneColumnHasNoDifferences) {
  const Material material = material_of(0.3);
  const std::vector<Column> columns = {{"Lambert + GGX", material, {"roughness\t0.3"}}};
  const Picture panel = slice_panel(columns, slice_options(), titled());
  place_of(to_picture(draw_slice(material, slice_options()), {}), panel);
  EXPECT_TRUE(shows_text(panel, "Lambert + GGX", {.size_px = kTextPx, .weight = FontWeight::kBold}));
  EXPECT_EQ(panel.rgb, slice_panel(columns, slice_options(), without_difference()).rgb);
}

TEST(SlicePanel, NamesWhatIsSubtracted) {
  const Three three;
  PanelOptions options = titled();
  EXPECT_TRUE(
      shows_text(slice_panel(three.columns(), slice_options(), options), "model − measured, luminance of"));
  options.difference = DifferenceKind::kLogRatio;
  options.view.channel = Channel::kRed;
  EXPECT_TRUE(shows_text(slice_panel(three.columns(), slice_options(), options),
                         "ln of (model + 0.001) / (measured + 0.001), red channel"));
}

TEST(SlicePanel, WritesRegionsOnTheReferenceAlone) {
  const Three three;
  PanelOptions options = titled();
  const Picture without = slice_panel(three.columns(), slice_options(), options);
  options.regions = true;
  const Picture with = slice_panel(three.columns(), slice_options(), options);
  const Place at = place_of(to_picture(draw_slice(three.table, on_the_tables_grid()), {}), without);
  EXPECT_TRUE(places_of(to_picture(draw_slice(three.table, on_the_tables_grid()), {}), with).empty());
  for (int y = 0; y < with.height; ++y) {
    for (int x = 0; x < with.width; ++x) {
      const bool inside = x >= at.x && x < at.x + kSize && y >= at.y && y < at.y + kSize;
      if (inside) continue;
      ASSERT_EQ(pixel_at(with, x, y), pixel_at(without, x, y));
    }
  }
}

TEST(Panel, RefusesWhatItCannotShow) {
  const Three three;
  const std::vector<double> lights = {0.0};
  for (const double range :
       {-1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    PanelOptions options;
    options.range = range;
    EXPECT_THROW(slice_panel(three.columns(), slice_options(), options), std::invalid_argument);
    EXPECT_THROW(sphere_panel(three.columns(), Shape::kSphere, lights, 16, options), std::invalid_argument);
    EXPECT_THROW(environment_panel(three.columns(), 16, options), std::invalid_argument);
  }
  EXPECT_THROW(slice_panel({}, slice_options(), {}), std::invalid_argument);
  EXPECT_THROW(sphere_panel({}, Shape::kSphere, lights, 16, {}), std::invalid_argument);
  EXPECT_THROW(environment_panel({}, 16, {}), std::invalid_argument);
  EXPECT_THROW(sphere_panel(three.columns(), Shape::kSphere, {}, 16, {}), std::invalid_argument);
  EXPECT_THROW(sphere_panel(three.columns(), Shape::kSphere, lights, 0, {}), std::invalid_argument);
  SliceOptions none = slice_options();
  none.size = 0;
  EXPECT_THROW(slice_panel(three.columns(), none, {}), std::invalid_argument);
}

TEST(SpherePanel, HasARowForEveryLight) {
  const Three three;
  const std::vector<double> lights = {0.0, 90.0, 120.0};
  for (const Shape shape : {Shape::kSphere, Shape::kPatch}) {
    const Picture panel = sphere_panel(three.columns(), shape, lights, kSize, titled());
    int last_y = -1;
    for (const double light : lights) {
      std::vector<Place> places;
      for (const Column& column : three.columns()) {
        places.push_back(place_of(to_picture(draw_lit(column.subject, shape, light, kSize), {}), panel));
      }
      EXPECT_EQ(places[0].y, places[1].y);
      EXPECT_EQ(places[1].y, places[2].y);
      EXPECT_GT(places[0].y, last_y);
      last_y = places[0].y + kSize;
    }
    // Beside the pictures and beside the differences.
    EXPECT_EQ(
        places_of(tests::picture_of_text("light at 0°", {.size_px = kTextPx, .upwards = true}), panel).size(),
        2U);
  }
}

TEST(SpherePanel, HasOneRangeForAllDifferences) {
  const Three three;
  const std::vector<double> lights = {0.0, 120.0};
  const Picture panel = sphere_panel(three.columns(), Shape::kSphere, lights, kSize, titled());
  std::vector<Difference> all;
  for (const double light : lights) {
    const Image reference = draw_lit(three.table, Shape::kSphere, light, kSize);
    for (const Material* model : {&three.near, &three.far}) {
      all.push_back(difference_of(draw_lit(*model, Shape::kSphere, light, kSize), reference,
                                  DifferenceKind::kSigned, {}));
    }
  }
  for (const Difference& difference : all) {
    place_of(difference_picture(difference, DifferenceKind::kSigned, difference_range(all)), panel);
  }
}

TEST(EnvironmentPanel, ShowsBothEnvironmentsAndStatesTheError) {
  const Material near = material_of(0.5);
  const Material far = material_of(0.8);
  const std::vector<Column> columns = {{"reference", near, {}}, {"model", far, {}}};
  const Picture panel = environment_panel(columns, kSize, titled());
  for (const Environment environment : {Environment::kUniform, Environment::kGradient}) {
    for (const Column& column : columns) {
      place_of(to_picture(draw_environment(column.subject, environment, kSize).image, {}), panel);
    }
  }
  EXPECT_TRUE(shows_text(panel, "quadrature error <"));
}

TEST(Panel, IsTheSameBytesWithAnyNumberOfThreads) {
  const Three three;
  const std::vector<double> lights = {0.0, 140.0};
  const auto draw_all = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return std::vector<std::vector<std::uint8_t>>{
        slice_panel(three.columns(), slice_options(), titled()).rgb,
        sphere_panel(three.columns(), Shape::kSphere, lights, kSize, titled()).rgb,
        environment_panel(three.columns(), kSize, titled()).rgb};
  };
  EXPECT_EQ(draw_all(1), draw_all(2));
}

}  // namespace
}  // namespace brdfit::render
