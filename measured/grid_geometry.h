// Cosines of the angles that a grid stores, computed once, so that walking a table needs no trigonometry.
#ifndef BRDFIT_MEASURED_GRID_GEOMETRY_H_
#define BRDFIT_MEASURED_GRID_GEOMETRY_H_

#include <cstddef>
#include <vector>

#include "brdf/half_diff.h"
#include "measured/table.h"

namespace brdfit {

// Cosines of one pair in half/difference coordinates and their companions; the members are those of
// simd::GeometryColumns, in its order.
struct CellGeometry {
  double cos_i;
  double cos_o;
  double sin_h;
  double cos_h;
  double cos_d;
  double one_minus_cos_h;
  double one_minus_cos_d;
  double log_cos_h;  // natural logarithms; 0 where the argument is 0
  double log_cos_d;
  double log_one_minus_cos_h;
  double log_one_minus_cos_d;
};

CellGeometry cell_geometry(const HalfDiff& angles);

// Consecutive phi_d indices, end excluded.
struct PhiRun {
  int first = 0;
  int end = 0;

  bool empty() const { return first >= end; }
  int size() const { return end - first; }
};

class GridGeometry {
 public:
  // What the models ask of an angle in [0, pi/2].
  struct Angle {
    explicit Angle(double radians);

    double sine;
    double cosine;
    double one_minus_cosine;  // without cancellation
    double log_cosine;        // 0 where the argument is 0
    double log_one_minus_cosine;
  };

  explicit GridGeometry(const Grid& grid);

  // As cell_geometry(grid.angles(...)), to the last digits. i_phi_d may be any that mirror() gives.
  CellGeometry cell(int i_theta_h, int i_theta_d, int i_phi_d) const;

  // cos_i and cos_o of run.size() neighbouring cells.
  void cosines(int i_theta_h, int i_theta_d, PhiRun run, double* cos_i, double* cos_o) const;

  const Angle& theta_h(int i) const { return theta_h_[static_cast<std::size_t>(i)]; }
  const Angle& theta_d(int i) const { return theta_d_[static_cast<std::size_t>(i)]; }

  // The index of pi - phi_d, where wi and wo are exchanged: cos_i of a cell is exactly cos_o of its mirror
  // image. With values at lower edges that of index 0 is n_phi_d, one past the stored ones.
  int mirror(int i_phi_d) const { return mirror_sum_ - i_phi_d; }

  // The last index that is not above its mirror image.
  int middle() const { return mirror_sum_ / 2; }

  // The stored phi_d at which both cosines are at least min_cosine: always without a gap.
  PhiRun observed(int i_theta_h, int i_theta_d, double min_cosine) const;

 private:
  int n_phi_d_;
  int mirror_sum_;  // of an index and its mirror image
  std::vector<Angle> theta_h_;
  std::vector<Angle> theta_d_;
  std::vector<double> cos_phi_d_;
};

// The lowest cosine of a direction that is observed when those further than max_theta_deg from the normal are
// not. Just above the horizon counts as below it: f has no meaning there.
double lowest_observed_cosine(double max_theta_deg);

}  // namespace brdfit

#endif  // BRDFIT_MEASURED_GRID_GEOMETRY_H_
