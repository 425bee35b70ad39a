// Error measures over slices and tables.
#include "fit/metrics.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "brdf/models.h"
#include "brdf/simd/dispatch.h"
#include "fit/line_batch.h"
#include "fit/metric_sums.h"
#include "measured/grid_geometry.h"
#include "measured/slice.h"

namespace brdfit::simd {

BRDFIT_DECLARE_SIMD(void sum_metrics(const fit::MetricJob&, fit::MetricSums&))
BRDFIT_DECLARE_SIMD(double sum_order_gap(const fit::MetricJob&))

}  // namespace brdfit::simd

namespace brdfit::fit {

MetricFunction metric_function(simd::Isa isa) {
  using namespace simd;
  return BRDFIT_PICK(isa, sum_metrics);
}

OrderGapFunction order_gap_function(simd::Isa isa) {
  using namespace simd;
  return BRDFIT_PICK(isa, sum_order_gap);
}

namespace {

// What one worker adds up.
struct Totals {
  MetricSums sums;
  double reciprocity = 0.0;
  std::size_t cells = 0;

  Totals& operator+=(const Totals& other) {
    sums += other.sums;
    reciprocity += other.reciprocity;
    cells += other.cells;
    return *this;
  }
};

// What is compared with a reference.
class Candidate {
 public:
  Candidate() = default;
  Candidate(const Candidate&) = delete;
  Candidate& operator=(const Candidate&) = delete;
  virtual ~Candidate() = default;

  // Adds up the cells of the batch's lines, which begin with first_theta_d.
  virtual void compare(int first_theta_d, LineBatch& batch, Totals& totals) const = 0;

  // After that: f of a cell of the table, which is an entry of a line; false where it has none.
  virtual bool value(const LineBatch& batch, std::size_t line, std::size_t at, std::size_t cell,
                     Rgb& f) const = 0;
};

class MaterialCandidate : public Candidate {
 public:
  explicit MaterialCandidate(const Material& material)
      : coefficients_(simd::coefficients_of(material)), is_reciprocal_(brdfit::is_reciprocal(material)) {}

  void compare(int, LineBatch& batch, Totals& totals) const override {
    double* const f[3] = {batch.f[0].data(), batch.f[1].data(), batch.f[2].data()};
    double* const swapped[3] = {batch.f_swapped[0].data(), batch.f_swapped[1].data(),
                                batch.f_swapped[2].data()};
    evaluate_(coefficients_, batch.columns, f, is_reciprocal_ ? nullptr : swapped);
    for (std::size_t line = 0; line < simd::kLines; ++line) {
      if (!batch.has(line)) continue;
      if (!is_reciprocal_) {
        totals.reciprocity += order_gap_(batch.job(line));
        fold_orders(batch, line);
      }
      sum_(batch.job(line), totals.sums);
    }
  }

  bool value(const LineBatch& batch, std::size_t line, std::size_t at, std::size_t, Rgb& f) const override {
    for (std::size_t c = 0; c < 3; ++c) f[c] = batch.f[c][line * batch.columns.stride + at];
    return true;
  }

 private:
  // f becomes the mean of both orders.
  static void fold_orders(LineBatch& batch, std::size_t line) {
    const std::size_t begin = line * batch.columns.stride;
    for (std::size_t c = 0; c < 3; ++c) {
      double* const forth = &batch.f[c][begin];
      const double* const back = &batch.f_swapped[c][begin];
      for (std::size_t k = 0; k < batch.columns.count[line]; ++k) forth[k] = 0.5 * (forth[k] + back[k]);
    }
  }

  simd::Coefficients coefficients_;
  bool is_reciprocal_;
  simd::EvalLines evaluate_ = simd::eval_lines(simd::best_isa());
  MetricFunction sum_ = metric_function(simd::best_isa());
  OrderGapFunction order_gap_ = order_gap_function(simd::best_isa());
};

// Its two sides differ: they are compared one after the other.
class TableCandidate : public Candidate {
 public:
  explicit TableCandidate(const MeasuredTable& table) : table_(table) {}

