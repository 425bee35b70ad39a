// Colour differences of spheres: the colour space, and the fast judge against the definition.
#include "render/delta_e.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <vector>

#include "render/sphere.h"
#include "tests/fit_data.h"
#include "tests/random_parameters.h"

namespace brdfit::render {
namespace {

using Matrix = std::array<Rgb, 3>;

Rgb times(const Matrix& m, const Rgb& v) {
  Rgb result{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) result[i] += m[i][k] * v[k];
  }
  return result;
}

Matrix inverse(const Matrix& m) {
  Matrix result;
  const auto minor = [&](std::size_t i, std::size_t k) {
    return m[(i + 1) % 3][(k + 1) % 3] * m[(i + 2) % 3][(k + 2) % 3] -
           m[(i + 1) % 3][(k + 2) % 3] * m[(i + 2) % 3][(k + 1) % 3];
  };
  const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) result[k][i] = minor(i, k) / determinant;
  }
  return result;
}

// RGB to XYZ from chromaticities of the primaries and white D65.
Matrix xyz_from_rgb(const std::array<std::array<double, 2>, 3>& primaries) {
  const auto xyz = [](double x, double y) { return Rgb{x / y, 1.0, (1.0 - x - y) / y}; };
  Matrix columns;
  for (std::size_t k = 0; k < 3; ++k) {
    const Rgb primary = xyz(primaries[k][0], primaries[k][1]);
    for (std::size_t i = 0; i < 3; ++i) columns[i][k] = primary[i];
  }
  const Rgb scale = times(inverse(columns), xyz(0.3127, 0.3290));
  for (auto& row : columns) {
    for (std::size_t k = 0; k < 3; ++k) row[k] *= scale[k];
  }
  return columns;
}

// BT.2100 and BT.2124 to the letter.
Rgb expected_itp(const Rgb& rec709) {
  const Matrix from_709 = xyz_from_rgb({{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}});
  const Matrix from_2020 = xyz_from_rgb({{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}}});
  const Rgb rgb = times(inverse(from_2020), times(from_709, rec709));
  Rgb lms = {(1688 * rgb[0] + 2146 * rgb[1] + 262 * rgb[2]) / 4096,
             (683 * rgb[0] + 2951 * rgb[1] + 462 * rgb[2]) / 4096,
             (99 * rgb[0] + 309 * rgb[1] + 3688 * rgb[2]) / 4096};
  for (double& x : lms) {
    const double y = std::pow(x * 100.0 / 10000.0, 2610.0 / 16384);
    x = std::pow((3424.0 / 4096 + 2413.0 / 128 * y) / (1 + 2392.0 / 128 * y), 2523.0 / 32);
  }
  return {0.5 * lms[0] + 0.5 * lms[1], 0.5 * (6610 * lms[0] - 13613 * lms[1] + 7003 * lms[2]) / 4096,
          (17933 * lms[0] - 17390 * lms[1] - 543 * lms[2]) / 4096};
}

TEST(Itp, OfGreysIsThePqCurveAlone) {
  // 100 and 10000 cd/m2 (SMPTE ST 2084), and black.
  EXPECT_NEAR(itp_from_linear({1.0, 1.0, 1.0})[0], 0.508078, 1e-6);
  EXPECT_NEAR(itp_from_linear({100.0, 100.0, 100.0})[0], 1.0, 1e-12);
  EXPECT_NEAR(itp_from_linear({0.0, 0.0, 0.0})[0], std::pow(3424.0 / 4096, 2523.0 / 32), 1e-6);
  for (const double grey : {0.0, 1e-6, 0.01, 0.18, 1.0, 50.0, 1e4}) {
    const Rgb itp = itp_from_linear({grey, grey, grey});
    EXPECT_NEAR(itp[1], 0.0, 1e-12) << grey;
    EXPECT_NEAR(itp[2], 0.0, 1e-12) << grey;
  }
}

TEST(Itp, OfColoursIsTheRecommendationsFormulaWithMatricesFromPrimaries) {
  testing_support::Random random(1);
  std::vector<Rgb> colours = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}};
  for (int k = 0; k < 200; ++k) {
    Rgb colour;
    for (double& channel : colour) channel = std::pow(10.0, testing_support::uniform(random, -5.0, 2.5));
    colours.push_back(colour);
  }
  for (const Rgb& colour : colours) {
    const Rgb itp = itp_from_linear(colour);
    const Rgb expected = expected_itp(colour);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(itp[c], expected[c], 1e-7);
  }
}

