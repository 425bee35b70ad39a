// The measured table: angles of the grid, validity of cells, interpolation.
#include "measured/table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace brdfit {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kHalfPi = 0.5 * kPi;

double anchor_offset(CellAnchor anchor) {
  return anchor == CellAnchor::kCentre ? 0.5 : 0.0;
}

// The angle at a place on the square-root axis, in cells from its beginning.
double theta_h_at(double cells, int count) {
  const double root = cells / count;
  return root * root * kHalfPi;
}

bool has_shape(const Grid& grid, std::size_t size) {
  if (grid.n_theta_h <= 0 || grid.n_theta_d <= 0 || grid.n_phi_d <= 0 || size % 3 != 0) return false;
  // Two dimensions cannot overflow, three can: divide instead.
  const auto rows = static_cast<std::size_t>(grid.n_theta_h) * static_cast<std::size_t>(grid.n_theta_d);
  const auto columns = static_cast<std::size_t>(grid.n_phi_d);
  return size / 3 % columns == 0 && size / 3 / columns == rows;
}

bool is_measured(float f) {
  return f >= 0.0F && f <= std::numeric_limits<float>::max();
}

// The cells of a run that hold a measurement, and whether the others are all -1 already.
struct Scan {
  std::size_t valid = 0;
  bool is_canonical = true;
};

// Free of branches and with lanes of one width, so that it is vectorised.
Scan scan(const float* red, const float* green, const float* blue, std::size_t count) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  std::uint32_t valid = 0;
  std::uint32_t odd = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const float r = red[k];
    const float g = green[k];
    const float b = blue[k];
    const std::uint32_t is_valid = std::uint32_t{r >= 0.0F} & std::uint32_t{g >= 0.0F} &
                                   std::uint32_t{b >= 0.0F} & std::uint32_t{r <= kLargest} &
                                   std::uint32_t{g <= kLargest} & std::uint32_t{b <= kLargest};
    const std::uint32_t is_marked =
        std::uint32_t{r == -1.0F} & std::uint32_t{g == -1.0F} & std::uint32_t{b == -1.0F};
    valid += is_valid;
    odd |= (is_valid | is_marked) ^ 1U;
  }
  return {valid, odd == 0};
}

// The marks of invalid cells. Most have the first, as files store it.
constexpr float kUnmeasuredMark = -1.0F;
constexpr float kNegativeMark = -2.0F;
constexpr float kNotFiniteMark = -3.0F;

float mark_of(float red, float green, float blue) {
  if (!std::isfinite(red) || !std::isfinite(green) || !std::isfinite(blue)) return kNotFiniteMark;
  return red < 0.0F && green < 0.0F && blue < 0.0F ? kUnmeasuredMark : kNegativeMark;
}

void mark_invalid(float* red, float* green, float* blue, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) {
    if (!is_measured(red[k]) || !is_measured(green[k]) || !is_measured(blue[k])) {
      red[k] = green[k] = blue[k] = mark_of(red[k], green[k], blue[k]);
    }
  }
}

// The two stored angles that enclose a place on an axis, and the weight of the second.
struct Bracket {
  std::array<int, 2> index;
  std::array<double, 2> weight;
};

// A place this close to a stored angle (in cells) is that angle: rounding must not let a neighbour in.
constexpr double kSnap = 1e-9;

double snapped(double place) {
  const double nearest = std::round(place);
  return std::abs(place - nearest) < kSnap ? nearest : place;
}

Bracket clamped_bracket(double place, int count) {
  const double x = std::clamp(snapped(place), 0.0, static_cast<double>(count - 1));
  const int first = static_cast<int>(x);
  const double t = x - first;
  return {{first, std::min(first + 1, count - 1)}, {1.0 - t, t}};
}

// The axis closes on itself after count cells.
Bracket periodic_bracket(double place, int count) {
  const double x = snapped(place);
  const double floor = std::floor(x);
  const double t = x - floor;
  const auto wrapped = [count](double i) {
    return static_cast<int>(i - count * std::floor(i / count)) % count;
  };
  return {{wrapped(floor), wrapped(floor + 1.0)}, {1.0 - t, t}};
}

}  // namespace

double Grid::theta_h_rad(int i_theta_h) const {
  return theta_h_at(i_theta_h + anchor_offset(anchor), n_theta_h);
}

double Grid::theta_d_rad(int i_theta_d) const {
  return (i_theta_d + anchor_offset(anchor)) / n_theta_d * kHalfPi;
}

double Grid::phi_d_rad(int i_phi_d) const {
  return (i_phi_d + anchor_offset(anchor)) / n_phi_d * kPi;
}

HalfDiff Grid::angles(int i_theta_h, int i_theta_d, int i_phi_d) const {
  return {theta_h_rad(i_theta_h), theta_d_rad(i_theta_d), phi_d_rad(i_phi_d)};
}

