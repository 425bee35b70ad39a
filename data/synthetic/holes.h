// The cells that a recipe leaves out: boxes, single cells and steep directions.
#ifndef BRDFIT_DATA_SYNTHETIC_HOLES_H_
#define BRDFIT_DATA_SYNTHETIC_HOLES_H_

#include <array>
#include <cstddef>
#include <vector>

#include "brdf/half_diff.h"
#include "data/synthetic/counter_random.h"
#include "data/synthetic/recipe.h"

namespace brdfit::synthetic {

// A box of cells, first and one past the last in theta_h, theta_d and phi_d.
struct CellBox {
  std::array<int, 3> first;
  std::array<int, 3> end;
  bool contains(int i_theta_h, int i_theta_d, int i_phi_d) const;
};

// The box-shaped holes of a recipe: invalid.blocks boxes that lie in the grid and may overlap.
std::vector<CellBox> hole_boxes(const Recipe& recipe);

// Whether both directions are far enough above the horizon (cosine > 1e-9) for f to be stored.
bool above_horizon(const DirectionPair& pair);

// Whether a recipe drops a cell whose directions are above the horizon.
class Holes {
 public:
  explicit Holes(const Recipe& recipe);

  bool dropped(int i_theta_h, int i_theta_d, int i_phi_d, const DirectionPair& pair) const;

 private:
  Grid grid_;
  double fraction_;
  double min_cosine_;
  CounterRandom random_;
  std::vector<bool> in_box_;  // by cell; empty where there are no boxes
};

}  // namespace brdfit::synthetic

#endif  // BRDFIT_DATA_SYNTHETIC_HOLES_H_
