// Synthetic tables: exact values, reproducible noise of the stated size, holes where the recipe puts them.
#include "data/synthetic/generate.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numbers>
#include <string>

#include "brdf/models.h"
#include "data/synthetic/holes.h"
#include "data/synthetic/random_material.h"
#include "io/merl.h"

namespace brdfit::synthetic {
namespace {

// A small table of a material that is not reciprocal and uses every effect of Callisto.
Recipe small_recipe() {
  Recipe recipe;
  recipe.name = "small";
  recipe.material = random_material(Model::kCallisto, Tier::kFull, effects_of(Model::kCallisto), {}, 7);
  recipe.material.set("smooth_terminator", 0.8);
  recipe.grid = {12, 14, 26, CellAnchor::kLowerEdge};
  recipe.seed = 11;
  return recipe;
}

// Enough cells for statistics, of a material that is nowhere dark.
Recipe bright_recipe() {
  Recipe recipe;
  recipe.name = "bright";
  recipe.material.set("base_color", Rgb{0.9, 0.8, 0.7});
  recipe.material.set("roughness", 0.8);
  recipe.grid = {30, 30, 60, CellAnchor::kCentre};
  recipe.seed = 5;
  return recipe;
}

using CellVisitor = std::function<void(std::size_t cell, int h, int d, int p, const DirectionPair& pair)>;

void for_each_cell(const Grid& grid, const CellVisitor& visit) {
  for (int h = 0; h < grid.n_theta_h; ++h) {
    for (int d = 0; d < grid.n_theta_d; ++d) {
      for (int p = 0; p < grid.n_phi_d; ++p) {
        visit(grid.index(h, d, p), h, d, p, directions_from_half_diff(grid.angles(h, d, p)));
      }
    }
  }
}

bool is_measured(const Rgb& value) {
  return value[0] >= 0.0 && value[1] >= 0.0 && value[2] >= 0.0;
}

// Running mean, deviation and correlation of pairs of numbers.
struct Moments {
  double n = 0.0;
  double sum_x = 0.0;
  double sum_y = 0.0;
  double sum_xx = 0.0;
  double sum_yy = 0.0;
  double sum_xy = 0.0;
  void add(double x, double y) {
    n += 1.0;
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_yy += y * y;
    sum_xy += x * y;
  }
  double mean_x() const { return sum_x / n; }
  double sigma_x() const { return std::sqrt(sum_xx / n - mean_x() * mean_x()); }
  double sigma_y() const { return std::sqrt(sum_yy / n - sum_y / n * (sum_y / n)); }
  double correlation() const { return (sum_xy / n - mean_x() * sum_y / n) / (sigma_x() * sigma_y()); }
};

// Mean, sigma and independence of residuals that should be normal with the given sigma. The tolerances are
// five standard errors of each statistic: about one run in a million would fail by chance, and the seed is
// fixed.
void expect_normal(const Moments& m, double sigma) {
  ASSERT_GT(m.n, 10000.0);
  EXPECT_NEAR(m.mean_x(), 0.0, 5.0 * sigma / std::sqrt(m.n));
  EXPECT_NEAR(m.sigma_x(), sigma, 5.0 * sigma / std::sqrt(2.0 * m.n));
  EXPECT_NEAR(m.correlation(), 0.0, 5.0 / std::sqrt(m.n));
}

// A folder that goes when the test ends.
class SyntheticFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("brdfit_") + info->test_suite_name() + "_" + info->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  std::filesystem::path folder_;
};

class SyntheticAnchor : public ::testing::TestWithParam<CellAnchor> {};

TEST_P(SyntheticAnchor, ExactCellIsTheMeanOfBothWaysRoundAtItsOwnAngles) {
  Recipe recipe = small_recipe();
  recipe.grid.anchor = GetParam();
  const std::vector<Rgb> values = generate_values(recipe);
  double largest_gap = 0.0;
  for_each_cell(recipe.grid, [&](std::size_t cell, int h, int d, int p, const DirectionPair& pair) {
    if (pair.wi.z <= 1e-9 || pair.wo.z <= 1e-9) return;
    const Rgb forth = eval(recipe.material, pair.wi, pair.wo);
    const Rgb back = eval(recipe.material, pair.wo, pair.wi);
    for (std::size_t c = 0; c < 3; ++c) {
      const double mean = 0.5 * (forth[c] + back[c]);
      EXPECT_NEAR(values[cell][c], mean, 1e-12 * mean) << h << " " << d << " " << p;
      largest_gap = std::max(largest_gap, std::abs(forth[c] - back[c]) / mean);
    }
  });
  EXPECT_GT(largest_gap, 0.1) << "the material must tell the mean from one way round";
}

INSTANTIATE_TEST_SUITE_P(Anchors, SyntheticAnchor,
                         ::testing::Values(CellAnchor::kLowerEdge, CellAnchor::kCentre));

TEST(Synthetic, CellsAtOrBelowTheHorizonAndOnlyThoseAreNotMeasured) {
  const Recipe recipe = small_recipe();
  GenerateReport report;
  const std::vector<Rgb> values = generate_values(recipe, &report);
  std::size_t above = 0;
  for_each_cell(recipe.grid, [&](std::size_t cell, int h, int d, int p, const DirectionPair& pair) {
    if (pair.wi.z > 1e-9 && pair.wo.z > 1e-9) {
      ++above;
      EXPECT_TRUE(is_measured(values[cell])) << h << " " << d << " " << p;
    } else {
      EXPECT_EQ(values[cell], (Rgb{-1.0, -1.0, -1.0})) << h << " " << d << " " << p;
    }
  });
  EXPECT_EQ(report, (GenerateReport{recipe.grid.cell_count(), above, 0, 0, recipe.seed}));
}

TEST(Synthetic, TableInMemoryHoldsTheValuesAsFloats) {
  Recipe recipe = small_recipe();
  recipe.invalid.fraction = 0.2;
  GenerateReport report;
  const MeasuredTable table = generate_table(recipe, &report);
  const std::vector<Rgb> values = generate_values(recipe);
  EXPECT_EQ(table.grid(), recipe.grid);
  EXPECT_EQ(table.valid_count(), report.valid);
  for (std::size_t cell = 0; cell < values.size(); ++cell) {
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(table.plane(static_cast<int>(c))[cell], static_cast<float>(values[cell][c])) << cell;
    }
  }
}

