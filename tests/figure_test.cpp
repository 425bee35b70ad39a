// Figures keep their picture's pixels, and what is around it says what it shows.
#include "render/figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "brdf/material.h"
#include "render/axes.h"
#include "render/caption.h"
#include "render/text_layout.h"
#include "tests/picture_tools.h"

namespace brdfit::render {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::Field;
using testing::Ge;
using testing::Gt;
using testing::Le;
using testing::Lt;
using testing::UnorderedElementsAre;
using tests::Box;
using tests::cut;
using tests::pixel_at;
using tests::Place;
using tests::places_of;
using tests::shows_text;

constexpr int kSize = 300;
constexpr int kTextPx = 16;
constexpr TextStyle kText = {.size_px = kTextPx};

Material shiny() {
  Material material(Model::kLambertGgx);
  material.set("roughness", 0.4);
  return material;
}

SliceOptions slice_options(ThetaHAxis axis = ThetaHAxis::kLinear) {
  SliceOptions options;
  options.size = kSize;
  options.axis = axis;
  return options;
}

Image slice(ThetaHAxis axis = ThetaHAxis::kLinear) {
  return draw_slice(shiny(), slice_options(axis));
}

// Rows of the given numbers of pixels without a value.
Image with_missing(std::size_t unmeasured, std::size_t not_finite, std::size_t negative) {
  Image image = slice();
  std::size_t k = 5000;
  const auto set = [&](std::size_t count, PixelState state) {
    for (std::size_t end = k + count; k < end; ++k) image.state[k] = state;
  };
  set(unmeasured, PixelState::kUnmeasured);
  set(not_finite, PixelState::kNotFinite);
  set(negative, PixelState::kNegative);
  // The rest as if all were above the horizon.
  for (PixelState& state : image.state) {
    if (state == PixelState::kBelowHorizon) state = PixelState::kValue;
  }
  return image;
}

Place place_of(const Image& image, const ViewOptions& view, const Picture& figure) {
  const std::vector<Place> places = places_of(to_picture(image, view), figure);
  EXPECT_EQ(places.size(), 1U);
  return places.empty() ? Place{} : places.front();
}

FigureOptions titled(const std::string& title) {
  FigureOptions options;
  options.title = title;
  return options;
}

void expect_same_outside(const Picture& a, const Picture& b, const Box& box) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const bool inside = x >= box.begin.x && x < box.end.x && y >= box.begin.y && y < box.end.y;
      if (inside) continue;
      ASSERT_EQ(pixel_at(a, x, y), pixel_at(b, x, y)) << x << " " << y;
    }
  }
}

TEST(SliceFigure, HoldsThePicturesOwnPixels) {
  for (const ViewTransform transform : {ViewTransform::kSrgb, ViewTransform::kGranTurismo}) {
    for (const bool axes : {true, false}) {
      FigureOptions options = titled("gold paint");
      options.axes = axes;
      options.view.transform = transform;
      options.view.exposure_stops = 1.5;
      options.view.channel = Channel::kRed;
      place_of(slice(), options.view, slice_figure(slice(), slice_options(), options));
    }
  }
}

TEST(SliceFigure, SaysWhatItShows) {
  FigureOptions options = titled("Callisto, 3 effects");
  options.view.exposure_stops = 1.5;
  SliceOptions shown = slice_options();
  shown.phi_d_deg = 37.5;
  shown.quantity = Quantity::kFCos;
  const Picture figure = slice_figure(slice(), shown, options);
  EXPECT_TRUE(shows_text(figure, "Callisto, 3 effects", {.size_px = 20, .weight = FontWeight::kBold}));
  EXPECT_TRUE(shows_text(figure, "φd = 37.5°, f cos θi (sr⁻¹),", kText));
  EXPECT_TRUE(shows_text(figure, "+1.5", kText));
  EXPECT_TRUE(shows_text(figure, "half angle θh (degrees)", kText));
  EXPECT_TRUE(shows_text(figure, "difference angle θd (degrees)", {.size_px = kTextPx, .upwards = true}));
  const Picture root = slice_figure(slice(), slice_options(ThetaHAxis::kSquareRoot), options);
  EXPECT_FALSE(shows_text(root, "half angle θh (degrees)", kText));
  EXPECT_TRUE(shows_text(root, "half angle θh (sqrt axis)", kText) ||
              shows_text(root, "half angle θh (degrees, square-root axis)", kText));
}

