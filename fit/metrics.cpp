// Error measures over slices and tables.
#include "fit/metrics.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include "brdf/models.h"
#include "brdf/simd/dispatch.h"
#include "fit/metric_sums.h"
#include "measured/grid_geometry.h"
#include "measured/slice.h"

namespace brdfit::simd {

BRDFIT_DECLARE_SIMD(void sum_metrics(const fit::MetricJob&, fit::MetricSums&))
BRDFIT_DECLARE_SIMD(double sum_order_gap(const fit::MetricJob&))

}  // namespace brdfit::simd

namespace brdfit::fit {
namespace {

MetricFunction metric_function() {
  using namespace simd;
  return BRDFIT_PICK(best_isa(), sum_metrics);
}

OrderGapFunction order_gap_function() {
  using namespace simd;
  return BRDFIT_PICK(best_isa(), sum_order_gap);
}

// Neighbouring cells of a (theta_h, theta_d) row, in a batch from position begin on. The run of phi_d is
// closed under the exchange of wi and wo: the mirror image of its k-th entry is its k-th from the end.
struct Segment {
  std::size_t begin;
  std::size_t first_cell;  // in the table
  std::size_t size;
  std::size_t stored;  // how many are in the table: the last may be the mirror image of phi_d = 0
};

// Cells of one theta_h row side by side, as many as fit the cache; padded with weight 0.
class CellBatch {
 public:
  template <class T>
  using Columns = std::array<std::vector<T>, 3>;

  std::array<std::vector<double>, 11> geometry;  // in the order of simd::GeometryColumns
  Columns<double> f;
  Columns<double> f_swapped;  // for (wo, wi); only for materials that are not reciprocal
  Columns<float> r;
  std::vector<float> weight;
  std::vector<Segment> segments;

  CellBatch(const Grid& grid, const GridGeometry& angles, int i_theta_h)
      : grid_(grid), angles_(angles), i_theta_h_(i_theta_h) {
    const std::size_t longest_run = static_cast<std::size_t>(grid.n_phi_d) + 1;
    capacity_ = simd::kBlock * std::max<std::size_t>(8, longest_run / simd::kBlock + 1);
    for (auto& column : geometry) column.resize(capacity_);
    for (auto* columns : {&f, &f_swapped}) {
      for (auto& column : *columns) column.resize(capacity_);
    }
    for (auto& column : r) column.resize(capacity_);
    weight.resize(capacity_);
    // What depends on theta_h alone stays for good.
    const GridGeometry::Angle& h = angles.theta_h(i_theta_h);
    fill(kSinH, h.sine, 0, capacity_);
    fill(kCosH, h.cosine, 0, capacity_);
    fill(kOneMinusCosH, h.one_minus_cosine, 0, capacity_);
    fill(kLogCosH, h.log_cosine, 0, capacity_);
    fill(kLogOneMinusCosH, h.log_one_minus_cosine, 0, capacity_);
  }

  bool empty() const { return size_ == 0; }
  bool has_room_for(PhiRun run) const { return size_ + static_cast<std::size_t>(run.size()) <= capacity_; }
  std::size_t padded() const { return (size_ + simd::kBlock - 1) / simd::kBlock * simd::kBlock; }

  // Adds a run that is closed under the exchange; its weights and values of r are for the caller to set.
  const Segment& add(int i_theta_d, PhiRun run) {
    const auto count = static_cast<std::size_t>(run.size());
    angles_.cosines(i_theta_h_, i_theta_d, run, &geometry[kCosI][size_], &geometry[kCosO][size_]);
    const GridGeometry::Angle& d = angles_.theta_d(i_theta_d);
    fill(kCosD, d.cosine, size_, count);
    fill(kOneMinusCosD, d.one_minus_cosine, size_, count);
    fill(kLogCosD, d.log_cosine, size_, count);
    fill(kLogOneMinusCosD, d.log_one_minus_cosine, size_, count);
    const auto stored = static_cast<std::size_t>(std::min(run.end, grid_.n_phi_d) - run.first);
    segments.push_back({size_, grid_.index(i_theta_h_, i_theta_d, run.first), count, stored});
    size_ += count;
    return segments.back();
  }

