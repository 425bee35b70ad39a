// Stratified samples and slices as observations.
#include "measured/sampling.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "measured/slice.h"

namespace brdfit {
namespace {

// Observed cells in an order that keeps neighbours together: theta_h rows, bands of theta_d, then phi_d. Only
// how many there are in each column of a band is kept: few of the cells are ever asked for.
class OrderedCells {
 public:
  // band: how many theta_d rows are taken together.
  OrderedCells(const MeasuredTable& table, const GridGeometry& geometry, double min_cosine, int band)
      : table_(table), geometry_(geometry), min_cosine_(min_cosine), band_(band) {
    rows_.resize(static_cast<std::size_t>(table.grid().n_theta_h));
    tbb::parallel_for(std::size_t{0}, rows_.size(), [&](std::size_t row) { count(static_cast<int>(row)); });
    std::size_t end = 0;
    for (Row& row : rows_) row.end = end += row.size;
  }

  std::size_t size() const { return rows_.back().end; }

  struct Cell {
    int i_theta_h, i_theta_d, i_phi_d;
  };
  // The cells at these places of the order, which ascend.
  std::vector<Cell> at(const std::vector<std::size_t>& places) const {
    const auto n_phi_d = static_cast<std::size_t>(table_.grid().n_phi_d);
    std::vector<Cell> result;
    result.reserve(places.size());
    std::size_t row = 0;
    std::size_t column = 0;  // of the row, counted over its bands
    std::size_t first = 0;   // place of the column's first cell
    for (const std::size_t k : places) {
      if (k >= rows_[row].end) {
        while (k >= rows_[row].end) ++row;
        column = 0;
        first = rows_[row].end - rows_[row].size;
      }
      while (k >= first + rows_[row].counts[column]) first += rows_[row].counts[column++];
      result.push_back(cell_of_column(static_cast<int>(row), static_cast<int>(column / n_phi_d) * band_,
                                      static_cast<int>(column % n_phi_d), k - first));
    }
    return result;
  }

 private:
  struct Row {
    std::vector<std::uint32_t> counts;  // of each column, band after band
    std::vector<PhiRun> runs;           // observed phi_d of each theta_d
    std::size_t size = 0;
    std::size_t end = 0;  // counting all rows before it
  };

  void count(int i_h) {
    const Grid& grid = table_.grid();
    Row& row = rows_[static_cast<std::size_t>(i_h)];
    const int bands = (grid.n_theta_d + band_ - 1) / band_;
    row.counts.resize(static_cast<std::size_t>(bands) * static_cast<std::size_t>(grid.n_phi_d));
    row.runs.reserve(static_cast<std::size_t>(grid.n_theta_d));
    for (int i_d = 0; i_d < grid.n_theta_d; ++i_d) {
      const PhiRun run = geometry_.observed(i_h, i_d, min_cosine_);
      row.runs.push_back(run);
      const float* f = table_.plane(0).data() + grid.index(i_h, i_d, 0);
      std::uint32_t* counts = row.counts.data() + static_cast<std::ptrdiff_t>(i_d / band_) * grid.n_phi_d;
      for (int i_p = run.first; i_p < run.end; ++i_p) counts[i_p] += f[i_p] >= 0.0F ? 1 : 0;
    }
    for (const std::uint32_t in_column : row.counts) row.size += in_column;
  }

  // The k-th observed cell of a column.
  Cell cell_of_column(int i_h, int first_d, int i_p, std::size_t k) const {
    const Row& row = rows_[static_cast<std::size_t>(i_h)];
    for (int i_d = first_d;; ++i_d) {
      const PhiRun& run = row.runs[static_cast<std::size_t>(i_d)];
      const bool observed =
          i_p >= run.first && i_p < run.end && table_.is_valid(table_.grid().index(i_h, i_d, i_p));
      if (observed && k-- == 0) return {i_h, i_d, i_p};
    }
  }

