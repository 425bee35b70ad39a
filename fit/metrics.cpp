// Error measures over slices and tables.
#include "fit/metrics.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "brdf/models.h"
#include "brdf/simd/dispatch.h"
#include "fit/metric_sums.h"
#include "measured/sampling.h"
#include "measured/slice.h"

namespace brdfit::simd {

BRDFIT_DECLARE_SIMD(void sum_metrics(const fit::MetricJob&, fit::MetricSums&))
BRDFIT_DECLARE_SIMD(double sum_log_ratio(const fit::MetricJob&))

}  // namespace brdfit::simd

namespace brdfit::fit {
namespace {

MetricFunction metric_function() {
  using namespace simd;
  return BRDFIT_PICK(best_isa(), sum_metrics);
}

LogRatioFunction log_ratio_function() {
  using namespace simd;
  return BRDFIT_PICK(best_isa(), sum_log_ratio);
}

// Cells side by side, as many as fit the cache; padded with weight 0.
struct CellBatch {
  static constexpr std::size_t capacity = simd::kBlock * 8;
  using Column = std::array<double, capacity>;

  std::size_t size = 0;
  std::array<Column, 11> geometry;  // in the order of simd::GeometryColumns
  std::array<Column, 3> f;
  std::array<Column, 3> f_swapped;  // for (wo, wi); only for materials that are not reciprocal
  std::array<Column, 3> r;
  Column weight;
  std::array<std::size_t, capacity> cell;

  bool full() const { return size == capacity; }
  std::size_t padded() const { return (size + simd::kBlock - 1) / simd::kBlock * simd::kBlock; }

  void add(const std::array<double, 11>& columns, const Rgb& reference, double count, std::size_t index) {
    for (std::size_t k = 0; k < columns.size(); ++k) geometry[k][size] = columns[k];
    for (std::size_t c = 0; c < 3; ++c) r[c][size] = reference[c];
    weight[size] = count;
    cell[size] = index;
    ++size;
  }

  // Repeats the last cell with weight 0.
  void pad() {
    for (std::size_t k = size; k < padded(); ++k) {
      for (Column& column : geometry) column[k] = column[size - 1];
      for (std::size_t c = 0; c < 3; ++c) r[c][k] = r[c][size - 1];
      weight[k] = 0.0;
      cell[k] = cell[size - 1];
    }
  }

  simd::GeometryColumns columns() const {
    return {geometry[0].data(), geometry[1].data(), geometry[2].data(), geometry[3].data(),
            geometry[4].data(), geometry[5].data(), geometry[6].data(), geometry[7].data(),
            geometry[8].data(), geometry[9].data(), geometry[10].data()};
  }
};

// Puts f of a batch's cells into its columns, and tells whether f_swapped holds the other order.
using Candidate = std::function<bool(CellBatch&)>;

Candidate material_candidate(const Material& material) {
  return [coefficients = simd::coefficients_of(material), reciprocal = is_reciprocal(material),
          evaluate = simd::eval_columns(simd::best_isa())](CellBatch& batch) {
    const auto run = [&](const simd::GeometryColumns& columns, std::array<CellBatch::Column, 3>& to) {
      double* const out[3] = {to[0].data(), to[1].data(), to[2].data()};
      evaluate(coefficients, columns, batch.padded(), out);
      for (CellBatch::Column& channel : to) {
        for (std::size_t k = 0; k < batch.padded(); ++k) channel[k] /= columns.cos_i[k];
      }
    };
    simd::GeometryColumns columns = batch.columns();
    run(columns, batch.f);
    if (reciprocal) return false;
    std::swap(columns.cos_i, columns.cos_o);
    run(columns, batch.f_swapped);
    return true;
  };
}

Candidate table_candidate(const MeasuredTable& table) {
  return [&table](CellBatch& batch) {
    for (std::size_t k = 0; k < batch.padded(); ++k) {
      const Rgb value = table.value(batch.cell[k]);
      for (std::size_t c = 0; c < 3; ++c) batch.f[c][k] = value[c];
    }
    return false;
  };
}

// What one worker adds up.
struct Totals {
  MetricSums sums;
  double reciprocity = 0.0;
  double weight = 0.0;
  std::size_t cells = 0;

