// Stratified samples and slices as observations.
#include "measured/sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "brdf/kernel/math.h"
#include "measured/slice.h"

namespace brdfit {
namespace {

double lowest_cosine(const SamplingOptions& options) {
  // Just above the horizon counts as below it: f has no meaning there.
  const double limit = std::cos(std::min(options.max_theta_deg, 90.0) * std::numbers::pi / 180.0);
  return std::max(limit - 1e-12, 1e-9);
}

bool is_observed(const CellGeometry& geometry, double min_cosine) {
  return geometry.cos_i >= min_cosine && geometry.cos_o >= min_cosine;
}

void add_cell(SampleSet& samples, const CellGeometry& geometry, const Rgb& f, double weight,
              bool both_orders) {
  if (!both_orders || std::abs(geometry.cos_i - geometry.cos_o) < 1e-12) {
    samples.add(geometry, f, weight);
    return;
  }
  CellGeometry swapped = geometry;
  std::swap(swapped.cos_i, swapped.cos_o);
  samples.add(geometry, f, 0.5 * weight);
  samples.add(swapped, f, 0.5 * weight);
}

// Sines and cosines of every stored angle, so that walking a table needs no trigonometry.
struct GridAngles {
  std::vector<double> cos_h, sin_h, cos_d, sin_d, cos_phi;

  explicit GridAngles(const Grid& grid) {
    for (int i = 0; i < grid.n_theta_h; ++i) {
      cos_h.push_back(std::cos(grid.theta_h_rad(i)));
      sin_h.push_back(std::sin(grid.theta_h_rad(i)));
    }
    for (int i = 0; i < grid.n_theta_d; ++i) {
      cos_d.push_back(std::cos(grid.theta_d_rad(i)));
      sin_d.push_back(std::sin(grid.theta_d_rad(i)));
    }
    for (int i = 0; i < grid.n_phi_d; ++i) cos_phi.push_back(std::cos(grid.phi_d_rad(i)));
  }
};

// Observed cells in an order that keeps neighbours together: theta_h rows, bands of theta_d, then phi_d.
std::vector<std::size_t> ordered_cells(const MeasuredTable& table, std::size_t cell_count,
                                       double min_cosine) {
  const Grid& grid = table.grid();
  const GridAngles angles(grid);
  const double per_stratum = static_cast<double>(table.valid_count()) / static_cast<double>(cell_count);
  // A stratum is about twice as long in phi_d as in theta_d, as the grid has twice the cells there.
  const int band = std::clamp(static_cast<int>(std::lround(std::sqrt(per_stratum / 2.0))), 1, grid.n_theta_d);
  std::vector<std::size_t> cells;
  cells.reserve(table.valid_count());
  for (int i_h = 0; i_h < grid.n_theta_h; ++i_h) {
    const auto h = static_cast<std::size_t>(i_h);
    for (int first_d = 0; first_d < grid.n_theta_d; first_d += band) {
      const int end_d = std::min(first_d + band, grid.n_theta_d);
      for (int i_p = 0; i_p < grid.n_phi_d; ++i_p) {
        for (int i_d = first_d; i_d < end_d; ++i_d) {
          const std::size_t cell = grid.index(i_h, i_d, i_p);
          if (!table.is_valid(cell)) continue;
          const auto d = static_cast<std::size_t>(i_d);
          const double along = angles.cos_d[d] * angles.cos_h[h];
          const double across =
              angles.sin_d[d] * angles.sin_h[h] * angles.cos_phi[static_cast<std::size_t>(i_p)];
          if (along - std::abs(across) < min_cosine) continue;
          cells.push_back(cell);
        }
      }
    }
  }
  return cells;
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
    const double theta_h_rad = (column + 0.5) / kColumns * std::numbers::pi / 2;
    weights[static_cast<std::size_t>(grid.row_of_theta_h(theta_h_rad))] += 0.5;
  }
  return weights;
}

}  // namespace

CellGeometry cell_geometry(const HalfDiff& angles) {
  const double sin_h = std::sin(angles.theta_h_rad);
  const double cos_h = std::cos(angles.theta_h_rad);
  const double cos_d = std::cos(angles.theta_d_rad);
  const double along = cos_d * cos_h;
  const double across = std::sin(angles.theta_d_rad) * std::cos(angles.phi_d_rad) * sin_h;
  const double half_h = std::sin(0.5 * angles.theta_h_rad);
  const double half_d = std::sin(0.5 * angles.theta_d_rad);
  return {along - across, along + across, sin_h, cos_h, cos_d, 2.0 * half_h * half_h, 2.0 * half_d * half_d};
}