TEST(SliceFigure, LeavesOutAxesOnRequest) {
  FigureOptions options;
  options.axes = false;
  const Picture plain = slice_figure(slice(), slice_options(), options);
  EXPECT_FALSE(shows_text(plain, "half angle θh (degrees)", kText));
  EXPECT_LT(plain.height, slice_figure(slice(), slice_options(), {}).height);
}

// Marks are looked for in the pixels beside the picture's frame.
TEST(SliceFigure, HasTicksAtTheRightPlaces) {
  for (const ThetaHAxis axis : {ThetaHAxis::kLinear, ThetaHAxis::kSquareRoot}) {
    const Picture figure = slice_figure(slice(axis), slice_options(axis), {});
    const Place at = place_of(slice(axis), {}, figure);
    std::vector<int> below;
    for (int x = -6; x <= kSize + 6; ++x) {
      if (pixel_at(figure, at.x + x, at.y + kSize + 2) != tests::kWhite) below.push_back(x);
    }
    std::vector<int> beside;
    for (int y = kSize + 6; y >= -6; --y) {
      if (pixel_at(figure, at.x - 3, at.y + y) != tests::kWhite) beside.push_back(kSize - y);
    }
    EXPECT_THAT(beside, ElementsAre(0, 50, 100, 150, 200, 250, 300));
    if (axis == ThetaHAxis::kLinear) {
      EXPECT_THAT(below, ElementsAre(0, 50, 100, 150, 200, 250, 300));
    } else {
      // 300 sqrt(deg / 90) of 0, 1, 5, 15, ... 90 degrees.
      EXPECT_THAT(below, ElementsAre(0, 32, 71, 122, 173, 212, 245, 274, 300));
    }
    // Numbers: on theta_d upwards beside the marks, on theta_h to the right below them.
    const auto middles = [&](const char* number) {
      const Picture text = tests::picture_of_text(number, kText);
      std::vector<Place> places = places_of(text, figure);
      for (Place& place : places) place = {place.x + text.width / 2 - at.x, place.y + text.height / 2 - at.y};
      // The caption further down has angles too.
      std::erase_if(places, [](const Place& place) { return place.y > kSize + 2 * kTextPx; });
      return places;
    };
    const auto below_mark = [](int x) {
      return AllOf(Field(&Place::x, AllOf(Ge(x - 3), Le(x + 3))), Field(&Place::y, Gt(kSize)));
    };
    const auto beside_mark = [](int y) {
      return AllOf(Field(&Place::y, AllOf(Ge(y - 3), Le(y + 3))), Field(&Place::x, Lt(0)));
    };
    EXPECT_THAT(middles("90°"), UnorderedElementsAre(beside_mark(0), below_mark(kSize)));
    EXPECT_THAT(middles("15°"), UnorderedElementsAre(beside_mark(250),
                                                     below_mark(below[axis == ThetaHAxis::kLinear ? 1 : 3])));
  }
}

TEST(Ticks, StandWhereThePixelsHaveThatAngle) {
  for (const ThetaHAxis axis : {ThetaHAxis::kLinear, ThetaHAxis::kSquareRoot}) {
    for (const int size : {1, 64, 97, 512, 1000}) {
      SliceOptions options = slice_options(axis);
      options.size = size;
      const auto pixels_below = [&](int deg, bool theta_h) {
        int count = 0;
        for (int k = 0; k < size; ++k) {
          const HalfDiff angles = theta_h ? slice_angles(options, k, 0) : slice_angles(options, 0, k);
          if ((theta_h ? angles.theta_h_rad : angles.theta_d_rad) < deg * std::numbers::pi / 180.0) ++count;
        }
        return count;
      };
      for (const Tick& tick : theta_h_ticks(axis, size)) {
        EXPECT_NEAR(tick.pixel, pixels_below(tick.deg, true), 1) << size << " " << tick.deg;
      }
      for (const Tick& tick : theta_d_ticks(size)) {
        EXPECT_NEAR(tick.pixel, pixels_below(tick.deg, false), 1) << size << " " << tick.deg;
      }
    }
  }
}

