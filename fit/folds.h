// Folds for cross-validation: samples held out in blocks of angles.
//
// Neighbouring cells of a measurement are alike, so a cell drawn at random is known from those around it, and
// holding it out shows nothing. A block of angles is not, as long as its mirror image is held out with it:
// the cells at phi_d and pi - phi_d hold one value twice (measured/symmetry.h).
#ifndef BRDFIT_FIT_FOLDS_H_
#define BRDFIT_FIT_FOLDS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "measured/sampling.h"
#include "measured/table.h"

namespace brdfit::fit {

// Cuts a grid into boxes of neighbouring cells, each with its mirror image in phi_d, and gives each to a
// fold. Every band of theta_h at every phi_d is cut along theta_d into as many boxes as there are folds, and
// each fold gets one of them, in an order drawn anew for each: so every fold holds out a part of each
// highlight, of each grazing corner and of each slice, and sees the rest.
class AngleBlocks {
 public:
  AngleBlocks(const Grid& grid, int folds, std::uint64_t seed);

  int count() const { return static_cast<int>(fold_.size()); }
  int block_of(std::size_t cell) const;
  int fold_of(std::size_t cell) const { return fold_[static_cast<std::size_t>(block_of(cell))]; }

 private:
  Grid grid_;
  int bands_h_;
  int bands_d_;
  int bands_p_;
  std::vector<int> fold_;  // of each block
};

// One fold: what is fitted and what is compared. The cells are those of the samples, in order.
struct Fold {
  SampleSet training;
  SampleSet validation;
  std::vector<std::size_t> training_cells;
  std::vector<std::size_t> validation_cells;
};

struct FoldOptions {
  int folds = 5;
  // Each fold's samples are thinned to about this many.
  std::size_t training_cells = 512;
  std::size_t validation_cells = 1280;
  std::uint64_t seed = 1;
};

// Splits a sample (measured/sampling.h), which stays stratified in each part, as parts are thinned evenly.
// Folds that would have nothing to fit or nothing to compare are left out.
std::vector<Fold> make_folds(const SampleSet& samples, const std::vector<std::size_t>& cells,
                             const Grid& grid, const FoldOptions& options);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_FOLDS_H_