HalfDiff Grid::angles_of(std::size_t cell) const {
  const auto phi = static_cast<std::size_t>(n_phi_d);
  const auto theta = static_cast<std::size_t>(n_theta_d);
  return angles(static_cast<int>(cell / phi / theta), static_cast<int>(cell / phi % theta),
                static_cast<int>(cell % phi));
}

int Grid::row_of_theta_h(double theta_h_rad) const {
  const double root = std::sqrt(std::max(0.0, theta_h_rad) / kHalfPi);
  int row = static_cast<int>(std::min(root, 1.0) * n_theta_h);
  // The square root rounds: the edges themselves decide.
  if (theta_h_at(row + 1, n_theta_h) <= theta_h_rad) ++row;
  if (theta_h_at(row, n_theta_h) > theta_h_rad) --row;
  return std::clamp(row, 0, n_theta_h - 1);
}

MeasuredTable::MeasuredTable(const Grid& grid, std::vector<float> planes)
    : grid_(grid), planes_(std::move(planes)) {
  if (!has_shape(grid_, planes_.size())) {
    throw std::invalid_argument("MeasuredTable: the planes do not have the size of the grid");
  }
  constexpr std::size_t kBlock = 4096;
  const std::size_t cells = grid_.cell_count();
  for (std::size_t begin = 0; begin < cells; begin += kBlock) {
    const std::size_t count = std::min(kBlock, cells - begin);
    float* red = planes_.data() + begin;
    float* green = red + cells;
    float* blue = green + cells;
    const Scan found = scan(red, green, blue, count);
    valid_count_ += found.valid;
    if (!found.is_canonical) mark_invalid(red, green, blue, count);
  }
}

CellState MeasuredTable::state(std::size_t cell) const {
  const float value = planes_[cell];
  if (value >= 0.0F) return CellState::kMeasured;
  if (value == kUnmeasuredMark) return CellState::kUnmeasured;
  return value == kNegativeMark ? CellState::kNegative : CellState::kNotFinite;
}

std::array<std::size_t, 4> MeasuredTable::state_counts() const {
  std::array<std::size_t, 4> counts{};
  for (std::size_t cell = 0; cell < planes_.size() / 3; ++cell) {
    ++counts[static_cast<std::size_t>(state(cell))];
  }
  return counts;
}

Rgb MeasuredTable::value(std::size_t cell) const {
  const std::size_t cells = grid_.cell_count();
  return {planes_[cell], planes_[cell + cells], planes_[cell + 2 * cells]};
}

std::span<const float> MeasuredTable::plane(int channel) const {
  // A table made by default has no values, although its grid has cells.
  const std::size_t cells = planes_.size() / 3;
  return std::span<const float>(planes_).subspan(static_cast<std::size_t>(channel) * cells, cells);
}

double MeasuredTable::largest() const {
  return planes_.empty() ? 0.0 : std::max(0.0, double{*std::max_element(planes_.begin(), planes_.end())});
}

std::optional<Rgb> MeasuredTable::interpolate(const HalfDiff& angles) const {
  const double sum_of_angles = angles.theta_h_rad + angles.theta_d_rad + angles.phi_d_rad;
  if (planes_.empty() || !std::isfinite(sum_of_angles)) return std::nullopt;
  const double offset = anchor_offset(grid_.anchor);
  const double root = std::sqrt(std::max(angles.theta_h_rad, 0.0) / kHalfPi);
  const Bracket h = clamped_bracket(root * grid_.n_theta_h - offset, grid_.n_theta_h);
  const Bracket d = clamped_bracket(angles.theta_d_rad / kHalfPi * grid_.n_theta_d - offset, grid_.n_theta_d);
  const Bracket p = periodic_bracket(angles.phi_d_rad / kPi * grid_.n_phi_d - offset, grid_.n_phi_d);

  Rgb sum{};
  double weight_sum = 0.0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t a = corner >> 2;
    const std::size_t b = corner >> 1 & 1;
    const std::size_t c = corner & 1;
    const double weight = h.weight[a] * d.weight[b] * p.weight[c];
    const std::size_t cell = grid_.index(h.index[a], d.index[b], p.index[c]);
    if (weight == 0.0 || !is_valid(cell)) continue;
    const Rgb f = value(cell);
    for (std::size_t channel = 0; channel < 3; ++channel) sum[channel] += weight * f[channel];
    weight_sum += weight;
  }
  if (weight_sum == 0.0) return std::nullopt;
  for (double& channel : sum) channel /= weight_sum;
  return sum;
}

std::optional<Rgb> MeasuredTable::interpolate(const Vec3& wi, const Vec3& wo) const {
  return interpolate(half_diff_from_directions(wi, wo));
}

}  // namespace brdfit
