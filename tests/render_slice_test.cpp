// Slices hold what direct evaluation gives, pixel by pixel, and show what they do not hold as such.
#include "render/slice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <stdexcept>
#include <vector>

#include "brdf/models.h"
#include "fit/metrics.h"
#include "measured/slice.h"
#include "tests/fit_data.h"
#include "tests/random_parameters.h"

namespace brdfit::render {
namespace {

using testing_support::random_material;

constexpr double kDegree = std::numbers::pi / 180.0;
// Between a cosine that is 0 but for rounding and the lowest that a pixel of any size has.
constexpr double kHorizon = 1e-9;

struct Pixel {
  Rgb value;
  PixelState state;
};

Pixel pixel_of(const Image& image, int x, int y) {
  const std::size_t k =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
  return {{image.rgb[3 * k], image.rgb[3 * k + 1], image.rgb[3 * k + 2]}, image.state[k]};
}

void for_each_pixel(int size, const std::function<void(int, int)>& visit) {
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) visit(x, y);
  }
}

bool is_above_horizon(const DirectionPair& pair) {
  return std::min(pair.wi.z, pair.wo.z) >= kHorizon;
}

void expect_value(const Pixel& pixel, const Rgb& expected, double relative) {
  ASSERT_EQ(pixel.state, PixelState::kValue);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(pixel.value[c], expected[c], relative * expected[c] + 1e-40);
  }
}

void expect_no_value(const Pixel& pixel, PixelState state) {
  EXPECT_EQ(pixel.state, state);
  EXPECT_EQ(pixel.value, (Rgb{0.0, 0.0, 0.0}));
}

// Every pixel against the scalar evaluation at the angles that the slice says it shows.
void expect_is_direct_evaluation(const Material& material, const SliceOptions& options) {
  const Image image = draw_slice(material, options);
  ASSERT_EQ(image.width, options.size);
  ASSERT_EQ(image.height, options.size);
  for_each_pixel(options.size, [&](int x, int y) {
    const DirectionPair pair = directions_from_half_diff(slice_angles(options, x, y));
    const Pixel pixel = pixel_of(image, x, y);
    if (!is_above_horizon(pair)) return expect_no_value(pixel, PixelState::kBelowHorizon);
    const Rgb f = options.quantity == Quantity::kF ? eval(material, pair.wi, pair.wo)
                                                   : eval_cos(material, pair.wi, pair.wo);
    expect_value(pixel, f, 1e-6);
  });
}

MaterialOptions random_options(testing_support::Random& random) {
  MaterialOptions options;
  if (random() % 2 == 0) options.masking = Masking::kCorrelated;
  if (random() % 2 == 0) options.burley_g = BurleyG::k2017;
  if (random() % 2 == 0) options.diffuse = Diffuse::kProxima;
  return options;
}

class SliceOfModel : public testing::TestWithParam<Model> {};

INSTANTIATE_TEST_SUITE_P(Models, SliceOfModel, testing::ValuesIn(all_models().begin(), all_models().end()),
                         [](const auto& instance) {
                           std::string name(name_of(instance.param));
                           std::erase(name, '-');
                           return name;
                         });

TEST_P(SliceOfModel, EqualsDirectEvaluationAtEveryPixel) {
  testing_support::Random random(1);
  for (const double phi_d : {0.0, 37.5, 90.0, 180.0, 251.0, -20.0}) {
    for (const ThetaHAxis axis : {ThetaHAxis::kLinear, ThetaHAxis::kSquareRoot}) {
      for (const Quantity quantity : {Quantity::kF, Quantity::kFCos}) {
        Material material = random_material(GetParam(), effects_of(GetParam()), random);
        material.options() = random_options(random);
        SliceOptions options;
        options.size = 37;
        options.phi_d_deg = phi_d;
        options.axis = axis;
        options.quantity = quantity;
        expect_is_direct_evaluation(material, options);
      }
    }
  }
}