  // Repeats the last cell with weight 0.
  void pad() {
    for (std::size_t k = size_; k < padded(); ++k) {
      for (auto& column : geometry) column[k] = column[size_ - 1];
      for (std::size_t c = 0; c < 3; ++c) {
        f[c][k] = f_swapped[c][k] = 0.0;
        r[c][k] = 0.0F;
      }
      weight[k] = 0.0F;
    }
  }

  void clear() {
    size_ = 0;
    segments.clear();
  }

  simd::GeometryColumns columns() const {
    return {geometry[0].data(), geometry[1].data(), geometry[2].data(), geometry[3].data(),
            geometry[4].data(), geometry[5].data(), geometry[6].data(), geometry[7].data(),
            geometry[8].data(), geometry[9].data(), geometry[10].data()};
  }

  MetricJob job() const {
    MetricJob job;
    for (std::size_t c = 0; c < 3; ++c) {
      job.f[c] = f[c].data();
      job.f_swapped[c] = f_swapped[c].data();
      job.r[c] = r[c].data();
    }
    job.cos_i = geometry[kCosI].data();
    job.weight = weight.data();
    job.count = padded();
    return job;
  }

 private:
  enum Column {
    kCosI,
    kCosO,
    kSinH,
    kCosH,
    kCosD,
    kOneMinusCosH,
    kOneMinusCosD,
    kLogCosH,
    kLogCosD,
    kLogOneMinusCosH,
    kLogOneMinusCosD
  };

  void fill(Column column, double value, std::size_t begin, std::size_t count) {
    std::fill_n(geometry[column].begin() + static_cast<std::ptrdiff_t>(begin), count, value);
  }

  const Grid& grid_;
  const GridGeometry& angles_;
  int i_theta_h_;
  std::size_t capacity_ = 0;
  std::size_t size_ = 0;
};

// A table's values in a segment; -1 where it has none.
template <class T>
void copy_values(const MeasuredTable& table, const Segment& segment, CellBatch::Columns<T>& to) {
  for (std::size_t c = 0; c < 3; ++c) {
    const auto from = table.plane(static_cast<int>(c)).subspan(segment.first_cell, segment.stored);
    std::fill(std::ranges::copy(from, to[c].begin() + static_cast<std::ptrdiff_t>(segment.begin)).out,
              to[c].begin() + static_cast<std::ptrdiff_t>(segment.begin + segment.size), T{-1});
  }
}

// Puts f of a padded batch's cells into its columns; returns the sum of log-ratios between its two orders.
using Candidate = std::function<double(CellBatch&)>;

// Models give f cos_i.
void divide_by_cosine(CellBatch& batch) {
  const std::vector<double>& cos_i = batch.geometry[0];
  for (std::size_t k = 0; k < batch.padded(); ++k) {
    const double inverse = 1.0 / cos_i[k];
    for (auto& channel : batch.f) channel[k] *= inverse;
  }
}

// f becomes the mean of both orders. As segments are closed under the exchange, the other order of each entry
// has been evaluated already, with the same cosines to the last bit.
double fold_orders(CellBatch& batch) {
  for (std::size_t c = 0; c < 3; ++c) {
    for (const Segment& segment : batch.segments) {
      const auto first = batch.f[c].begin() + static_cast<std::ptrdiff_t>(segment.begin);
      std::reverse_copy(first, first + static_cast<std::ptrdiff_t>(segment.size),
                        batch.f_swapped[c].begin() + static_cast<std::ptrdiff_t>(segment.begin));
    }
  }
  const double gap = order_gap_function()(batch.job());
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < batch.padded(); ++k) {
      batch.f[c][k] = 0.5 * (batch.f[c][k] + batch.f_swapped[c][k]);
    }
  }
  return gap;
}