TEST(DescribeMissing, CountsPixelsByWhatTheyAre) {
  EXPECT_EQ(describe_missing(with_missing(0, 0, 0)), "");
  EXPECT_EQ(describe_missing(with_missing(312, 0, 3)),
            "312 pixels not measured (hatched grey); 3 pixels negative (hatched cyan)");
  EXPECT_EQ(describe_missing(with_missing(0, 1, 0)), "1 pixel NaN or infinite (hatched magenta)");
  Image image(2, 2);
  image.state = {PixelState::kValue, PixelState::kOutside, PixelState::kBelowHorizon,
                 PixelState::kBelowHorizon};
  EXPECT_EQ(describe_missing(image), "2 pixels below the horizon (dark)");
}

TEST(SliceFigure, NamesPixelsWithoutAValueWithTheirCounts) {
  const Picture figure = slice_figure(with_missing(312, 21, 1), slice_options(), {});
  for (const char* note : {"312 pixels not measured", "21 pixels NaN or infinite", "1 pixel negative"}) {
    EXPECT_TRUE(shows_text(figure, note, kText)) << note;
  }
  // Each note has a sample of the hatching, which the picture's own pixels alone would not leave outside it.
  for (const PixelState state : {PixelState::kUnmeasured, PixelState::kNotFinite, PixelState::kNegative}) {
    Image sample(kTextPx, kTextPx);
    sample.state.assign(sample.pixel_count(), state);
    const Picture swatch = cut(to_picture(sample, {}), {{1, 1}, {kTextPx - 1, kTextPx - 1}});
    EXPECT_EQ(places_of(swatch, figure).size(), 1U);
  }
  const Picture complete = slice_figure(with_missing(0, 0, 0), slice_options(), {});
  EXPECT_FALSE(shows_text(complete, "pixels", kText));
  EXPECT_FALSE(shows_text(complete, "pixel", kText));
  EXPECT_GE(figure.height, complete.height + 3 * row_height(kTextPx));
}

TEST(SliceFigure, NamesRegionsInsideThePictureAlone) {
  const Picture without = slice_figure(slice(), slice_options(), {});
  FigureOptions options;
  options.regions = true;
  const Picture with = slice_figure(slice(), slice_options(), options);
  const Place at = place_of(slice(), {}, without);
  const Box inside{at, {at.x + kSize, at.y + kSize}};
  expect_same_outside(with, without, inside);
  // Each name leaves ink in its own part of the picture, white on dark: Fresnel at the top, specular on the
  // left, retroreflection on the right, diffuse in the middle.
  const auto changes_in = [&](int left, int top, int right, int bottom) {
    int changed = 0;
    for (int y = at.y + top; y < at.y + bottom; ++y) {
      for (int x = at.x + left; x < at.x + right; ++x) {
        if (pixel_at(with, x, y) != pixel_at(without, x, y)) ++changed;
      }
    }
    return changed;
  };
  const int third = kSize / 3;
  EXPECT_GT(changes_in(third, 0, 2 * third, third / 2), 100);
  EXPECT_GT(changes_in(0, third, third / 2, 2 * third), 100);
  EXPECT_GT(changes_in(kSize - third / 2, third, kSize, 2 * third), 100);
  EXPECT_GT(changes_in(third, third, 2 * third, 2 * third), 100);
  EXPECT_EQ(changes_in(0, 2 * third + third / 2, kSize, kSize), 0);
}

TEST(SliceFigure, TextGrowsWithThePicture) {
  EXPECT_EQ(figure_text_px(1), 16);
  for (int size = 64; size <= 4096; size *= 2) {
    EXPECT_GE(figure_text_px(size), figure_text_px(size / 2));
    // Half the size of a figure that is shown at half size: 8 pixels at least.
    EXPECT_GE(figure_text_px(size), 16);
  }
  EXPECT_GE(figure_text_px(2048), 64);
}

TEST(SliceFigure, OfAnySizeIsDrawn) {
  for (const int size : {1, 2, 7, 33}) {
    SliceOptions options = slice_options();
    options.size = size;
    FigureOptions with_regions = titled("a title that is much longer than the picture is wide");
    with_regions.regions = true;
    const Picture figure = slice_figure(draw_slice(shiny(), options), options, with_regions);
    EXPECT_GT(figure.width, size);
    EXPECT_TRUE(shows_text(figure, "longer", {.size_px = 20, .weight = FontWeight::kBold}));
  }
}