TEST_P(SliceOfModel, AtStoredAnglesEqualsDirectEvaluationThere) {
  testing_support::Random random(2);
  for (const Grid& grid : {Grid{}, Grid{7, 5, 4, CellAnchor::kLowerEdge},
                           Grid{90, 20, 36, CellAnchor::kCentre}, Grid{1, 1, 1, CellAnchor::kCentre}}) {
    for (const ThetaHAxis axis : {ThetaHAxis::kLinear, ThetaHAxis::kSquareRoot}) {
      Material material = random_material(GetParam(), effects_of(GetParam()), random);
      material.options() = random_options(random);
      SliceOptions options;
      options.size = 45;
      options.phi_d_deg = 30.0;
      options.axis = axis;
      options.sampling = SliceSampling::kStored;
      options.grid = grid;
      expect_is_direct_evaluation(material, options);
    }
  }
}

// More columns than go through vector code at a time, and not a multiple of it.
TEST_P(SliceOfModel, EqualsDirectEvaluationInWideRows) {
  testing_support::Random random(3);
  const Material material = random_material(GetParam(), effects_of(GetParam()), random);
  SliceOptions options;
  options.size = 1111;
  options.phi_d_deg = 60.0;
  const Image image = draw_slice(material, options);
  for (int x = 0; x < options.size; ++x) {
    for (const int y : {0, 700, options.size - 1}) {
      const DirectionPair pair = directions_from_half_diff(slice_angles(options, x, y));
      if (!is_above_horizon(pair)) continue;
      expect_value(pixel_of(image, x, y), eval(material, pair.wi, pair.wo), 1e-6);
    }
  }
}

// Proxima and correlated masking grow without limit towards the horizon.
TEST_P(SliceOfModel, IsFiniteUpToTheHorizon) {
  testing_support::Random random(4);
  for (int k = 0; k < 20; ++k) {
    Material material = random_material(GetParam(), effects_of(GetParam()), random);
    material.options() = {Masking::kCorrelated, BurleyG::k2017, Diffuse::kProxima};
    material.set("roughness", k % 2 == 0 ? 0.01 : 1.0);
    SliceOptions options;
    options.size = 256;
    options.axis = ThetaHAxis::kSquareRoot;
    options.phi_d_deg = k % 3 == 0 ? 0.0 : 90.0 + 0.001 * k;
    const Image image = draw_slice(material, options);
    EXPECT_TRUE(std::ranges::all_of(
        image.rgb, [](float f) { return f >= 0.0F && f <= std::numeric_limits<float>::max(); }));
    EXPECT_EQ(image.counts()[static_cast<std::size_t>(PixelState::kNotFinite)], 0U);
  }
}

TEST(SliceAngles, AreThoseOfPixelCentresFromTheBottomLeft) {
  SliceOptions options;
  options.size = 90;
  options.phi_d_deg = 120.0;
  for (int k = 0; k < 90; ++k) {
    const HalfDiff angles = slice_angles(options, k, 89 - k);
    EXPECT_NEAR(angles.theta_h_rad, (k + 0.5) * kDegree, 1e-15);
    EXPECT_NEAR(angles.theta_d_rad, (k + 0.5) * kDegree, 1e-15);
    EXPECT_NEAR(angles.phi_d_rad, 120.0 * kDegree, 1e-15);
  }
}

TEST(SliceAngles, OnTheSquareRootAxisGrowAsTheSquare) {
  SliceOptions options;
  options.size = 30;
  options.axis = ThetaHAxis::kSquareRoot;
  for (int x = 0; x < 30; ++x) {
    EXPECT_NEAR(std::sqrt(slice_angles(options, x, 3).theta_h_rad / (90.0 * kDegree)), (x + 0.5) / 30, 1e-15);
  }
}

