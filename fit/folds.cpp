// Blocks of angles and the samples in them.
#include "fit/folds.h"

#include <algorithm>
#include <numeric>
#include <random>

namespace brdfit::fit {
namespace {

// Bands of theta_h (15 rows of a MERL grid: 2.5 deg at the peak, 27 deg at the end) and of phi_d (22.5 deg
// and their mirror images, which are 45 deg in one piece in the middle).
constexpr int kBandsH = 6;
constexpr int kBandsP = 4;

int band_of(int index, int cells, int bands) {
  return index * bands / cells;
}

// The distance of phi_d from 0 or pi, whichever is nearer, in cells: the same for a cell and its mirror
// image.
int folded(const Grid& grid, int i_phi_d) {
  const int mirror_sum = grid.anchor == CellAnchor::kCentre ? grid.n_phi_d - 1 : grid.n_phi_d;
  return std::min(i_phi_d, mirror_sum - i_phi_d);
}

int folded_cells(const Grid& grid) {
  return folded(grid, grid.n_phi_d / 2) + 1;
}

// Every stride-th entry, so that about count are left.
std::vector<std::size_t> thinned(const std::vector<std::size_t>& indices, std::size_t count) {
  const std::size_t stride = std::max<std::size_t>(1, (indices.size() + count - 1) / count);
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < indices.size(); k += stride) result.push_back(indices[k]);
  return result;
}

}  // namespace

AngleBlocks::AngleBlocks(const Grid& grid, int folds, std::uint64_t seed)
    : grid_(grid),
      bands_h_(std::min(kBandsH, grid.n_theta_h)),
      bands_d_(std::min(folds, grid.n_theta_d)),
      bands_p_(std::min(kBandsP, folded_cells(grid))) {
  std::mt19937_64 random(seed);
  std::vector<int> order(static_cast<std::size_t>(folds));
  std::iota(order.begin(), order.end(), 0);
  for (int column = 0; column < bands_h_ * bands_p_; ++column) {
    // std::shuffle differs between libraries.
    for (std::size_t k = order.size() - 1; k > 0; --k) std::swap(order[k], order[random() % (k + 1)]);
    fold_.insert(fold_.end(), order.begin(), order.begin() + bands_d_);
  }
}

int AngleBlocks::block_of(std::size_t cell) const {
  const auto n_p = static_cast<std::size_t>(grid_.n_phi_d);
  const auto n_d = static_cast<std::size_t>(grid_.n_theta_d);
  const int h = band_of(static_cast<int>(cell / n_p / n_d), grid_.n_theta_h, bands_h_);
  const int d = band_of(static_cast<int>(cell / n_p % n_d), grid_.n_theta_d, bands_d_);
  const int p = band_of(folded(grid_, static_cast<int>(cell % n_p)), folded_cells(grid_), bands_p_);
  return (h * bands_p_ + p) * bands_d_ + d;
}

std::vector<Fold> make_folds(const SampleSet& samples, const std::vector<std::size_t>& cells,
                             const Grid& grid, const FoldOptions& options) {
  const AngleBlocks blocks(grid, options.folds, options.seed);
  std::vector<Fold> folds;
  for (int held_out_fold = 0; held_out_fold < options.folds; ++held_out_fold) {
    std::vector<std::size_t> inside;
    std::vector<std::size_t> outside;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      (blocks.fold_of(cells[k]) == held_out_fold ? inside : outside).push_back(k);
    }
    if (inside.empty() || outside.empty()) continue;
    const std::vector<std::size_t> seen = thinned(outside, options.training_cells);
    const std::vector<std::size_t> held_out = thinned(inside, options.validation_cells);
    Fold fold = {samples.subset(seen), samples.subset(held_out), {}, {}};
    for (const std::size_t index : seen) fold.training_cells.push_back(cells[index]);
    for (const std::size_t index : held_out) fold.validation_cells.push_back(cells[index]);
    folds.push_back(std::move(fold));
  }
  return folds;
}

}  // namespace brdfit::fit
