// The cells that a recipe leaves out.
#include "data/synthetic/holes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "data/synthetic/streams.h"

namespace brdfit::synthetic {
namespace {

constexpr double kHorizonCosine = 1e-9;
// A cell exactly at max_theta_deg is kept: its cosine may be off by a few roundings.
constexpr double kCosineSlack = 1e-12;

void mark(const CellBox& box, const Grid& grid, std::vector<bool>& marked) {
  for (int h = box.first[0]; h < box.end[0]; ++h) {
    for (int d = box.first[1]; d < box.end[1]; ++d) {
      for (int p = box.first[2]; p < box.end[2]; ++p) marked[grid.index(h, d, p)] = true;
    }
  }
}

}  // namespace

bool CellBox::contains(int i_theta_h, int i_theta_d, int i_phi_d) const {
  const std::array<int, 3> cell = {i_theta_h, i_theta_d, i_phi_d};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (cell[axis] < first[axis] || cell[axis] >= end[axis]) return false;
  }
  return true;
}

std::vector<CellBox> hole_boxes(const Recipe& recipe) {
  const std::array<int, 3> size = {recipe.grid.n_theta_h, recipe.grid.n_theta_d, recipe.grid.n_phi_d};
  const CounterRandom random(recipe.seed, kBoxStream);
  std::vector<CellBox> boxes(static_cast<std::size_t>(recipe.invalid.blocks));
  std::uint64_t counter = 0;
  for (CellBox& box : boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int edge = std::min(recipe.invalid.block_cells, size[axis]);
      const auto places = static_cast<std::uint64_t>(size[axis] - edge + 1);
      box.first[axis] = static_cast<int>(random.below(counter++, places));
      box.end[axis] = box.first[axis] + edge;
    }
  }
  return boxes;
}

bool above_horizon(const DirectionPair& pair) {
  return pair.wi.z > kHorizonCosine && pair.wo.z > kHorizonCosine;
}

Holes::Holes(const Recipe& recipe)
    : grid_(recipe.grid),
      fraction_(recipe.invalid.fraction),
      min_cosine_(std::cos(recipe.invalid.max_theta_deg * std::numbers::pi / 180.0) - kCosineSlack),
      random_(recipe.seed, kDropStream) {
  const std::vector<CellBox> boxes = hole_boxes(recipe);
  if (!boxes.empty()) in_box_.resize(grid_.cell_count());
  for (const CellBox& box : boxes) mark(box, grid_, in_box_);
}

bool Holes::dropped(int i_theta_h, int i_theta_d, int i_phi_d, const DirectionPair& pair) const {
  const std::size_t cell = grid_.index(i_theta_h, i_theta_d, i_phi_d);
  if (pair.wi.z < min_cosine_ || pair.wo.z < min_cosine_) return true;
  if (!in_box_.empty() && in_box_[cell]) return true;
  return random_.uniform(cell) < fraction_;
}

}  // namespace brdfit::synthetic