Recipe noisy_recipe_with_holes() {
  Recipe recipe = small_recipe();
  recipe.noise = {0.1, 0.01};
  recipe.invalid = {0.1, 3, 4, 80.0};
  return recipe;
}

TEST(Synthetic, ThreadsDoNotMatter) {
  const Recipe recipe = noisy_recipe_with_holes();
  const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
  const auto with_threads = [&](int threads) {
    tbb::task_arena arena(threads);
    GenerateReport report;
    std::vector<Rgb> values = arena.execute([&] { return generate_values(recipe, &report); });
    return std::pair(std::move(values), report);
  };
  const auto one = with_threads(1);
  for (int repeat = 0; repeat < 5; ++repeat) EXPECT_EQ(with_threads(4), one);
}

TEST(Synthetic, OtherSeedOtherNoise) {
  for (const Noise noise : {Noise{0.1, 0.0}, Noise{0.0, 0.01}}) {
    Recipe recipe = small_recipe();
    recipe.noise = noise;
    const std::vector<Rgb> values = generate_values(recipe);
    recipe.seed += 1;
    GenerateReport report;
    const std::vector<Rgb> others = generate_values(recipe, &report);
    EXPECT_EQ(report.seed, recipe.seed);
    for (std::size_t cell = 0; cell < values.size(); ++cell) {
      if (!is_measured(values[cell]) || values[cell][0] == 0.0) continue;
      EXPECT_NE(values[cell][0], others[cell][0]) << cell;
    }
  }
}