TEST(Itp, IsFiniteForColoursThatNoDisplayShows) {
  for (const Rgb& colour : {Rgb{1e30, 0.0, 0.0}, Rgb{0.0, 1e-300, 0.0}, Rgb{-1e-9, 0.0, 1.0}}) {
    for (const double channel : itp_from_linear(colour)) EXPECT_TRUE(std::isfinite(channel));
  }
}

TEST(DeltaE, Is720TimesTheDistance) {
  EXPECT_DOUBLE_EQ(delta_e_itp({0.5, 0.1, 0.2}, {0.5, 0.1, 0.2}), 0.0);
  EXPECT_NEAR(delta_e_itp({0.5, 0.1, 0.2}, {0.53, 0.1, 0.24}), 720.0 * 0.05, 1e-10);
}

// The mean difference over all pixels that both spheres hold, pixel by pixel.
SphereDeltaE by_definition(const Subject& a, const Subject& b, int size) {
  SphereDeltaE result;
  double total = 0.0;
  for (std::size_t light = 0; light < kLightAnglesDeg.size(); ++light) {
    const Image image_a = draw_lit(a, Shape::kSphere, kLightAnglesDeg[light], size);
    const Image image_b = draw_lit(b, Shape::kSphere, kLightAnglesDeg[light], size);
    double sum = 0.0;
    std::size_t pixels = 0;
    for (std::size_t k = 0; k < image_a.pixel_count(); ++k) {
      if (image_a.state[k] == PixelState::kOutside) continue;
      if (image_a.state[k] != PixelState::kValue || image_b.state[k] != PixelState::kValue) {
        ++result.skipped;
        continue;
      }
      const auto colour = [&](const Image& image) {
        return itp_from_linear({image.rgb[3 * k], image.rgb[3 * k + 1], image.rgb[3 * k + 2]});
      };
      sum += delta_e_itp(colour(image_a), colour(image_b));
      ++pixels;
    }
    result.by_light[light] = sum / static_cast<double>(pixels);
    result.pixels += pixels;
    total += sum;
  }
  result.mean = total / static_cast<double>(result.pixels);
  return result;
}

void expect_close(const SphereDeltaE& fast, const SphereDeltaE& expected) {
  EXPECT_GT(expected.mean, 0.5);
  EXPECT_NEAR(fast.mean, expected.mean, 1e-5 * expected.mean);
  for (std::size_t light = 0; light < 4; ++light) {
    EXPECT_NEAR(fast.by_light[light], expected.by_light[light], 1e-5 * expected.mean) << light;
  }
  EXPECT_EQ(fast.pixels, expected.pixels);
  EXPECT_EQ(fast.skipped, expected.skipped);
}

Material random_material(Model model, std::uint64_t seed) {
  return testing_support::random_full_material(model, effects_of(model), seed);
}

// A table whose values differ between phi_d and pi - phi_d, with cells of every kind.
MeasuredTable lopsided_table(std::uint64_t seed, bool with_holes) {
  const Grid grid = {20, 24, 30, CellAnchor::kLowerEdge};
  testing_support::Random random(seed);
  std::vector<float> planes(3 * grid.cell_count());
  for (float& value : planes) value = static_cast<float>(testing_support::uniform(random, 0.05, 0.6));
  for (std::size_t cell = 0; with_holes && cell < grid.cell_count(); ++cell) {
    // Two neighbouring theta_h rows of six, so that interpolation between them finds no corner.
    if (cell / (2 * 24 * 30) % 3 != 1) continue;
    for (std::size_t c = 0; c < 3; ++c) planes[cell + c * grid.cell_count()] = -1.0F;
  }
  return MeasuredTable(grid, std::move(planes));
}

TEST(SphereJudge, AgreesWithTheDefinitionForMaterials) {
  for (const int size : {64, 102}) {
    for (const Model model : all_models()) {
      const Material reference = random_material(Model::kCallisto, 5);
      const Material candidate = random_material(model, 6);
      expect_close(SphereJudge(reference, size)(candidate), by_definition(reference, candidate, size));
    }
  }
}