Candidate material_candidate(const Material& material) {
  return [coefficients = simd::coefficients_of(material), reciprocal = is_reciprocal(material),
          evaluate = simd::eval_columns(simd::best_isa())](CellBatch& batch) {
    double* const out[3] = {batch.f[0].data(), batch.f[1].data(), batch.f[2].data()};
    evaluate(coefficients, batch.columns(), batch.padded(), out);
    divide_by_cosine(batch);
    return reciprocal ? 0.0 : fold_orders(batch);
  };
}

Candidate table_candidate(const MeasuredTable& table) {
  return [&table](CellBatch& batch) {
    for (const Segment& segment : batch.segments) {
      copy_values(table, segment, batch.f);
      for (std::size_t k = segment.begin; k < segment.begin + segment.size; ++k) {
        if (batch.f[0][k] >= 0.0) continue;
        batch.weight[k] = 0.0F;
        for (auto& channel : batch.f) channel[k] = 0.0;
      }
    }
    return 0.0;
  };
}

// What one worker adds up.
struct Totals {
  MetricSums sums;
  double reciprocity = 0.0;
  double weight = 0.0;
  std::size_t cells = 0;

  Totals& operator+=(const Totals& other) {
    sums += other.sums;
    reciprocity += other.reciprocity;
    weight += other.weight;
    cells += other.cells;
    return *this;
  }
};

// What is compared: valid in the reference and in the candidate, above the horizon, within max_theta.
struct Comparison {
  const MeasuredTable& reference;
  const Candidate& candidate;
  const GridGeometry& angles;
  double min_cosine;
};

// Compares cells of one theta_h row.
class RowComparison {
 public:
  RowComparison(const Comparison& comparison, int i_theta_h)
      : comparison_(comparison),
        i_theta_h_(i_theta_h),
        batch_(comparison.reference.grid(), comparison.angles, i_theta_h) {}

  // Each cell of the theta_d row that is compared counts as one.
  void add_row(int i_theta_d) {
    const PhiRun observed = comparison_.angles.observed(i_theta_h_, i_theta_d, comparison_.min_cosine);
    if (!observed.empty()) add(i_theta_d, observed, 1.0F);
  }

  // One cell, if it is compared.
  void add_cell(int i_theta_d, int i_phi_d, float count) {
    const PhiRun observed = comparison_.angles.observed(i_theta_h_, i_theta_d, comparison_.min_cosine);
    if (i_phi_d >= observed.first && i_phi_d < observed.end) add(i_theta_d, {i_phi_d, i_phi_d + 1}, count);
  }

  Totals finish() {
    flush();
    return totals_;
  }

 private:
  void add(int i_theta_d, PhiRun counted, float count) {
    const PhiRun run = closed(counted);
    if (!batch_.has_room_for(run)) flush();
    const Segment& segment = batch_.add(i_theta_d, run);
    copy_values(comparison_.reference, segment, batch_.r);
    const float* r = &batch_.r[0][segment.begin];
    float* weight = &batch_.weight[segment.begin];
    std::fill_n(weight, segment.size, 0.0F);
    for (int k = counted.first - run.first; k < counted.end - run.first; ++k) {
      weight[k] = r[k] >= 0.0F ? count : 0.0F;
    }
  }

  // The run with the mirror image of each of its entries, and what lies between.
  PhiRun closed(PhiRun run) const {
    const GridGeometry& angles = comparison_.angles;
    return {std::min(run.first, angles.mirror(run.end - 1)), std::max(run.end, angles.mirror(run.first) + 1)};
  }

  void flush() {
    if (batch_.empty()) return;
    batch_.pad();
    totals_.reciprocity += comparison_.candidate(batch_);
    metric_function()(batch_.job(), totals_.sums);
    for (std::size_t k = 0; k < batch_.padded(); ++k) {
      totals_.weight += batch_.weight[k];
      totals_.cells += batch_.weight[k] > 0.0F ? 1 : 0;
    }
    batch_.clear();
  }

  const Comparison& comparison_;
  int i_theta_h_;
  CellBatch batch_;
  Totals totals_;
};

