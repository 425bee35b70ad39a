// Tables and materials behind one face.
#include "render/subject.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "brdf/half_diff.h"
#include "brdf/models.h"

namespace brdfit::render {

PixelState pixel_state_of(CellState state) {
  switch (state) {
    case CellState::kMeasured:
      return PixelState::kValue;
    case CellState::kUnmeasured:
      return PixelState::kUnmeasured;
    case CellState::kNegative:
      return PixelState::kNegative;
    case CellState::kNotFinite:
      break;
  }
  return PixelState::kNotFinite;
}

std::size_t cell_of(const Grid& grid, const HalfDiff& angles) {
  const auto index = [](double place, int count) {
    return std::clamp(static_cast<int>(std::floor(place * count + 1e-9)), 0, count - 1);
  };
  constexpr double kPi = std::numbers::pi;
  const double turns = angles.phi_d_rad / kPi;
  return grid.index(grid.row_of_theta_h(angles.theta_h_rad),
                    index(angles.theta_d_rad / (0.5 * kPi), grid.n_theta_d),
                    index(turns - std::floor(turns), grid.n_phi_d));
}

namespace {

void eval_cos_of_table(const MeasuredTable& table, std::span<const Vec3> wi, std::span<const Vec3> wo,
                       std::span<Rgb> out, std::span<PixelState> state) {
  for (std::size_t k = 0; k < wi.size(); ++k) {
    out[k] = {0.0, 0.0, 0.0};
    state[k] = PixelState::kBelowHorizon;
    if (wi[k].z <= 0.0 || wo[k].z <= 0.0) continue;
    const HalfDiff angles = half_diff_from_directions(wi[k], wo[k]);
    const std::optional<Rgb> f = table.interpolate(angles);
    if (!f) {
      state[k] = pixel_state_of(table.state(cell_of(table.grid(), angles)));
      continue;
    }
    state[k] = PixelState::kValue;
    for (std::size_t c = 0; c < 3; ++c) out[k][c] = (*f)[c] * wi[k].z;
  }
}

}  // namespace

void Subject::eval_cos(std::span<const Vec3> wi, std::span<const Vec3> wo, std::span<Rgb> out,
                       std::span<PixelState> state) const {
  if (wi.size() != wo.size() || wi.size() != out.size() || wi.size() != state.size()) {
    throw std::invalid_argument("Subject::eval_cos: wi, wo, out and state differ in size");
  }
  if (table_ != nullptr) return eval_cos_of_table(*table_, wi, wo, out, state);
  brdfit::eval_cos(*material_, wi, wo, out);
  for (std::size_t k = 0; k < wi.size(); ++k) {
    state[k] = wi[k].z > 0.0 && wo[k].z > 0.0 ? PixelState::kValue : PixelState::kBelowHorizon;
  }
}

}  // namespace brdfit::render