TEST(Synthetic, OtherSeedOtherHoles) {
  for (const Invalid invalid : {Invalid{0.1, 0, 4, 90.0}, Invalid{0.0, 3, 4, 90.0}}) {
    Recipe recipe = small_recipe();
    recipe.invalid = invalid;
    const std::vector<Rgb> values = generate_values(recipe);
    recipe.seed += 1;
    const std::vector<Rgb> others = generate_values(recipe);
    std::size_t differences = 0;
    for (std::size_t cell = 0; cell < values.size(); ++cell) {
      differences += is_measured(values[cell]) != is_measured(others[cell]) ? 1 : 0;
    }
    EXPECT_GT(differences, 0U) << invalid.fraction << " " << invalid.blocks;
  }
}

TEST(Synthetic, MultiplicativeNoiseHasTheStatedSigmaAndAnUnbiasedLog) {
  Recipe recipe = bright_recipe();
  const std::vector<Rgb> exact = generate_values(recipe);
  recipe.noise.multiplicative = 0.2;
  GenerateReport report;
  const std::vector<Rgb> noisy = generate_values(recipe, &report);
  Moments red_green;
  Moments blue_and_next;
  for (std::size_t cell = 0; cell + 1 < exact.size(); ++cell) {
    if (!is_measured(exact[cell]) || !is_measured(exact[cell + 1])) continue;
    const auto log_ratio = [&](std::size_t k, std::size_t c) { return std::log(noisy[k][c] / exact[k][c]); };
    red_green.add(log_ratio(cell, 0), log_ratio(cell, 1));
    blue_and_next.add(log_ratio(cell, 2), log_ratio(cell + 1, 2));
  }
  expect_normal(red_green, 0.2);
  expect_normal(blue_and_next, 0.2);
  EXPECT_EQ(report.floored_at_zero, 0U);
}

TEST(Synthetic, AdditiveNoiseHasTheStatedSigmaAndAnUnbiasedMean) {
  Recipe recipe = bright_recipe();
  const std::vector<Rgb> exact = generate_values(recipe);
  recipe.noise.additive = 0.01;
  GenerateReport report;
  const std::vector<Rgb> noisy = generate_values(recipe, &report);
  Moments red_blue;
  for (std::size_t cell = 0; cell < exact.size(); ++cell) {
    if (!is_measured(exact[cell])) continue;
    red_blue.add(noisy[cell][0] - exact[cell][0], noisy[cell][2] - exact[cell][2]);
  }
  expect_normal(red_blue, 0.01);
  EXPECT_EQ(report.floored_at_zero, 0U);
}

TEST(Synthetic, ValuesThatNoiseTakesBelowZeroAreStoredAsZeroAndCounted) {
  Recipe recipe = bright_recipe();
  GenerateReport exact_report;
  generate_values(recipe, &exact_report);
  recipe.noise.additive = 0.3;
  GenerateReport report;
  const std::vector<Rgb> values = generate_values(recipe, &report);
  std::size_t zeros = 0;
  std::size_t measured = 0;
  for (const Rgb& value : values) {
    if (!is_measured(value)) continue;
    ++measured;
    for (const double channel : value) zeros += channel == 0.0 ? 1 : 0;
  }
  EXPECT_EQ(measured, exact_report.valid) << "a floored cell stays measured";
  EXPECT_EQ(report.valid, exact_report.valid);
  EXPECT_EQ(report.floored_at_zero, zeros);
  // Values are at least 0.22 sr^-1, most of them below 0.3: between a tenth and a quarter of the noise is
  // below.
  EXPECT_GT(zeros, measured * 3 / 10);
  EXPECT_LT(zeros, measured * 3 / 4);
}

TEST(Synthetic, FractionOfOtherwiseValidCellsIsDropped) {
  Recipe recipe = bright_recipe();
  GenerateReport whole;
  generate_values(recipe, &whole);
  recipe.invalid.fraction = 0.3;
  GenerateReport report;
  generate_values(recipe, &report);
  EXPECT_EQ(report.valid + report.dropped, whole.valid);
  const auto n = static_cast<double>(whole.valid);
  EXPECT_NEAR(static_cast<double>(report.dropped), 0.3 * n, 5.0 * std::sqrt(n * 0.3 * 0.7));
}

