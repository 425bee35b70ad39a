// Blocks of angles, and that what a fold holds out is out of its sight.
#include "fit/folds.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>

#include "measured/grid_geometry.h"
#include "tests/fit_data.h"

namespace brdfit::fit {
namespace {

using testing_support::kSmallGrid;

struct Sampled {
  MeasuredTable table = testing_support::table_of(
      testing_support::random_full_material(Model::kCallisto, effects_of(Model::kCallisto), 7));
  std::vector<std::size_t> cells;
  SampleSet samples = sample_table(table, 4000, 1, {}, &cells);

  std::vector<Fold> folds(std::uint64_t seed = 1) const {
    return make_folds(samples, cells, table.grid(), {5, 600, 500, seed});
  }
};

std::set<int> blocks_of(const AngleBlocks& blocks, const std::vector<std::size_t>& cells) {
  std::set<int> result;
  for (const std::size_t cell : cells) result.insert(blocks.block_of(cell));
  return result;
}

// The three indices of a cell, with phi_d counted from the nearer of 0 and pi, where its mirror image is too.
std::array<int, 3> folded_place(const Grid& grid, std::size_t cell) {
  const auto n_p = static_cast<std::size_t>(grid.n_phi_d);
  const auto n_d = static_cast<std::size_t>(grid.n_theta_d);
  const int p = static_cast<int>(cell % n_p);
  const int image = GridGeometry(grid).mirror(p);
  return {static_cast<int>(cell / n_p / n_d), static_cast<int>(cell / n_p % n_d), std::min(p, image)};
}

// The three indices of a cell.
std::array<int, 3> place(const Grid& grid, std::size_t cell) {
  const auto n_p = static_cast<std::size_t>(grid.n_phi_d);
  const auto n_d = static_cast<std::size_t>(grid.n_theta_d);
  return {static_cast<int>(cell / n_p / n_d), static_cast<int>(cell / n_p % n_d),
          static_cast<int>(cell % n_p)};
}

TEST(AngleBlocks, AreBoxesOfNeighboursAndOfTheirMirrorImages) {
  for (const Grid& grid : {Grid{14, 12, 30, CellAnchor::kCentre}, Grid{14, 12, 30, CellAnchor::kLowerEdge},
                           Grid{7, 11, 5, CellAnchor::kLowerEdge}}) {
    const AngleBlocks blocks(grid, 5, 3);
    struct Box {
      std::array<int, 3> least = {1000, 1000, 1000};
      std::array<int, 3> most = {-1, -1, -1};
      std::set<std::array<int, 3>> places;
    };
    std::vector<Box> boxes(static_cast<std::size_t>(blocks.count()));
    for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
      Box& box = boxes.at(static_cast<std::size_t>(blocks.block_of(cell)));
      const auto at = folded_place(grid, cell);
      for (std::size_t k = 0; k < 3; ++k) {
        box.least[k] = std::min(box.least[k], at[k]);
        box.most[k] = std::max(box.most[k], at[k]);
      }
      box.places.insert(at);
    }
    for (const Box& box : boxes) {
      std::size_t volume = 1;
      for (std::size_t k = 0; k < 3; ++k) volume *= static_cast<std::size_t>(box.most[k] - box.least[k] + 1);
      EXPECT_FALSE(box.places.empty());
      EXPECT_EQ(box.places.size(), volume);
    }
  }
}

TEST(AngleBlocks, OfEveryThetaHRowAtEveryPhiDGoToAllFolds) {
  const Grid grid;
  const AngleBlocks blocks(grid, 5, 3);
  for (int h = 0; h < grid.n_theta_h; ++h) {
    for (int p = 0; p < grid.n_phi_d; p += 7) {
      std::map<int, int> rows;
      for (int d = 0; d < grid.n_theta_d; ++d) ++rows[blocks.fold_of(grid.index(h, d, p))];
      EXPECT_EQ(rows.size(), 5U);
      for (const auto& [fold, count] : rows) EXPECT_EQ(count, grid.n_theta_d / 5);
    }
  }
}

TEST(Folds, HoldOutWholeBlocksThatNoTrainingCellTouches) {
  const Sampled sampled;
  for (const std::uint64_t seed : {1U, 2U, 99U}) {
    const AngleBlocks blocks(sampled.table.grid(), 5, seed);
    const std::vector<Fold> folds = sampled.folds(seed);
    ASSERT_EQ(folds.size(), 5U);
    for (const Fold& fold : folds) {
      const std::set<int> seen = blocks_of(blocks, fold.training_cells);
      const std::set<int> held_out = blocks_of(blocks, fold.validation_cells);
      std::vector<int> both;
      std::ranges::set_intersection(seen, held_out, std::back_inserter(both));
      EXPECT_THAT(both, testing::IsEmpty());
    }
  }
}

TEST(Folds, HoldOutEveryBlockOnce) {
  const Sampled sampled;
  const AngleBlocks blocks(sampled.table.grid(), 5, 1);
  std::map<int, int> held_out;
  // As many cells as there are: thinning may pass over a block at the horizon, which has few.
  for (const Fold& fold :
       make_folds(sampled.samples, sampled.cells, sampled.table.grid(), {5, 600, 4000, 1})) {
    for (const int block : blocks_of(blocks, fold.validation_cells)) ++held_out[block];
  }
  EXPECT_EQ(held_out.size(), blocks_of(blocks, sampled.cells).size());
  for (const auto& [block, times] : held_out) EXPECT_EQ(times, 1) << block;
}

TEST(Folds, HoldTheValuesOfTheirCells) {
  const Sampled sampled;
  for (const Fold& fold : sampled.folds()) {
    for (const auto& [samples, cells] : {std::pair(&fold.training, &fold.training_cells),
                                         std::pair(&fold.validation, &fold.validation_cells)}) {
      ASSERT_EQ(samples->size(), cells->size());
      double weights = 0.0;
      for (std::size_t k = 0; k < cells->size(); ++k) {
        EXPECT_EQ(samples->f(1)[k], sampled.table.value((*cells)[k])[1]);
        weights += samples->weight()[k];
      }
      EXPECT_NEAR(weights, 1.0, 1e-12);
    }
  }
}

TEST(Folds, AreAboutAsLargeAsAskedFor) {
  for (const Fold& fold : Sampled().folds()) {
    EXPECT_LE(fold.training.size(), 600U);
    EXPECT_GT(fold.training.size(), 300U);
    EXPECT_LE(fold.validation.size(), 500U);
    EXPECT_GT(fold.validation.size(), 250U);
  }
}

TEST(Folds, DependOnTheSeedAlone) {
  const Sampled sampled;
  const std::vector<Fold> first = sampled.folds(5);
  const std::vector<Fold> again = sampled.folds(5);
  const std::vector<Fold> other = sampled.folds(6);
  for (std::size_t k = 0; k < first.size(); ++k) {
    EXPECT_EQ(first[k].training_cells, again[k].training_cells);
    EXPECT_EQ(first[k].validation_cells, again[k].validation_cells);
    EXPECT_NE(first[k].validation_cells, other[k].validation_cells);
  }
}

TEST(Folds, OfASliceAreBlocksOfIt) {
  const Sampled sampled;
  std::vector<std::size_t> cells;
  const std::vector<double> phi_d = {90.0};
  const SampleSet slice = sample_slices(sampled.table, phi_d, {}, &cells);
  ASSERT_EQ(cells.size(), slice.size());
  const std::vector<Fold> folds = make_folds(slice, cells, sampled.table.grid(), FoldOptions());
  const AngleBlocks blocks(sampled.table.grid(), 5, 1);
  ASSERT_EQ(folds.size(), 5U);
  for (const Fold& fold : folds) {
    const std::set<int> seen = blocks_of(blocks, fold.training_cells);
    for (const int block : blocks_of(blocks, fold.validation_cells)) EXPECT_FALSE(seen.contains(block));
    for (const std::size_t cell : fold.validation_cells) {
      EXPECT_EQ(place(sampled.table.grid(), cell)[2], kSmallGrid.n_phi_d / 2);
    }
  }
}

}  // namespace
}  // namespace brdfit::fit
