// Stratified samples of a table of growing size, each within the next, and cells that none of them sees.
#ifndef BRDFIT_MEASURED_NESTED_SAMPLE_H_
#define BRDFIT_MEASURED_NESTED_SAMPLE_H_

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "measured/grid_geometry.h"
#include "measured/sampling.h"
#include "measured/table.h"

namespace brdfit {

// Boxes of neighbouring cells of one theta_h row (which keeps the peak resolved, as the grid is square-root
// spaced there), about twice as long in phi_d as in theta_d. Of each box one cell is drawn; growing halves
// every box, keeps what was drawn in its half and draws one cell of the other half. A cell that is not
// observed, or that is a check cell, is no observation and is not drawn again: so each observed cell is as
// likely as any other, without a look at the whole table. The same seed gives the same samples.
class NestedSample {
 public:
  struct Options {
    std::size_t least = 1600;        // cells of the first sample, about; a box for every row at least
    std::size_t check_cells = 4096;  // about; at most an eighth of the valid ones
    std::uint64_t seed = 1;
    SamplingOptions sampling;
  };

  // Keeps a reference to the table.
  NestedSample(const MeasuredTable& table, const Options& options);

  // The sample as it is now; weights are the sizes of boxes. cells: each observation's cell of the table,
  // where not null.
  SampleSet samples(std::vector<std::size_t>* cells = nullptr) const;

  // Cells that no sample holds, stratified likewise.
  SampleSet check(std::vector<std::size_t>* cells = nullptr) const;

  // About how many cells the sample has.
  std::size_t size() const { return observed_; }

  // Doubles the number of boxes. False, and nothing done, where every box is a single cell.
  bool grow();

 private:
  // Of one row: [first, end) of theta_d and of phi_d; the cell that was drawn, and whether it is observed.
  struct Box {
    int theta_h;
    int first_d, end_d;
    int first_p, end_p;
    int drawn_d, drawn_p;
    bool counts;

    int cells() const { return (end_d - first_d) * (end_p - first_p); }
    bool holds(int d, int p) const { return d >= first_d && d < end_d && p >= first_p && p < end_p; }
  };
  using Boxes = std::vector<Box>;

  static std::pair<Box, Box> cut(const Box& box, int parts);
  void divide(const Box& box, int parts, Boxes& boxes);
  Boxes halved(const Boxes& boxes);
  Boxes boxes_for(std::size_t count);
  void draw(Box& box);
  bool is_observed(const Box& box) const;
  static std::size_t count_of(const Boxes& boxes);
  SampleSet observations(const Boxes& boxes, std::vector<std::size_t>* cells) const;

  const MeasuredTable& table_;
  GridGeometry geometry_;
  double min_cosine_;
  std::mt19937_64 random_;
  std::vector<std::size_t> check_cells_;  // in order
  Boxes check_;
  Boxes boxes_;
  std::size_t observed_ = 0;
};

}  // namespace brdfit

#endif  // BRDFIT_MEASURED_NESTED_SAMPLE_H_
