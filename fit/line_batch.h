// Lines of a table in pairs of mirror images, as the error measures compare them.
#ifndef BRDFIT_FIT_LINE_BATCH_H_
#define BRDFIT_FIT_LINE_BATCH_H_

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "brdf/simd/jobs.h"
#include "fit/metric_sums.h"
#include "measured/grid_geometry.h"
#include "measured/table.h"

namespace brdfit::fit {

// Counts of entries as vector code takes them.
inline std::size_t padded(std::size_t count) {
  return (count + simd::kLineBlock - 1) / simd::kLineBlock * simd::kLineBlock;
}

template <class T>
using Channels = std::array<std::vector<T>, 3>;

template <class T>
void resize(Channels<T>& columns, std::size_t size) {
  for (auto& column : columns) column.resize(size);
}

// Lines are read in pieces and from both ends, which the machine does not foresee.
inline void prefetch(const float* from, int step, std::size_t count) {
#ifdef __GNUC__
  constexpr std::size_t kCacheLine = 16;
  for (std::size_t k = 0; k < count; k += kCacheLine) {
    __builtin_prefetch(from + step * static_cast<std::ptrdiff_t>(k));
  }
#endif
}

// Neighbouring theta_d lines of one theta_h row. A line holds its phi_d up to the middle; those beyond are
// its mirror image, where wi and wo are exchanged and f is the same.
class LineBatch {
 public:
  simd::LineColumns columns;
  // Of each line the stored cells and their mirror images.
  std::array<std::array<MetricSide, 2>, simd::kLines> sides;
  std::array<PhiRun, simd::kLines> halves;
  Channels<double> f;
  Channels<double> f_swapped;  // for (wo, wi); only for materials that are not reciprocal

  LineBatch(const MeasuredTable& reference, const GridGeometry& angles, int i_theta_h)
      : reference_(reference), angles_(angles), i_theta_h_(i_theta_h) {
    columns.stride = padded(static_cast<std::size_t>(angles.middle()) + 1);
    const std::size_t size = simd::kLines * columns.stride;
    cos_i_.resize(size);
    cos_o_.resize(size);
    columns.cos_i = cos_i_.data();
    columns.cos_o = cos_o_.data();
    resize(f, size);
    resize(f_swapped, size);
    const GridGeometry::Angle& h = angles.theta_h(i_theta_h);
    columns.sin_h = h.sine;
    columns.cos_h = h.cosine;
    columns.one_minus_cos_h = h.one_minus_cosine;
    columns.log_cos_h = h.log_cosine;
    columns.log_one_minus_cos_h = h.log_one_minus_cosine;
  }

  // Takes the lines from first_theta_d on; of each, the cells whose cosines are at least min_cosine.
  void fill(int first_theta_d, double min_cosine) {
    const Grid& grid = reference_.grid();
    for (std::size_t line = 0; line < simd::kLines; ++line) {
      const int i_d = first_theta_d + static_cast<int>(line);
      const GridGeometry::Angle& d = angles_.theta_d(std::min(i_d, grid.n_theta_d - 1));
      columns.cos_d[line] = d.cosine;
      columns.one_minus_cos_d[line] = d.one_minus_cosine;
      columns.log_cos_d[line] = d.log_cosine;
      columns.log_one_minus_cos_d[line] = d.log_one_minus_cosine;
      columns.count[line] = 0;
      halves[line] = {};
      if (i_d >= grid.n_theta_d) continue;
      const PhiRun run = angles_.observed(i_theta_h_, i_d, min_cosine);
      if (!run.empty()) fill_line(line, i_d, {run.first, angles_.middle() + 1});
    }
  }

  bool has(std::size_t line) const { return columns.count[line] > 0; }

