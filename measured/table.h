// A measured isotropic BRDF on the grid of a MERL file: values, validity, interpolation.
#ifndef BRDFIT_MEASURED_TABLE_H_
#define BRDFIT_MEASURED_TABLE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "brdf/half_diff.h"
#include "brdf/vec3.h"

namespace brdfit {

// Where in its cell a stored value was measured.
enum class CellAnchor {
  kLowerEdge,  // at the cell's smallest angles, as MERL's own tables are read (the default everywhere)
  kCentre,     // half a cell further
};

// What a cell of a table holds.
enum class CellState {
  kMeasured,
  kUnmeasured,  // all channels negative: the file's mark for "no measurement"
  kNegative,    // some channels negative, others not
  kNotFinite,   // NaN or infinity in some channel
};

// Dimensions of the grid, and the angles of its cells.
//
// theta_h is spaced as a square (theta_h = (i/n)^2 pi/2), theta_d and phi_d evenly over [0, pi/2) and [0,
// pi); Matusik et al. 2003.
struct Grid {
  int n_theta_h = 90;
  int n_theta_d = 90;
  int n_phi_d = 180;
  CellAnchor anchor = CellAnchor::kLowerEdge;

  std::size_t cell_count() const {
    return static_cast<std::size_t>(n_theta_h) * static_cast<std::size_t>(n_theta_d) *
           static_cast<std::size_t>(n_phi_d);
  }
  std::size_t index(int i_theta_h, int i_theta_d, int i_phi_d) const {
    return (static_cast<std::size_t>(i_theta_h) * static_cast<std::size_t>(n_theta_d) +
            static_cast<std::size_t>(i_theta_d)) *
               static_cast<std::size_t>(n_phi_d) +
           static_cast<std::size_t>(i_phi_d);
  }
  double theta_h_rad(int i_theta_h) const;
  double theta_d_rad(int i_theta_d) const;
  double phi_d_rad(int i_phi_d) const;
  HalfDiff angles(int i_theta_h, int i_theta_d, int i_phi_d) const;
  // The same for a cell by its index.
  HalfDiff angles_of(std::size_t cell) const;
  // The theta_h row whose cell contains that angle; clamped to the grid.
  int row_of_theta_h(double theta_h_rad) const;
  friend bool operator==(const Grid&, const Grid&) = default;
};

// The table. A cell is valid when all three of its channels were measured; f is in sr^-1, linear RGB.
class MeasuredTable {
 public:
  MeasuredTable() = default;

  // planes: red, green and blue values of f, each grid.cell_count() floats in the order of Grid::index. A
  // cell with a negative or non-finite channel is invalid; its values are replaced by a mark that keeps the
  // reason. Throws std::invalid_argument if the size is not 3 * grid.cell_count() or a dimension is not
  // positive.
  MeasuredTable(const Grid& grid, std::vector<float> planes);

  const Grid& grid() const { return grid_; }
  std::size_t valid_count() const { return valid_count_; }
  bool is_valid(std::size_t cell) const { return planes_[cell] >= 0.0F; }

  // Why a cell is not valid, or kMeasured.
  CellState state(std::size_t cell) const;
  // Cells of each state, in the order of CellState.
  std::array<std::size_t, 4> state_counts() const;

  // f of a valid cell; the same negative number in all channels of an invalid one.
  Rgb value(std::size_t cell) const;

  // One colour's plane, grid().cell_count() values; negative in invalid cells.
  std::span<const float> plane(int channel) const;

  // The largest value of any valid cell and channel; 0 if there is none.
  double largest() const;

  // f between cells: trilinear in the grid's own spacing (square-root in theta_h). phi_d wraps at pi by
  // reciprocity; theta_h and theta_d past the last stored angle use the last. Invalid corners are left out
  // and the weights of the others scaled up; nothing where all eight corners are invalid. wi, wo above the
  // horizon or not: the grid alone decides.
  std::optional<Rgb> interpolate(const HalfDiff& angles) const;
  std::optional<Rgb> interpolate(const Vec3& wi, const Vec3& wo) const;

 private:
  Grid grid_;
  std::vector<float> planes_;
  std::size_t valid_count_ = 0;
};

}  // namespace brdfit

#endif  // BRDFIT_MEASURED_TABLE_H_