  void compare(int first_theta_d, LineBatch& batch, Totals& totals) const override {
    std::vector<float> weight(batch.columns.stride);
    for (std::size_t line = 0; line < simd::kLines; ++line) {
      for (std::size_t side = 0; batch.has(line) && side < 2; ++side) {
        MetricJob job = batch.job(line);
        job.side_count = 1;
        job.sides[0] = batch.sides[line][side];
        job.sides[0].weight = weight.data();
        const std::size_t begin = line * batch.columns.stride;
        const std::array<double*, 3> f = {&batch.f[0][begin], &batch.f[1][begin], &batch.f[2][begin]};
        for (double* const channel : f) std::fill_n(channel, job.count, -1.0);
        batch.copy_values(table_, line, first_theta_d + static_cast<int>(line), side, f);
        for (std::size_t k = 0; k < job.count; ++k) {
          weight[k] = f[0][k] >= 0.0 ? 1.0F : 0.0F;
          for (double* const channel : f) channel[k] = std::max(channel[k], 0.0);
        }
        sum_(job, totals.sums);
      }
    }
  }

  bool value(const LineBatch&, std::size_t, std::size_t, std::size_t cell, Rgb& f) const override {
    if (!table_.is_valid(cell)) return false;
    f = table_.value(cell);
    return true;
  }

 private:
  const MeasuredTable& table_;
  MetricFunction sum_ = metric_function(simd::best_isa());
};

struct AllTotals {
  Totals table;
  Totals slice;
  Totals slice_below_80;  // in both angles

  AllTotals& operator+=(const AllTotals& other) {
    table += other.table;
    slice += other.slice;
    slice_below_80 += other.slice_below_80;
    return *this;
  }
};

// How many pixels of the slice show each of its cells.
struct SliceCounts {
  int i_phi_d;
  std::vector<float> all;  // by theta_h and theta_d
  std::vector<float> below_80;

  explicit SliceCounts(const MeasuredTable& reference) {
    constexpr double kPhiDeg = 90.0;
    constexpr int kSize = 90;
    constexpr int kLimit = 80;
    const Grid& grid = reference.grid();
    const Slice slice = make_slice(reference, kPhiDeg, kSize);
    i_phi_d = slice.i_phi_d;
    const auto n_theta_d = static_cast<std::size_t>(grid.n_theta_d);
    all.resize(static_cast<std::size_t>(grid.n_theta_h) * n_theta_d);
    below_80.resize(all.size());
    for (const SlicePixel& pixel : slice.pixels) {
      const std::size_t at =
          static_cast<std::size_t>(pixel.i_theta_h) * n_theta_d + static_cast<std::size_t>(pixel.i_theta_d);
      all[at] += 1.0F;
      if (pixel.column < kLimit && pixel.row < kLimit) below_80[at] += 1.0F;
    }
  }
};

// The slice's cells of one theta_h row.
class SliceRow {
 public:
  explicit SliceRow(std::size_t capacity) {
    resize(f_, padded(capacity));
    resize(r_, padded(capacity));
    cos_i_.resize(padded(capacity), 1.0);
    all_.resize(padded(capacity));
    below_80_.resize(padded(capacity));
  }

  // all, below_80: how many pixels show the cell.
  void add(const Rgb& f, const Rgb& r, double cos_i, float all, float below_80) {
    for (std::size_t c = 0; c < 3; ++c) {
      f_[c][size_] = f[c];
      r_[c][size_] = static_cast<float>(r[c]);
    }
    cos_i_[size_] = cos_i;
    all_[size_] = all;
    below_80_[size_] = below_80;
    ++size_;
  }

  void finish(AllTotals& totals) const {
    static const MetricFunction sum = metric_function(simd::best_isa());
    sum(job(all_), totals.slice.sums);
    sum(job(below_80_), totals.slice_below_80.sums);
    totals.slice.cells = size_;
  }

 private:
  MetricJob job(const std::vector<float>& weight) const {
    MetricJob job;
    job.count = padded(size_);
    for (std::size_t c = 0; c < 3; ++c) job.f[c] = f_[c].data();
    job.sides[0] = {{r_[0].data(), r_[1].data(), r_[2].data()}, 1, 0, size_, cos_i_.data(), weight.data()};
    return job;
  }

  std::size_t size_ = 0;
  Channels<double> f_;
  Channels<float> r_;
  std::vector<double> cos_i_;
  std::vector<float> all_;
  std::vector<float> below_80_;
};

// What is compared: valid in the reference and in the candidate, above the horizon, within max_theta.
struct Comparison {
  const MeasuredTable& reference;
  const Candidate& candidate;
  const GridGeometry& angles;
  const SliceCounts& slice;
  double min_cosine;
};

// Compares the cells of one theta_h row.
class RowComparison {
 public:
  RowComparison(const Comparison& comparison, int i_theta_h)
      : comparison_(comparison),
        i_theta_h_(i_theta_h),
        batch_(comparison.reference, comparison.angles, i_theta_h),
        slice_(static_cast<std::size_t>(comparison.reference.grid().n_theta_d)) {}