  Totals& operator+=(const Totals& other) {
    sums.log_ratio += other.sums.log_ratio;
    sums.relative += other.sums.relative;
    sums.cube_root += other.sums.cube_root;
    sums.srgb += other.sums.srgb;
    sums.cosine_l2 += other.sums.cosine_l2;
    sums.clipped += other.sums.clipped;
    reciprocity += other.reciprocity;
    weight += other.weight;
    cells += other.cells;
    return *this;
  }
};

MetricJob job_of(const CellBatch& batch, const std::array<CellBatch::Column, 3>& f,
                 const std::array<CellBatch::Column, 3>& r) {
  MetricJob job;
  for (std::size_t c = 0; c < 3; ++c) {
    job.f[c] = f[c].data();
    job.r[c] = r[c].data();
  }
  job.cos_i = batch.geometry[0].data();
  job.weight = batch.weight.data();
  job.count = batch.padded();
  return job;
}

void flush(CellBatch& batch, const Candidate& candidate, Totals& totals) {
  if (batch.size == 0) return;
  batch.pad();
  if (candidate(batch)) {
    totals.reciprocity += log_ratio_function()(job_of(batch, batch.f, batch.f_swapped));
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < batch.padded(); ++k) {
        batch.f[c][k] = 0.5 * (batch.f[c][k] + batch.f_swapped[c][k]);
      }
    }
  }
  metric_function()(job_of(batch, batch.f, batch.r), totals.sums);
  for (std::size_t k = 0; k < batch.size; ++k) totals.weight += batch.weight[k];
  totals.cells += batch.size;
  batch.size = 0;
}

// Cosines and logarithms of every stored angle of a grid.
class GridColumns {
 public:
  explicit GridColumns(const Grid& grid) : grid_(grid) {
    for (int i = 0; i < grid.n_theta_h; ++i) h_.push_back(angle(grid.theta_h_rad(i)));
    for (int i = 0; i < grid.n_theta_d; ++i) d_.push_back(angle(grid.theta_d_rad(i)));
    for (int i = 0; i < grid.n_phi_d; ++i) cos_phi_.push_back(std::cos(grid.phi_d_rad(i)));
  }

  // In the order of simd::GeometryColumns.
  std::array<double, 11> at(int i_h, int i_d, int i_p) const {
    const Angle& h = h_[static_cast<std::size_t>(i_h)];
    const Angle& d = d_[static_cast<std::size_t>(i_d)];
    const double along = d.cosine * h.cosine;
    const double across = d.sine * h.sine * cos_phi_[static_cast<std::size_t>(i_p)];
    return {along - across, along + across, h.sine,       h.cosine,        d.cosine,       h.one_minus,
            d.one_minus,    h.log_cosine,   d.log_cosine, h.log_one_minus, d.log_one_minus};
  }

 private:
  struct Angle {
    double sine, cosine, one_minus, log_cosine, log_one_minus;
  };
  static Angle angle(double radians) {
    const double half = std::sin(0.5 * radians);
    const double one_minus = 2.0 * half * half;
    const double cosine = std::cos(radians);
    return {std::sin(radians), cosine, one_minus, kernel::log_or_zero(cosine),
            kernel::log_or_zero(one_minus)};
  }

  const Grid& grid_;
  std::vector<Angle> h_;
  std::vector<Angle> d_;
  std::vector<double> cos_phi_;
};

// What is compared: valid in the reference and in the candidate, above the horizon, within max_theta.
struct Comparison {
  const MeasuredTable& reference;
  const MeasuredTable* other;  // a candidate table; null for materials
  const GridColumns& columns;
  double min_cosine;