// The column of a stored row begins and ends at the same places of both axes.
TEST(SliceAngles, AtStoredCellsContainThePixelsCentre) {
  for (const Grid& grid : {Grid{}, Grid{13, 7, 9, CellAnchor::kLowerEdge}}) {
    for (const ThetaHAxis axis : {ThetaHAxis::kLinear, ThetaHAxis::kSquareRoot}) {
      SliceOptions smooth;
      smooth.size = 64;
      smooth.axis = axis;
      smooth.phi_d_deg = 77.0;
      SliceOptions stored = smooth;
      stored.sampling = SliceSampling::kStored;
      stored.grid = grid;
      for_each_pixel(smooth.size, [&](int x, int y) {
        EXPECT_EQ(cell_of(grid, slice_angles(stored, x, y)), cell_of(grid, slice_angles(smooth, x, y)));
      });
    }
  }
}

TEST(SliceAngles, FoldPhiDIntoOneTurn) {
  SliceOptions options;
  for (const double phi_d : {0.0, 45.0, 270.0, 359.5}) {
    for (const double turn : {-720.0, -360.0, 360.0}) {
      options.phi_d_deg = phi_d + turn;
      EXPECT_NEAR(slice_angles(options, 1, 1).phi_d_rad, phi_d * kDegree, 1e-12);
    }
  }
  options.phi_d_deg = -1e-300;
  EXPECT_EQ(slice_angles(options, 1, 1).phi_d_rad, 0.0);
}

TEST(DrawSlice, FoldsPhiD) {
  testing_support::Random random(5);
  const Material material = random_material(Model::kCallisto, effects_of(Model::kCallisto), random);
  const MeasuredTable table = testing_support::table_of(material);
  SliceOptions options;
  options.size = 40;
  options.phi_d_deg = 75.0;
  SliceOptions turned = options;
  turned.phi_d_deg += 360.0;
  EXPECT_EQ(draw_slice(material, turned).rgb, draw_slice(material, options).rgb);
  // Tables hold half a turn.
  turned.phi_d_deg += 180.0;
  for (const SliceSampling sampling : {SliceSampling::kSmooth, SliceSampling::kStored}) {
    options.sampling = turned.sampling = sampling;
    const Image one = draw_slice(table, options);
    const Image other = draw_slice(table, turned);
    EXPECT_EQ(one.state, other.state);
    for (std::size_t k = 0; k < one.rgb.size(); ++k) {
      EXPECT_NEAR(one.rgb[k], other.rgb[k], 1e-6 * one.rgb[k]);
    }
  }
}

// Values without any pattern, and every kind of invalid cell.
class DrawSliceOfTable : public testing::Test {
 protected:
  // Invalid cells at phi_d = 90 deg, by their theta_h and theta_d.
  static constexpr std::pair<int, int> kUnmeasured = {40, 20};
  static constexpr std::pair<int, int> kNegative = {50, 30};
  static constexpr std::pair<int, int> kNaN = {60, 40};
  static constexpr std::pair<int, int> kInfinite = {70, 50};

  DrawSliceOfTable() : table_(Grid{}, planes()) {}

  static std::vector<float> planes() {
    const Grid grid;
    const std::size_t cells = grid.cell_count();
    std::vector<float> planes(3 * cells);
    std::uint32_t state = 1;
    for (float& value : planes) {
      state = state * 1664525U + 1013904223U;
      value = static_cast<float>(state >> 8) / 16777216.0F;
    }
    const auto spoil = [&](std::pair<int, int> at, const std::array<float, 3>& f) {
      for (std::size_t c = 0; c < 3; ++c) planes[c * cells + grid.index(at.first, at.second, 90)] = f[c];
    };
    spoil(kUnmeasured, {-1.0F, -1.0F, -1.0F});
    spoil(kNegative, {0.5F, -0.25F, 0.5F});
    spoil(kNaN, {0.5F, std::numeric_limits<float>::quiet_NaN(), 0.5F});
    spoil(kInfinite, {std::numeric_limits<float>::infinity(), 0.5F, 0.5F});
    return planes;
  }