  AllTotals run() {
    for (int i_d = 0; i_d < comparison_.reference.grid().n_theta_d; i_d += static_cast<int>(simd::kLines)) {
      batch_.fill(i_d, comparison_.min_cosine);
      comparison_.candidate.compare(i_d, batch_, totals_.table);
      for (std::size_t line = 0; line < simd::kLines; ++line) {
        if (batch_.has(line)) add_to_slice(line, i_d + static_cast<int>(line));
      }
    }
    slice_.finish(totals_);
    // Every cell counts once.
    totals_.table.cells = static_cast<std::size_t>(totals_.table.sums.weight);
    return totals_;
  }

 private:
  void add_to_slice(std::size_t line, int i_theta_d) {
    const SliceCounts& slice = comparison_.slice;
    const GridGeometry& angles = comparison_.angles;
    const MeasuredTable& reference = comparison_.reference;
    const std::size_t pixel =
        static_cast<std::size_t>(i_theta_h_) * static_cast<std::size_t>(reference.grid().n_theta_d) +
        static_cast<std::size_t>(i_theta_d);
    const std::size_t side = slice.i_phi_d <= angles.middle() ? 0 : 1;
    const int k = (side == 0 ? slice.i_phi_d : angles.mirror(slice.i_phi_d)) - batch_.halves[line].first;
    const std::size_t cell = reference.grid().index(i_theta_h_, i_theta_d, slice.i_phi_d);
    Rgb f;
    if (k < 0 || slice.all[pixel] == 0.0F || !reference.is_valid(cell)) return;
    if (!comparison_.candidate.value(batch_, line, static_cast<std::size_t>(k), cell, f)) return;
    slice_.add(f, reference.value(cell), batch_.sides[line][side].cos_i[k], slice.all[pixel],
               slice.below_80[pixel]);
  }

  const Comparison& comparison_;
  int i_theta_h_;
  LineBatch batch_;
  SliceRow slice_;
  AllTotals totals_;
};

// Rows are summed apart and added in order, so that the result does not depend on threads.
AllTotals compare(const Comparison& comparison) {
  std::vector<AllTotals> rows(static_cast<std::size_t>(comparison.reference.grid().n_theta_h));
  tbb::parallel_for(std::size_t{0}, rows.size(),
                    [&](std::size_t i) { rows[i] = RowComparison(comparison, static_cast<int>(i)).run(); });
  AllTotals total;
  for (const AllTotals& row : rows) total += row;
  return total;
}

Measures measures_of(const Totals& totals, const Totals& clipped) {
  Measures m;
  const double n = 3.0 * totals.sums.weight;
  m.cells = totals.cells;
  if (n > 0.0) {
    m.log_ratio_pct = 100.0 * totals.sums.log_ratio / n;
    m.relative = totals.sums.relative / n;
    m.cube_root = std::sqrt(totals.sums.cube_root / n);
    m.srgb = std::sqrt(totals.sums.srgb / n);
    m.cosine_l2 = std::sqrt(totals.sums.cosine_l2 / n);
  }
  if (clipped.sums.weight > 0.0)
    m.slice_pct = 100.0 * std::sqrt(clipped.sums.clipped / (3.0 * clipped.sums.weight));
  return m;
}

Evaluation evaluate_candidate(const Candidate& candidate, const MeasuredTable& reference,
                              double max_theta_deg) {
  const GridGeometry angles(reference.grid());
  const SliceCounts slice(reference);
  const AllTotals totals =
      compare({reference, candidate, angles, slice, lowest_observed_cosine(max_theta_deg)});
  Evaluation result;
  result.table = measures_of(totals.table, totals.table);
  result.slice = measures_of(totals.slice, totals.slice_below_80);
  if (totals.table.sums.weight > 0.0) {
    result.reciprocity_gap_pct = 100.0 * totals.table.reciprocity / (3.0 * totals.table.sums.weight);
  }
  return result;
}

}  // namespace

Evaluation evaluate(const Material& material, const MeasuredTable& reference, double max_theta_deg) {
  return evaluate_candidate(MaterialCandidate(material), reference, max_theta_deg);
}

Evaluation evaluate(const MeasuredTable& candidate, const MeasuredTable& reference, double max_theta_deg) {
  if (candidate.grid() != reference.grid()) {
    throw std::invalid_argument("the tables have different grids and cannot be compared cell by cell");
  }
  return evaluate_candidate(TableCandidate(candidate), reference, max_theta_deg);
}

}  // namespace brdfit::fit