TEST(Synthetic, HolesLeaveAllOtherCellsAsTheyAre) {
  Recipe recipe = small_recipe();
  recipe.noise = {0.1, 0.01};
  const std::vector<Rgb> whole = generate_values(recipe);
  recipe.invalid = {0.3, 2, 3, 85.0};
  const std::vector<Rgb> holed = generate_values(recipe);
  for (std::size_t cell = 0; cell < whole.size(); ++cell) {
    if (!is_measured(holed[cell])) continue;
    ASSERT_EQ(holed[cell], whole[cell]) << cell;
  }
}

TEST(Synthetic, BoxesAreTheOnlyHolesWhereNothingElseIsAsked) {
  Recipe recipe = small_recipe();
  recipe.invalid.blocks = 3;
  recipe.invalid.block_cells = 5;
  const std::vector<CellBox> boxes = hole_boxes(recipe);
  ASSERT_EQ(boxes.size(), 3U);
  GenerateReport report;
  const std::vector<Rgb> values = generate_values(recipe, &report);
  std::size_t dropped = 0;
  for_each_cell(recipe.grid, [&](std::size_t cell, int h, int d, int p, const DirectionPair& pair) {
    const bool in_box = std::ranges::any_of(boxes, [&](const CellBox& box) { return box.contains(h, d, p); });
    dropped += above_horizon(pair) && in_box ? 1 : 0;
    EXPECT_EQ(is_measured(values[cell]), above_horizon(pair) && !in_box) << h << " " << d << " " << p;
  });
  EXPECT_EQ(report.dropped, dropped);
  EXPECT_GT(dropped, 0U);
}

TEST(Synthetic, BoxesHaveTheStatedEdgeAndLieInTheGrid) {
  Recipe recipe = small_recipe();
  recipe.grid = {7, 30, 3, CellAnchor::kLowerEdge};
  recipe.invalid.blocks = 200;
  recipe.invalid.block_cells = 7;
  for (const CellBox& box : hole_boxes(recipe)) {
    EXPECT_EQ(box.first[0], 0);
    EXPECT_EQ(box.end[0], 7);
    EXPECT_GE(box.first[1], 0);
    EXPECT_LE(box.end[1], 30);
    EXPECT_EQ(box.end[1] - box.first[1], 7);
    EXPECT_EQ(box.first[2], 0);
    EXPECT_EQ(box.end[2], 3) << "cut to the grid";
  }
}

TEST(Synthetic, DirectionsSteeperThanTheLimitAreNotMeasured) {
  Recipe recipe = small_recipe();
  recipe.invalid.max_theta_deg = 62.5;
  const double limit = std::cos(62.5 * std::numbers::pi / 180.0);
  GenerateReport report;
  const std::vector<Rgb> values = generate_values(recipe, &report);
  for_each_cell(recipe.grid, [&](std::size_t cell, int h, int d, int p, const DirectionPair& pair) {
    const double lower_cosine = std::min(pair.wi.z, pair.wo.z);
    if (std::abs(lower_cosine - limit) < 1e-9) return;
    EXPECT_EQ(is_measured(values[cell]), lower_cosine > limit) << h << " " << d << " " << p;
  });
  EXPECT_GT(report.dropped, 0U);
  EXPECT_GT(report.valid, 0U);
}

TEST(Synthetic, CellExactlyAtTheLimitIsKept) {
  Recipe recipe = small_recipe();
  recipe.grid = {90, 90, 180, CellAnchor::kLowerEdge};
  for (const int degrees : {10, 45, 60, 80, 89}) {
    recipe.invalid.max_theta_deg = degrees;
    const Grid& grid = recipe.grid;
    const Holes holes(recipe);
    // theta_h = 0: both directions are at theta_d.
    const auto dropped = [&](int d) {
      return holes.dropped(0, d, 90, directions_from_half_diff(grid.angles(0, d, 90)));
    };
    EXPECT_FALSE(dropped(degrees)) << degrees;
    EXPECT_TRUE(dropped(degrees + 1)) << degrees;
  }
}