  static PixelState expected_state(int i_theta_h, int i_theta_d) {
    const std::pair<int, int> at = {i_theta_h, i_theta_d};
    if (at == kUnmeasured) return PixelState::kUnmeasured;
    if (at == kNegative) return PixelState::kNegative;
    return at == kNaN || at == kInfinite ? PixelState::kNotFinite : PixelState::kValue;
  }

  MeasuredTable table_;
};

TEST_F(DrawSliceOfTable, AtStoredAnglesShowsTheCellsOfTheSliceMeasures) {
  SliceOptions options;
  options.size = 90;
  options.sampling = SliceSampling::kStored;
  const Image image = draw_slice(table_, options);
  for (const SlicePixel& expected : make_slice(table_).pixels) {
    const Pixel pixel = pixel_of(image, expected.column, 89 - expected.row);
    const PixelState state = expected_state(expected.i_theta_h, expected.i_theta_d);
    ASSERT_EQ(pixel.state, state);
    EXPECT_EQ(expected.valid, state == PixelState::kValue);
    EXPECT_EQ(pixel.value, expected.valid ? table_.value(expected.cell) : (Rgb{0.0, 0.0, 0.0}));
  }
}

// However close the valid neighbours are.
TEST_F(DrawSliceOfTable, ShowsInvalidCellsWithTheirStateAndCountsThem) {
  for (const SliceSampling sampling : {SliceSampling::kSmooth, SliceSampling::kStored}) {
    for (const ThetaHAxis axis : {ThetaHAxis::kLinear, ThetaHAxis::kSquareRoot}) {
      SliceOptions options;
      options.size = 360;
      options.axis = axis;
      options.sampling = sampling;
      const Image image = draw_slice(table_, options);
      std::array<std::size_t, kPixelStateCount> expected{};
      SliceOptions stored = options;
      stored.sampling = SliceSampling::kStored;
      for_each_pixel(options.size, [&](int x, int y) {
        const std::size_t cell = cell_of(table_.grid(), slice_angles(stored, x, y));
        const auto row = cell / 180;
        const PixelState state = expected_state(static_cast<int>(row / 90), static_cast<int>(row % 90));
        ++expected[static_cast<std::size_t>(state)];
        ASSERT_EQ(pixel_of(image, x, y).state, state);
        if (state != PixelState::kValue) expect_no_value(pixel_of(image, x, y), state);
      });
      EXPECT_EQ(image.counts(), expected);
      EXPECT_GT(expected[static_cast<std::size_t>(PixelState::kUnmeasured)], 0U);
      EXPECT_GT(expected[static_cast<std::size_t>(PixelState::kNegative)], 0U);
      EXPECT_GT(expected[static_cast<std::size_t>(PixelState::kNotFinite)], 0U);
    }
  }
}

TEST_F(DrawSliceOfTable, SmoothIsInterpolation) {
  for (const double phi_d : {0.0, 33.3, 90.0, 179.9}) {
    for (const ThetaHAxis axis : {ThetaHAxis::kLinear, ThetaHAxis::kSquareRoot}) {
      for (const Quantity quantity : {Quantity::kF, Quantity::kFCos}) {
        SliceOptions options;
        options.size = 77;
        options.phi_d_deg = phi_d;
        options.axis = axis;
        options.quantity = quantity;
        const Image image = draw_slice(table_, options);
        for_each_pixel(options.size, [&](int x, int y) {
          const HalfDiff angles = slice_angles(options, x, y);
          const DirectionPair pair = directions_from_half_diff(angles);
          const Pixel pixel = pixel_of(image, x, y);
          if (!is_above_horizon(pair)) return expect_no_value(pixel, PixelState::kBelowHorizon);
          const std::size_t cell = cell_of(table_.grid(), angles);
          if (!table_.is_valid(cell)) return expect_no_value(pixel, pixel_state_of(table_.state(cell)));
          Rgb expected = table_.interpolate(angles).value();
          if (quantity == Quantity::kFCos) {
            for (double& f : expected) f *= pair.wi.z;
          }
          expect_value(pixel, expected, 1e-6);
        });
      }
    }
  }
}