  const MeasuredTable& table_;
  const GridGeometry& geometry_;
  double min_cosine_;
  int band_;
  std::vector<Row> rows_;
};

// How many theta_d rows a stratum spans: it is about twice as long in phi_d, as the grid has twice the cells
// there.
int rows_per_stratum(const MeasuredTable& table, std::size_t cell_count) {
  const double per_stratum = static_cast<double>(table.valid_count()) /
                             static_cast<double>(std::clamp<std::size_t>(
                                 cell_count, 1, std::max<std::size_t>(table.valid_count(), 1)));
  return std::clamp(static_cast<int>(std::lround(std::sqrt(per_stratum / 2.0))), 1, table.grid().n_theta_d);
}

// How much a theta_h row counts in a slice, in pixels of the slice measures: the mean of how many of their
// columns show it, which is what fits are judged by, and of its width, which gives the narrow rows at the
// peak a say that the columns skip.
std::vector<double> slice_row_weights(const Grid& grid) {
  constexpr int kColumns = 90;
  std::vector<double> weights;
  const double n = grid.n_theta_h;
  for (int i = 0; i < grid.n_theta_h; ++i) weights.push_back(0.5 * kColumns * (2.0 * i + 1.0) / (n * n));
  for (int column = 0; column < kColumns; ++column) {
    weights[static_cast<std::size_t>(theta_h_row_of_column(grid, column, kColumns))] += 0.5;
  }
  return weights;
}

}  // namespace

void SampleSet::add(const CellGeometry& geometry, const Rgb& f, double weight) {
  cos_i_.push_back(geometry.cos_i);
  cos_o_.push_back(geometry.cos_o);
  sin_h_.push_back(geometry.sin_h);
  cos_h_.push_back(geometry.cos_h);
  cos_d_.push_back(geometry.cos_d);
  one_minus_cos_h_.push_back(geometry.one_minus_cos_h);
  one_minus_cos_d_.push_back(geometry.one_minus_cos_d);
  log_cos_h_.push_back(geometry.log_cos_h);
  log_cos_d_.push_back(geometry.log_cos_d);
  log_one_minus_cos_h_.push_back(geometry.log_one_minus_cos_h);
  log_one_minus_cos_d_.push_back(geometry.log_one_minus_cos_d);
  for (std::size_t c = 0; c < 3; ++c) f_[c].push_back(f[c]);
  weight_.push_back(weight);
}

void SampleSet::reserve(std::size_t count) {
  const std::size_t padded = (count + simd::kBlock - 1) / simd::kBlock * simd::kBlock;
  for (std::vector<double>* column :
       {&cos_i_, &cos_o_, &sin_h_, &cos_h_, &cos_d_, &one_minus_cos_h_, &one_minus_cos_d_, &log_cos_h_,
        &log_cos_d_, &log_one_minus_cos_h_, &log_one_minus_cos_d_, &f_[0], &f_[1], &f_[2], &weight_}) {
    column->reserve(padded);
  }
}

void SampleSet::finish() {
  size_ = cos_i_.size();
  double sum = 0.0;
  for (const double w : weight_) sum += w;
  for (double& w : weight_) w /= sum;
  // Padding looks along the normal, where every model is defined.
  const CellGeometry padding = cell_geometry({0.0, 0.0, 0.0});
  while (cos_i_.size() % simd::kBlock != 0) add(padding, {0.0, 0.0, 0.0}, 0.0);
}

simd::GeometryColumns SampleSet::geometry() const {
  return {cos_i_.data(),
          cos_o_.data(),
          sin_h_.data(),
          cos_h_.data(),
          cos_d_.data(),
          one_minus_cos_h_.data(),
          one_minus_cos_d_.data(),
          log_cos_h_.data(),
          log_cos_d_.data(),
          log_one_minus_cos_h_.data(),
          log_one_minus_cos_d_.data()};
}

bool SampleSet::has_two_orders() const {
  for (std::size_t k = 0; k < size_; ++k) {
    if (std::abs(cos_i_[k] - cos_o_[k]) > 1e-12) return true;
  }
  return false;
}

CellGeometry SampleSet::cell(std::size_t k) const {
  return {cos_i_[k],
          cos_o_[k],
          sin_h_[k],
          cos_h_[k],
          cos_d_[k],
          one_minus_cos_h_[k],
          one_minus_cos_d_[k],
          log_cos_h_[k],
          log_cos_d_[k],
          log_one_minus_cos_h_[k],
          log_one_minus_cos_d_[k]};
}

SampleSet SampleSet::thinned(std::size_t stride) const {
  SampleSet result;
  result.reserve(size_ / stride + 1);
  for (std::size_t k = 0; k < size_; k += stride) {
    result.add(cell(k), {f_[0][k], f_[1][k], f_[2][k]}, weight_[k]);
  }
  result.finish();
  return result;
}

SampleSet SampleSet::subset(std::span<const std::size_t> indices) const {
  SampleSet result;
  result.reserve(indices.size());
  for (const std::size_t k : indices) result.add(cell(k), {f_[0][k], f_[1][k], f_[2][k]}, weight_[k]);
  result.finish();
  return result;
}

SampleSet sample_table(const MeasuredTable& table, std::size_t cell_count, std::uint64_t seed,
                       const SamplingOptions& options, std::vector<std::size_t>* observed) {
  const GridGeometry geometry(table.grid());
  const OrderedCells cells(table, geometry, lowest_observed_cosine(options.max_theta_deg),
                           rows_per_stratum(table, cell_count));
  const std::size_t count = std::min(cell_count, cells.size());
  std::vector<std::size_t> ends = {0};  // of the strata
  std::vector<std::size_t> drawn;
  std::mt19937_64 random(seed);
  for (std::size_t stratum = 0; stratum < count; ++stratum) {
    const std::size_t first = ends.back();
    ends.push_back((stratum + 1) * cells.size() / count);
    drawn.push_back(first + random() % (ends.back() - first));
  }
  const std::vector<OrderedCells::Cell> places = cells.at(drawn);
  // Scattered over the table: reads that wait for nothing else overlap.
  std::vector<Rgb> f;
  f.reserve(count);
  for (const auto& [i_h, i_d, i_p] : places) f.push_back(table.value(table.grid().index(i_h, i_d, i_p)));

  SampleSet samples;
  samples.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto& [i_h, i_d, i_p] = places[k];
    samples.add(geometry.cell(i_h, i_d, i_p), f[k], static_cast<double>(ends[k + 1] - ends[k]));
    if (observed != nullptr) observed->push_back(table.grid().index(i_h, i_d, i_p));
  }
  samples.finish();
  return samples;
}

SampleSet sample_slices(const MeasuredTable& table, std::span<const double> phi_d_deg,
                        const SamplingOptions& options, std::vector<std::size_t>* observed) {
  SampleSet samples;
  const Grid& grid = table.grid();
  const GridGeometry angles(grid);
  const double min_cosine = lowest_observed_cosine(options.max_theta_deg);
  const std::vector<double> row_weights = slice_row_weights(grid);
  for (const double phi_d : phi_d_deg) {
    const int i_p = phi_d_index(grid, phi_d);
    for (int i_h = 0; i_h < grid.n_theta_h; ++i_h) {
      const double weight = row_weights[static_cast<std::size_t>(i_h)];
      for (int i_d = 0; i_d < grid.n_theta_d; ++i_d) {
        const std::size_t cell = grid.index(i_h, i_d, i_p);
        if (!table.is_valid(cell)) continue;
        const CellGeometry geometry = angles.cell(i_h, i_d, i_p);
        if (std::min(geometry.cos_i, geometry.cos_o) < min_cosine) continue;
        samples.add(geometry, table.value(cell), weight);
        if (observed != nullptr) observed->push_back(cell);
      }
    }
  }
  samples.finish();
  return samples;
}

}  // namespace brdfit