  void add(CellBatch& batch, const Candidate& candidate, Totals& totals, int i_h, int i_d, int i_p,
           double count) const {
    const std::size_t cell = reference.grid().index(i_h, i_d, i_p);
    if (!reference.is_valid(cell) || (other != nullptr && !other->is_valid(cell))) return;
    const std::array<double, 11> geometry = columns.at(i_h, i_d, i_p);
    if (std::min(geometry[0], geometry[1]) < min_cosine) return;
    batch.add(geometry, reference.value(cell), count, cell);
    if (batch.full()) flush(batch, candidate, totals);
  }
};

Totals over_table(const Comparison& comparison, const Candidate& candidate) {
  const Grid& grid = comparison.reference.grid();
  // Rows are summed apart and added in order, so that the result does not depend on threads.
  std::vector<Totals> rows(static_cast<std::size_t>(grid.n_theta_h));
  tbb::parallel_for(0, grid.n_theta_h, [&](int i_h) {
    Totals& totals = rows[static_cast<std::size_t>(i_h)];
    auto batch = std::make_unique<CellBatch>();
    for (int i_d = 0; i_d < grid.n_theta_d; ++i_d) {
      for (int i_p = 0; i_p < grid.n_phi_d; ++i_p)
        comparison.add(*batch, candidate, totals, i_h, i_d, i_p, 1.0);
    }
    flush(*batch, candidate, totals);
  });
  Totals total;
  for (const Totals& row : rows) total += row;
  return total;
}

// below_80: only pixels below 80 deg in both angles.
Totals over_slice(const Comparison& comparison, const Candidate& candidate, bool below_80) {
  constexpr int kSize = 90;
  constexpr int kLimit = 80;
  const Slice slice = make_slice(comparison.reference, 90.0, kSize);
  // A stored cell that several pixels show is evaluated once.
  std::map<std::pair<int, int>, double> pixels;
  for (const SlicePixel& pixel : slice.pixels) {
    if (below_80 && (pixel.column >= kLimit || pixel.row >= kLimit)) continue;
    pixels[{pixel.i_theta_h, pixel.i_theta_d}] += 1.0;
  }
  Totals totals;
  auto batch = std::make_unique<CellBatch>();
  for (const auto& [at, count] : pixels) {
    comparison.add(*batch, candidate, totals, at.first, at.second, slice.i_phi_d, count);
  }
  flush(*batch, candidate, totals);
  return totals;
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

Evaluation evaluate_candidate(const MeasuredTable* other, const Candidate& candidate,
                              const MeasuredTable& reference, double max_theta_deg) {
  const GridColumns columns(reference.grid());
  const double limit = std::cos(std::min(max_theta_deg, 90.0) * std::numbers::pi / 180.0);
  const Comparison comparison = {reference, other, columns, std::max(limit - 1e-12, 1e-9)};
  const Totals table = over_table(comparison, candidate);
  Evaluation result;
  result.table = measures_of(table, table);
  result.slice =
      measures_of(over_slice(comparison, candidate, false), over_slice(comparison, candidate, true));
  if (table.weight > 0.0) result.reciprocity_gap_pct = 100.0 * table.reciprocity / (3.0 * table.weight);
  return result;
}

}  // namespace

Evaluation evaluate(const Material& material, const MeasuredTable& reference, double max_theta_deg) {
  return evaluate_candidate(nullptr, material_candidate(material), reference, max_theta_deg);
}

Evaluation evaluate(const MeasuredTable& candidate, const MeasuredTable& reference, double max_theta_deg) {
  if (candidate.grid() != reference.grid()) {
    throw std::invalid_argument("the tables have different grids and cannot be compared cell by cell");
  }
  return evaluate_candidate(&candidate, table_candidate(candidate), reference, max_theta_deg);
}

}  // namespace brdfit::fit