TEST(PlainFigure, HoldsThePictureWithTitleCaptionAndCounts) {
  Image image = with_missing(40, 0, 0);
  image.state[0] = PixelState::kOutside;
  const Picture figure = plain_figure(image, "light at 90°, exposure 0 stops", titled("sphere"));
  const Place at = place_of(image, {}, figure);
  EXPECT_TRUE(shows_text(figure, "sphere", {.size_px = 20, .weight = FontWeight::kBold}));
  EXPECT_TRUE(shows_text(figure, "light at 90°, exposure 0 stops", kText));
  EXPECT_TRUE(shows_text(figure, "40 pixels not measured", kText));
  EXPECT_FALSE(shows_text(figure, "half angle θh (degrees)", kText));
  EXPECT_GT(at.y, 20);
}

TEST(PlainFigure, NeedsNoText) {
  const Image image = with_missing(0, 0, 0);
  const Picture figure = plain_figure(image, "", {});
  const Place at = place_of(image, {}, figure);
  // A picture in a frame on paper.
  const Box ink = tests::ink_box(figure);
  EXPECT_EQ(ink.begin, (Place{at.x - 1, at.y - 1}));
  EXPECT_EQ(ink.end, (Place{at.x + kSize + 1, at.y + kSize + 1}));
}

TEST(PrettyNumber, HasARealMinusSignAndNoPadding) {
  EXPECT_EQ(pretty_number(0.0), "0");
  EXPECT_EQ(pretty_number(0.05), "0.05");
  EXPECT_EQ(pretty_number(-1200.0), "−1200");
  EXPECT_EQ(pretty_number(2e-5), "2e−5");
  EXPECT_EQ(pretty_number(-2.5e-12), "−2.5e−12");
  EXPECT_EQ(pretty_number(1e20), "1e20");
  EXPECT_EQ(pretty_number(1e100), "1e100");
  EXPECT_EQ(pretty_number(1.0 / 3.0, 4), "0.3333");
}

TEST(Captions, SayTheViewAndTheSlice) {
  EXPECT_EQ(describe_view({}), "exposure 0 stops, sRGB");
  EXPECT_EQ(describe_view({ViewTransform::kGranTurismo, 1.0, Channel::kRed}),
            "exposure +1 stop, Gran Turismo tone mapping, red channel");
  EXPECT_EQ(describe_view({ViewTransform::kLinear, -0.5, Channel::kLuminance}),
            "exposure −0.5 stops, linear (no display curve), luminance");
  SliceOptions options = slice_options();
  EXPECT_EQ(describe_slice(options), "φd = 90°, f (sr⁻¹)");
  options.sampling = SliceSampling::kStored;
  options.quantity = Quantity::kFCos;
  EXPECT_EQ(describe_slice(options), "φd = 90°, f cos θi (sr⁻¹), at the stored angles");
}

TEST(WrapText, KeepsWordsAndFitsTheWidth) {
  const std::string text = "312 pixels not measured (hatched grey), θh and φd, incomprehensibilities";
  for (int width = 20; width < 600; width += 7) {
    std::string joined;
    for (const std::string& line : wrap_text(text, kTextPx, FontWeight::kRegular, width)) {
      EXPECT_LE(text_width(line, kTextPx, FontWeight::kRegular), width) << line;
      joined += line;
    }
    std::string words = text;
    std::erase(words, ' ');
    std::erase(joined, ' ');
    EXPECT_EQ(joined, words);
  }
  EXPECT_THAT(wrap_text("", kTextPx, FontWeight::kRegular, 100), ElementsAre(""));
  EXPECT_THAT(wrap_text("a\n\nb", kTextPx, FontWeight::kRegular, 100), ElementsAre("a", "", "b"));
  // A letter that is wider than the column has a line of its own.
  EXPECT_THAT(wrap_text("θφ", kTextPx, FontWeight::kRegular, 1), ElementsAre("θ", "φ"));
}

}  // namespace
}  // namespace brdfit::render