TEST(SphereJudge, AgreesWithTheDefinitionForTablesWhoseHalvesDiffer) {
  const Material material = random_material(Model::kCallisto, 5);
  for (const bool with_holes : {false, true}) {
    const MeasuredTable a = lopsided_table(1, with_holes);
    const MeasuredTable b = lopsided_table(2, false);
    expect_close(SphereJudge(a, 64)(material), by_definition(a, material, 64));
    expect_close(SphereJudge(material, 64)(a), by_definition(material, a, 64));
    expect_close(SphereJudge(a, 64)(b), by_definition(a, b, 64));
  }
}

TEST(SphereJudge, LeavesOutAndCountsWhatATableDoesNotHold) {
  const MeasuredTable holes = lopsided_table(1, true);
  const SphereDeltaE whole = SphereJudge(random_material(Model::kBurley, 1), 128)(lopsided_table(1, false));
  const SphereDeltaE with_holes = SphereJudge(random_material(Model::kBurley, 1), 128)(holes);
  EXPECT_EQ(whole.skipped, 0U);
  EXPECT_GT(with_holes.skipped, 100U);
  EXPECT_EQ(with_holes.skipped + with_holes.pixels, whole.pixels);
  // Nothing is held at all.
  const Grid grid = {4, 4, 4, CellAnchor::kLowerEdge};
  const MeasuredTable nothing(grid, std::vector<float>(3 * grid.cell_count(), -1.0F));
  const SphereDeltaE none = SphereJudge(nothing, 32)(holes);
  EXPECT_EQ(none.mean, 0.0);
  EXPECT_GT(none.pixels, 0U);  // in shadow
  EXPECT_EQ(none.by_light[0], 0.0);
}

TEST(SphereJudge, IsZeroForTheSameAndSymmetric) {
  const Material a = random_material(Model::kCallisto, 3);
  const Material b = random_material(Model::kBurley, 4);
  const MeasuredTable table = lopsided_table(7, true);
  EXPECT_EQ(SphereJudge(a)(a).mean, 0.0);
  EXPECT_EQ(SphereJudge(table)(table).mean, 0.0);
  EXPECT_EQ(SphereJudge(a)(b).mean, SphereJudge(b)(a).mean);
  EXPECT_EQ(SphereJudge(a)(table).mean, SphereJudge(table)(a).mean);
}

TEST(SphereJudge, GrowsWithTheError) {
  Material reference(Model::kLambertGgx);
  const SphereJudge judge(reference, 64);
  double before = 0.0;
  for (const double albedo : {0.19, 0.22, 0.3, 0.6}) {
    Material candidate = reference;
    candidate.set("base_color", albedo);
    const double now = judge(candidate).mean;
    EXPECT_GT(now, before);
    before = now;
  }
}

TEST(SphereJudge, FindsAFineTableOfAMaterialLikeTheMaterial) {
  // Not one with a discontinuity at the horizon; reciprocal, as a table folds both orders into one cell.
  Material material(Model::kLambertGgx);
  material.set("roughness", 0.4);
  material.set("base_color", Rgb{0.3, 0.1, 0.05});
  const SphereJudge judge(material);
  const SphereDeltaE coarse =
      judge(testing_support::table_of(material, {30, 30, 60, CellAnchor::kLowerEdge}));
  const SphereDeltaE fine = judge(testing_support::table_of(material, {90, 90, 180, CellAnchor::kLowerEdge}));
  EXPECT_LT(fine.mean, 0.2);
  EXPECT_LT(fine.mean, 0.5 * coarse.mean);
  EXPECT_EQ(fine.skipped, 0U);
}

TEST(SphereJudge, DoesNotDependOnThreads) {
  const MeasuredTable table = lopsided_table(3, true);
  const Material material = random_material(Model::kCallisto, 8);
  const SphereDeltaE many = SphereJudge(table)(material);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const SphereDeltaE one = SphereJudge(table)(material);
  EXPECT_EQ(one.mean, many.mean);
  EXPECT_EQ(one.by_light, many.by_light);
}

TEST(SphereJudge, RefusesOddSizes) {
  const Material material;
  EXPECT_THROW(SphereJudge(material, 63), std::invalid_argument);
  EXPECT_THROW(SphereJudge(material, 0), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit::render