TEST_F(DrawSliceOfTable, TakesFCosAtTheAnglesOfTheValue) {
  SliceOptions options;
  options.size = 50;
  options.phi_d_deg = 45.0;
  options.sampling = SliceSampling::kStored;
  const Image f = draw_slice(table_, options);
  options.quantity = Quantity::kFCos;
  const Image f_cos = draw_slice(table_, options);
  EXPECT_EQ(f.state, f_cos.state);
  for_each_pixel(options.size, [&](int x, int y) {
    const Pixel pixel = pixel_of(f, x, y);
    if (pixel.state != PixelState::kValue) return;
    const double cos_i = directions_from_half_diff(slice_angles(options, x, y)).wi.z;
    expect_value(pixel_of(f_cos, x, y),
                 {pixel.value[0] * cos_i, pixel.value[1] * cos_i, pixel.value[2] * cos_i}, 1e-6);
  });
}

// A table as MERL's: measured wherever both directions are above the horizon.
TEST(DrawSlice, ShowsTableAndMaterialWithTheSameHorizon) {
  const Material material = testing_support::random_full_material(Model::kBurley, {}, 6);
  const MeasuredTable table = testing_support::table_of(material, Grid{});
  for (const double phi_d : {0.0, 30.0, 90.0, 150.0}) {
    SliceOptions options;
    options.size = 180;
    options.phi_d_deg = phi_d;
    options.sampling = SliceSampling::kStored;
    EXPECT_EQ(draw_slice(table, options).state, draw_slice(material, options).state) << phi_d;
  }
}

// The measure, computed from the two pictures.
TEST(DrawSlice, AtStoredAnglesHoldsWhatTheSliceMeasureCompares) {
  const Effects effects = effects_of(Model::kCallisto).without(Effect::kSmoothTerminator);
  const MeasuredTable table =
      testing_support::table_of(testing_support::random_full_material(Model::kCallisto, effects, 7), Grid{});
  const Material material = testing_support::random_full_material(Model::kLambertGgx, {}, 8);
  SliceOptions options;
  options.size = 90;
  options.sampling = SliceSampling::kStored;
  const Image model = draw_slice(material, options);
  const Image reference = draw_slice(table, options);
  double sum = 0.0;
  double count = 0.0;
  for (int y = 10; y < 90; ++y) {
    for (int x = 0; x < 80; ++x) {
      const Pixel a = pixel_of(model, x, y);
      const Pixel b = pixel_of(reference, x, y);
      if (a.state != PixelState::kValue || b.state != PixelState::kValue) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        sum += std::pow(std::min(a.value[c], 1.0) - std::min(b.value[c], 1.0), 2);
        count += 1.0;
      }
    }
  }
  const double expected = fit::evaluate(material, table).slice.slice_pct;
  EXPECT_GT(expected, 0.1);
  EXPECT_NEAR(100.0 * std::sqrt(sum / count), expected, 1e-5 * expected);
}

// Places as in the talk: phi_d = 90 deg.
class Peaks : public testing::Test {
 protected:
  static double green(const Image& image, int x, int y) { return pixel_of(image, x, y).value[1]; }
  // Without any specular reflection.
  static Material dull(Effect effect) {
    Material material(Model::kCallisto);
    material.set_effects(Effects().with(Effect::kSpecularFresnelFalloff).with(effect));
    material.set("specular", 0.0);
    material.set("specular_fresnel_falloff", 0.0);
    return material;
  }
};