  // A table's values on one side of a line, as many as are counted.
  template <class T>
  void copy_values(const MeasuredTable& table, std::size_t line, int i_theta_d, std::size_t k,
                   const std::array<T*, 3>& to) const {
    const MetricSide& side = sides[line][k];
    const PhiRun half = halves[line];
    const std::size_t row = table.grid().index(i_theta_h_, i_theta_d, 0);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::span<const float> values = table.plane(static_cast<int>(c)).subspan(row);
      for (std::size_t at = side.begin; at < side.end; ++at) {
        const int i_phi_d = half.first + static_cast<int>(at);
        to[c][at] = values[static_cast<std::size_t>(k == 0 ? i_phi_d : angles_.mirror(i_phi_d))];
      }
    }
  }

  // Both sides of a line against f.
  MetricJob job(std::size_t line) const {
    const std::size_t begin = line * columns.stride;
    MetricJob job;
    job.count = columns.count[line];
    job.side_count = 2;
    for (std::size_t c = 0; c < 3; ++c) {
      job.f[c] = &f[c][begin];
      job.f_swapped[c] = &f_swapped[c][begin];
    }
    for (std::size_t k = 0; k < 2; ++k) job.sides[k] = sides[line][k];
    return job;
  }

 private:
  void fill_line(std::size_t line, int i_d, PhiRun half) {
    const auto count = static_cast<std::size_t>(half.size());
    const std::size_t begin = line * columns.stride;
    halves[line] = half;
    columns.count[line] = padded(count);
    angles_.cosines(i_theta_h_, i_d, half, &cos_i_[begin], &cos_o_[begin]);
    // Padding repeats the last cell.
    for (std::size_t k = begin + count; k < begin + columns.count[line]; ++k) {
      cos_i_[k] = cos_i_[begin + count - 1];
      cos_o_[k] = cos_o_[begin + count - 1];
    }
    // A mirror image may be no stored cell, or be the cell itself.
    const bool first_is_alone = angles_.mirror(half.first) >= reference_.grid().n_phi_d;
    const bool last_is_alone = angles_.mirror(half.end - 1) == half.end - 1;
    sides[line][0] = {{}, 1, 0, count, &cos_i_[begin], nullptr};
    sides[line][1] = {{},
                      -1,
                      first_is_alone ? std::size_t{1} : std::size_t{0},
                      count - (last_is_alone ? 1 : 0),
                      &cos_o_[begin],
                      nullptr};
    for (std::size_t k = 0; k < 2; ++k) point_to_reference(line, i_d, k);
  }

  // Reads r where it lies; only where padding would reach beyond the plane it is copied.
  void point_to_reference(std::size_t line, int i_d, std::size_t k) {
    MetricSide& side = sides[line][k];
    const std::size_t row = reference_.grid().index(i_theta_h_, i_d, 0);
    const std::size_t count = columns.count[line];
    const int i_phi_d = k == 0 ? halves[line].first : angles_.mirror(halves[line].first);
    const std::size_t first = row + static_cast<std::size_t>(i_phi_d);
    const std::size_t cells = reference_.grid().cell_count();
    const bool is_inside = k == 0 ? first + count <= cells : first < cells && first + 1 >= count;
    if (is_inside) {
      for (std::size_t c = 0; c < 3; ++c) {
        side.r[c] = reference_.plane(static_cast<int>(c)).data() + first;
        prefetch(side.r[c], side.step, count);
      }
      return;
    }
    auto& copies = copies_[line][k];
    std::array<float*, 3> to;
    for (std::size_t c = 0; c < 3; ++c) {
      copies[c].assign(count, -1.0F);
      to[c] = copies[c].data();
      side.r[c] = to[c];
    }
    side.step = 1;
    copy_values(reference_, line, i_d, k, to);
  }

  const MeasuredTable& reference_;
  const GridGeometry& angles_;
  int i_theta_h_;
  std::vector<double> cos_i_, cos_o_;
  std::array<std::array<Channels<float>, 2>, simd::kLines> copies_;
};

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_LINE_BATCH_H_