void SampleSet::add(const CellGeometry& geometry, const Rgb& f, double weight) {
  cos_i_.push_back(geometry.cos_i);
  cos_o_.push_back(geometry.cos_o);
  sin_h_.push_back(geometry.sin_h);
  cos_h_.push_back(geometry.cos_h);
  cos_d_.push_back(geometry.cos_d);
  one_minus_cos_h_.push_back(geometry.one_minus_cos_h);
  one_minus_cos_d_.push_back(geometry.one_minus_cos_d);
  for (std::size_t c = 0; c < 3; ++c) f_[c].push_back(f[c]);
  weight_.push_back(weight);
}

void SampleSet::finish() {
  size_ = cos_i_.size();
  double sum = 0.0;
  for (const double w : weight_) sum += w;
  for (double& w : weight_) w /= sum;
  // Padding looks along the normal, where every model is defined.
  const CellGeometry padding = {1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0};
  while (cos_i_.size() % simd::kBlock != 0) add(padding, {0.0, 0.0, 0.0}, 0.0);
  const auto logs = [](const std::vector<double>& from, std::vector<double>& to) {
    to.resize(from.size());
    std::ranges::transform(from, to.begin(), [](double x) { return kernel::log_or_zero(x); });
  };
  logs(cos_h_, log_cos_h_);
  logs(cos_d_, log_cos_d_);
  logs(one_minus_cos_h_, log_one_minus_cos_h_);
  logs(one_minus_cos_d_, log_one_minus_cos_d_);
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

simd::GeometryColumns SampleSet::swapped_geometry() const {
  simd::GeometryColumns columns = geometry();
  std::swap(columns.cos_i, columns.cos_o);
  return columns;
}

SampleSet SampleSet::thinned(std::size_t stride) const {
  SampleSet result;
  for (std::size_t k = 0; k < size_; k += stride) {
    result.add(
        {cos_i_[k], cos_o_[k], sin_h_[k], cos_h_[k], cos_d_[k], one_minus_cos_h_[k], one_minus_cos_d_[k]},
        {f_[0][k], f_[1][k], f_[2][k]}, weight_[k]);
  }
  result.finish();
  return result;
}

SampleSet sample_table(const MeasuredTable& table, std::size_t cell_count, std::uint64_t seed,
                       const SamplingOptions& options) {
  SampleSet samples;
  const Grid& grid = table.grid();
  const std::vector<std::size_t> cells = ordered_cells(
      table, std::clamp<std::size_t>(cell_count, 1, std::max<std::size_t>(table.valid_count(), 1)),
      lowest_cosine(options));
  const std::size_t count = std::min(cell_count, cells.size());
  std::mt19937_64 random(seed);
  for (std::size_t stratum = 0; stratum < count; ++stratum) {
    const std::size_t first = stratum * cells.size() / count;
    const std::size_t end = (stratum + 1) * cells.size() / count;
    const std::size_t cell = cells[first + random() % (end - first)];
    add_cell(samples, cell_geometry(grid.angles_of(cell)), table.value(cell),
             static_cast<double>(end - first), options.both_orders);
  }
  samples.finish();
  return samples;
}

SampleSet sample_slices(const MeasuredTable& table, std::span<const double> phi_d_deg,
                        const SamplingOptions& options) {
  SampleSet samples;
  const Grid& grid = table.grid();
  const double min_cosine = lowest_cosine(options);
  const std::vector<double> row_weights = slice_row_weights(grid);
  for (const double phi_d : phi_d_deg) {
    const int i_p = phi_d_index(grid, phi_d);
    for (int i_h = 0; i_h < grid.n_theta_h; ++i_h) {
      const double weight = row_weights[static_cast<std::size_t>(i_h)];
      for (int i_d = 0; i_d < grid.n_theta_d; ++i_d) {
        const std::size_t cell = grid.index(i_h, i_d, i_p);
        if (!table.is_valid(cell)) continue;
        const CellGeometry geometry = cell_geometry(grid.angles(i_h, i_d, i_p));
        if (!is_observed(geometry, min_cosine)) continue;
        add_cell(samples, geometry, table.value(cell), weight, options.both_orders);
      }
    }
  }
  samples.finish();
  return samples;
}

}  // namespace brdfit