TEST_F(Peaks, SpecularIsOnTheLeft) {
  Material material(Model::kLambertGgx);
  material.set("roughness", 0.3);
  const Image image = draw_slice(material, {});
  for (int y = 0; y < 512; y += 16) {
    EXPECT_GT(green(image, 0, y), 4.0 * green(image, 256, y));
    for (int x = 1; x < 200; ++x) EXPECT_LE(green(image, x, y), green(image, x - 1, y));
  }
}

TEST_F(Peaks, FresnelIsAtTheTop) {
  Material material(Model::kLambertGgx);
  material.set("base_color", 0.0);
  material.set("roughness", 0.5);
  const Image image = draw_slice(material, {});
  for (int x = 0; x < 400; x += 16) {
    for (int y = 1; y < 200; ++y) EXPECT_LT(green(image, x, y), green(image, x, y - 1));
    EXPECT_GT(green(image, x, 0), 4.0 * green(image, x, 256));
  }
}

TEST_F(Peaks, RetroreflectionIsOnTheRightAtTheBottom) {
  Material material = dull(Effect::kRetroreflection);
  material.set("retroreflection", 5.0);
  const Image image = draw_slice(material, {});
  EXPECT_GT(green(image, 500, 500), 3.0 * green(image, 10, 500));
  EXPECT_GT(green(image, 500, 500), 2.0 * green(image, 500, 10));
}

TEST_F(Peaks, DiffuseFresnelIsAtTheTopOnTheLeft) {
  Material material = dull(Effect::kDiffuseFresnel);
  material.set("diffuse_fresnel", 5.0);
  const Image image = draw_slice(material, {});
  EXPECT_GT(green(image, 10, 10), 3.0 * green(image, 10, 500));
  EXPECT_GT(green(image, 10, 10), 2.0 * green(image, 500, 10));
}

TEST(DrawSlice, DoesNotDependOnTheNumberOfThreads) {
  testing_support::Random random(9);
  const Material material = random_material(Model::kCallisto, effects_of(Model::kCallisto), random);
  const MeasuredTable table = testing_support::table_of(material);
  for (const SliceSampling sampling : {SliceSampling::kSmooth, SliceSampling::kStored}) {
    SliceOptions options;
    options.size = 200;
    options.sampling = sampling;
    for (const Subject& subject : {Subject(material), Subject(table)}) {
      const Image parallel = draw_slice(subject, options);
      const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
      const Image alone = draw_slice(subject, options);
      EXPECT_EQ(parallel.rgb, alone.rgb);
      EXPECT_EQ(parallel.state, alone.state);
    }
  }
}

TEST(DrawSlice, OfOnePixelShowsTheMiddle) {
  SliceOptions options;
  options.size = 1;
  expect_is_direct_evaluation(Material(Model::kBurley), options);
  EXPECT_NEAR(slice_angles(options, 0, 0).theta_h_rad, 45.0 * kDegree, 1e-15);
}

TEST(DrawSlice, RefusesOptionsThatAreNotValid) {
  const Material material;
  const auto expect_refused = [&](const SliceOptions& options, const std::string& reason) {
    std::string why;
    EXPECT_FALSE(options.is_valid(&why));
    EXPECT_THAT(why, testing::HasSubstr(reason));
    EXPECT_FALSE(options.is_valid(nullptr));
    EXPECT_THROW(draw_slice(material, options), std::invalid_argument);
  };
  SliceOptions options;
  EXPECT_TRUE(options.is_valid(nullptr));
  for (const int size : {-1, 0, 16385}) {
    options.size = size;
    expect_refused(options, "size is " + std::to_string(size));
  }
  options = {};
  for (const double phi_d : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    options.phi_d_deg = phi_d;
    expect_refused(options, "phi_d");
  }
  options = {};
  options.grid.n_theta_d = 0;
  expect_refused(options, "grid");
}

TEST(DrawSlice, RefusesATableWithoutValues) {
  EXPECT_THROW(draw_slice(MeasuredTable(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::render