// Rows are summed apart and added in order, so that the result does not depend on threads.
template <class CompareRow>
Totals over_rows(const Comparison& comparison, const CompareRow& compare_row) {
  std::vector<Totals> rows(static_cast<std::size_t>(comparison.reference.grid().n_theta_h));
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t i) {
    RowComparison row(comparison, static_cast<int>(i));
    compare_row(row, i);
    rows[i] = row.finish();
  });
  Totals total;
  for (const Totals& row : rows) total += row;
  return total;
}

Totals over_table(const Comparison& comparison) {
  return over_rows(comparison, [&](RowComparison& row, std::size_t) {
    for (int i_d = 0; i_d < comparison.reference.grid().n_theta_d; ++i_d) row.add_row(i_d);
  });
}

// below_80: only pixels below 80 deg in both angles.
Totals over_slice(const Comparison& comparison, const Slice& slice, bool below_80) {
  constexpr int kLimit = 80;
  // A stored cell that several pixels show is evaluated once.
  const Grid& grid = comparison.reference.grid();
  const auto n_theta_d = static_cast<std::size_t>(grid.n_theta_d);
  std::vector<float> counts(static_cast<std::size_t>(grid.n_theta_h) * n_theta_d);
  for (const SlicePixel& pixel : slice.pixels) {
    if (below_80 && (pixel.column >= kLimit || pixel.row >= kLimit)) continue;
    counts[static_cast<std::size_t>(pixel.i_theta_h) * n_theta_d +
           static_cast<std::size_t>(pixel.i_theta_d)] += 1.0F;
  }
  return over_rows(comparison, [&](RowComparison& row, std::size_t i_h) {
    for (int i_d = 0; i_d < grid.n_theta_d; ++i_d) {
      const float count = counts[i_h * n_theta_d + static_cast<std::size_t>(i_d)];
      if (count > 0.0F) row.add_cell(i_d, slice.i_phi_d, count);
    }
  });
}

Measures measures_of(const Totals& totals, const Totals& clipped) {
  Measures m;
  const double n = 3.0 * totals.weight;
  m.cells = totals.cells;
  if (n > 0.0) {
    m.log_ratio_pct = 100.0 * totals.sums.log_ratio / n;
    m.relative = totals.sums.relative / n;
    m.cube_root = std::sqrt(totals.sums.cube_root / n);
    m.srgb = std::sqrt(totals.sums.srgb / n);
    m.cosine_l2 = std::sqrt(totals.sums.cosine_l2 / n);
  }
  if (clipped.weight > 0.0) m.slice_pct = 100.0 * std::sqrt(clipped.sums.clipped / (3.0 * clipped.weight));
  return m;
}

Evaluation evaluate_candidate(const Candidate& candidate, const MeasuredTable& reference,
                              double max_theta_deg) {
  constexpr double kPhiDeg = 90.0;
  constexpr int kSliceSize = 90;
  const GridGeometry angles(reference.grid());
  const Comparison comparison = {reference, candidate, angles, lowest_observed_cosine(max_theta_deg)};
  const Totals table = over_table(comparison);
  const Slice slice = make_slice(reference, kPhiDeg, kSliceSize);
  Evaluation result;
  result.table = measures_of(table, table);
  result.slice = measures_of(over_slice(comparison, slice, false), over_slice(comparison, slice, true));
  if (table.weight > 0.0) result.reciprocity_gap_pct = 100.0 * table.reciprocity / (3.0 * table.weight);
  return result;
}

}  // namespace

Evaluation evaluate(const Material& material, const MeasuredTable& reference, double max_theta_deg) {
  return evaluate_candidate(material_candidate(material), reference, max_theta_deg);
}

Evaluation evaluate(const MeasuredTable& candidate, const MeasuredTable& reference, double max_theta_deg) {
  if (candidate.grid() != reference.grid()) {
    throw std::invalid_argument("the tables have different grids and cannot be compared cell by cell");
  }
  return evaluate_candidate(table_candidate(candidate), reference, max_theta_deg);
}

}  // namespace brdfit::fit