TEST(Synthetic, RecipeThatIsNotValidIsRefusedByName) {
  const std::vector<std::pair<std::string, std::function<void(Recipe&)>>> edits = {
      {"name", [](Recipe& r) { r.name.clear(); }},
      {"roughness", [](Recipe& r) { r.material.set("roughness", 0.0); }},
      {"grid.theta_h", [](Recipe& r) { r.grid.n_theta_h = 0; }},
      {"grid.phi_d", [](Recipe& r) { r.grid.n_phi_d = -1; }},
      {"too many cells",
       [](Recipe& r) {
         r.grid = {4096, 4096, 4096, CellAnchor::kCentre};
       }},
      {"noise.multiplicative", [](Recipe& r) { r.noise.multiplicative = -0.1; }},
      {"noise.additive", [](Recipe& r) { r.noise.additive = std::nan(""); }},
      {"invalid.fraction", [](Recipe& r) { r.invalid.fraction = 1.0; }},
      {"invalid.blocks", [](Recipe& r) { r.invalid.blocks = -1; }},
      {"invalid.block_cells", [](Recipe& r) { r.invalid.block_cells = 0; }},
      {"invalid.max_theta_deg", [](Recipe& r) { r.invalid.max_theta_deg = 90.5; }},
  };
  for (const auto& [member, edit] : edits) {
    Recipe recipe = small_recipe();
    edit(recipe);
    try {
      generate_values(recipe);
      ADD_FAILURE() << member << " was accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(member), std::string::npos) << error.what();
    }
  }
}

TEST_F(SyntheticFile, SameRecipeSameBytes) {
  const Recipe recipe = noisy_recipe_with_holes();
  generate(recipe, folder_ / "a.binary");
  generate(recipe, folder_ / "b.binary");
  const std::string bytes = bytes_of(folder_ / "a.binary");
  EXPECT_EQ(bytes.size(), 12 + 24 * recipe.grid.cell_count());
  EXPECT_TRUE(bytes == bytes_of(folder_ / "b.binary"));
}

TEST_F(SyntheticFile, StoresDoublesNotFloats) {
  const Recipe recipe = small_recipe();
  const std::vector<Rgb> values = generate_values(recipe);
  generate(recipe, folder_ / "exact.binary");
  const std::string bytes = bytes_of(folder_ / "exact.binary");
  const double scale[3] = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
  ASSERT_EQ(bytes.size(), 12 + 24 * values.size());
  for (std::size_t cell = 0; cell < values.size(); ++cell) {
    if (!is_measured(values[cell])) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      double stored = 0.0;
      std::memcpy(&stored, bytes.data() + 12 + 8 * (c * values.size() + cell), sizeof stored);
      // One rounding for the scale, one for the division, one here.
      ASSERT_NEAR(stored * scale[c], values[cell][c], 5e-16 * values[cell][c]) << cell;
    }
  }
}

TEST_F(SyntheticFile, ReaderFindsWhatTheReportSays) {
  const Recipe recipe = noisy_recipe_with_holes();
  const GenerateReport report = generate(recipe, folder_ / "table.binary");
  io::MerlReadReport found;
  const MeasuredTable table = io::read_merl(folder_ / "table.binary", {}, &found);
  EXPECT_EQ(table.grid(), recipe.grid);
  EXPECT_EQ(found.cells, report.cells);
  EXPECT_EQ(found.cells - found.invalid_cells, report.valid);
  EXPECT_EQ(table.valid_count(), report.valid);
}

TEST_F(SyntheticFile, RecipeWithoutAnyValidCellIsRefusedAndLeavesNoFile) {
  Recipe recipe = small_recipe();
  recipe.grid.anchor = CellAnchor::kCentre;
  recipe.invalid.max_theta_deg = 0.01;
  const std::filesystem::path file = folder_ / "empty.binary";
  try {
    generate(recipe, file);
    ADD_FAILURE() << "a table without a valid cell was written";
  } catch (const io::IoError& error) {
    EXPECT_EQ(error.file(), file.string());
    EXPECT_NE(std::string(error.what()).find("no valid cell"), std::string::npos);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace brdfit::synthetic
