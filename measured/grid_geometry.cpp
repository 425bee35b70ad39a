// Cosines of the angles that a grid stores.
#include "measured/grid_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brdf/kernel/math.h"

namespace brdfit {
namespace {

using Angle = GridGeometry::Angle;

CellGeometry combine(const Angle& h, const Angle& d, double cos_phi_d) {
  const double along = d.cosine * h.cosine;
  const double across = d.sine * h.sine * cos_phi_d;
  return {along - across,        along + across,     h.sine,       h.cosine,     d.cosine,
          h.one_minus_cosine,    d.one_minus_cosine, h.log_cosine, d.log_cosine, h.log_one_minus_cosine,
          d.log_one_minus_cosine};
}

}  // namespace

CellGeometry cell_geometry(const HalfDiff& angles) {
  return combine(Angle(angles.theta_h_rad), Angle(angles.theta_d_rad), std::cos(angles.phi_d_rad));
}

GridGeometry::Angle::Angle(double radians)
    : sine(std::sin(radians)),
      cosine(std::cos(radians)),
      one_minus_cosine(2.0 * kernel::square(std::sin(0.5 * radians))),
      log_cosine(kernel::log_or_zero(cosine)),
      log_one_minus_cosine(kernel::log_or_zero(one_minus_cosine)) {}

GridGeometry::GridGeometry(const Grid& grid)
    : n_phi_d_(grid.n_phi_d),
      mirror_sum_(grid.anchor == CellAnchor::kCentre ? grid.n_phi_d - 1 : grid.n_phi_d) {
  for (int i = 0; i < grid.n_theta_h; ++i) theta_h_.emplace_back(grid.theta_h_rad(i));
  for (int i = 0; i < grid.n_theta_d; ++i) theta_d_.emplace_back(grid.theta_d_rad(i));
  // The second half is the first one's mirror image to the last bit; the middle, if there is one, is 0.
  cos_phi_d_.resize(static_cast<std::size_t>(mirror_sum_) + 1);
  for (int i = 0; i < mirror(i); ++i) {
    const double cosine = std::cos(grid.phi_d_rad(i));
    cos_phi_d_[static_cast<std::size_t>(i)] = cosine;
    cos_phi_d_[static_cast<std::size_t>(mirror(i))] = -cosine;
  }
}

CellGeometry GridGeometry::cell(int i_theta_h, int i_theta_d, int i_phi_d) const {
  return combine(theta_h(i_theta_h), theta_d(i_theta_d), cos_phi_d_[static_cast<std::size_t>(i_phi_d)]);
}

void GridGeometry::cosines(int i_theta_h, int i_theta_d, PhiRun run, double* cos_i, double* cos_o) const {
  const double along = theta_d(i_theta_d).cosine * theta_h(i_theta_h).cosine;
  const double across = theta_d(i_theta_d).sine * theta_h(i_theta_h).sine;
  const double* cos_phi_d = cos_phi_d_.data() + run.first;
  for (int k = 0; k < run.size(); ++k) {
    cos_i[k] = along - across * cos_phi_d[k];
    cos_o[k] = along + across * cos_phi_d[k];
  }
}

PhiRun GridGeometry::observed(int i_theta_h, int i_theta_d, double min_cosine) const {
  const double along = theta_d(i_theta_d).cosine * theta_h(i_theta_h).cosine;
  const double across = theta_d(i_theta_d).sine * theta_h(i_theta_h).sine;
  // The lower cosine rises with phi_d up to the middle and falls again after it.
  const auto middle = cos_phi_d_.begin() + mirror_sum_ / 2 + 1;
  const auto first = std::partition_point(
      cos_phi_d_.begin(), middle, [&](double cos_phi_d) { return along - across * cos_phi_d < min_cosine; });
  if (first == middle) return {};
  const auto i = static_cast<int>(first - cos_phi_d_.begin());
  return {i, std::min(mirror(i) + 1, n_phi_d_)};
}

double lowest_observed_cosine(double max_theta_deg) {
  const double limit = std::cos(std::min(max_theta_deg, 90.0) * std::numbers::pi / 180.0);
  return std::max(limit - 1e-12, 1e-9);
}

}  // namespace brdfit
