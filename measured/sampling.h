// Observations taken from a measured table: the geometry, the values and the weights that fits and measures
// use.
#ifndef BRDFIT_MEASURED_SAMPLING_H_
#define BRDFIT_MEASURED_SAMPLING_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "brdf/simd/jobs.h"
#include "measured/grid_geometry.h"
#include "measured/table.h"

namespace brdfit {

// Observations as columns of equal length, padded to a multiple of simd::kBlock with entries of weight 0.
class SampleSet {
 public:
  // Adds one observation: f measured for (wi, wo) and (wo, wi), which a table does not tell apart, in sr^-1.
  // Weights need not sum to 1 until finish().
  void add(const CellGeometry& geometry, const Rgb& f, double weight);

  // Makes room for that many observations in all.
  void reserve(std::size_t count);

  // Pads and scales the weights to a sum of 1. Nothing may be added afterwards.
  void finish();

  std::size_t size() const { return size_; }  // observations
  std::size_t padded_size() const { return cos_i_.size(); }
  simd::GeometryColumns geometry() const;  // padded_size() entries each
  // Whether (wi, wo) and (wo, wi) are different pairs in any observation: cos_i and cos_o differ.
  bool has_two_orders() const;
  std::span<const double> cos_i() const { return cos_i_; }
  std::span<const double> cos_o() const { return cos_o_; }
  std::span<const double> cos_h() const { return cos_h_; }
  std::span<const double> cos_d() const { return cos_d_; }
  std::span<const double> f(int channel) const { return f_[static_cast<std::size_t>(channel)]; }
  std::span<const double> weight() const { return weight_; }

  // Every stride-th observation, beginning with the first; weights rescaled.
  SampleSet thinned(std::size_t stride) const;

  // The observations with these indices, in that order; weights rescaled.
  SampleSet subset(std::span<const std::size_t> indices) const;

 private:
  CellGeometry cell(std::size_t k) const;

  std::size_t size_ = 0;
  std::vector<double> cos_i_, cos_o_, sin_h_, cos_h_, cos_d_, one_minus_cos_h_, one_minus_cos_d_;
  std::vector<double> log_cos_h_, log_cos_d_, log_one_minus_cos_h_, log_one_minus_cos_d_;
  std::array<std::vector<double>, 3> f_;
  std::vector<double> weight_;
};

// What of a table is observed.
struct SamplingOptions {
  // Cells where wi or wo is further from the normal are left out. MERL is extrapolated above about 80 deg.
  double max_theta_deg = 90.0;
};

inline constexpr std::size_t kAllSamples = std::numeric_limits<std::size_t>::max();

// A stratified sample of valid cells, each with the same weight: cells are put in an order that keeps
// neighbours together (a theta_h row, patches of theta_d and phi_d within it), cut into cell_count strata of
// equal size, and one cell is drawn from each. As the grid itself is square-root spaced in theta_h, the peak
// is resolved. cell_count: kAllSamples, or more than there are, takes every cell once. The same seed gives
// the same sample, whatever the number of threads. cells: gets each observation's cell of the table, where
// not null.
SampleSet sample_table(const MeasuredTable& table, std::size_t cell_count, std::uint64_t seed,
                       const SamplingOptions& options, std::vector<std::size_t>* cells = nullptr);

// The slices at the stored phi_d nearest below each angle. Every stored row is used, so that the peak is
// resolved; a row weighs as much as it takes of a slice that is linear in theta_h, half by its width, half by
// the pixels of the slice measures (measured/slice.h) that show it. cells: as above.
SampleSet sample_slices(const MeasuredTable& table, std::span<const double> phi_d_deg,
                        const SamplingOptions& options, std::vector<std::size_t>* cells = nullptr);

}  // namespace brdfit

#endif  // BRDFIT_MEASURED_SAMPLING_H_
