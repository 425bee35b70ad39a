// Directional albedo by quadrature over half vectors.
#include "brdf/albedo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "brdf/models.h"

namespace brdfit {

Rgb directional_albedo(const Material& material, double theta_o_rad) {
  constexpr int kTheta = 192;
  // Over half a turn: wo lies in the plane y = 0, and lobes are aligned with the axes, so that the other half
  // is its mirror image.
  constexpr int kHalfPhi = 16;
  const Vec3 wo = {std::sin(theta_o_rad), 0.0, std::cos(theta_o_rad)};
  std::array<double, kHalfPhi> cos_phi;
  std::array<double, kHalfPhi> sin_phi;
  for (std::size_t j = 0; j < kHalfPhi; ++j) {
    const double phi = (static_cast<double>(j) + 0.5) / kHalfPhi * std::numbers::pi;
    cos_phi[j] = std::cos(phi);
    sin_phi[j] = std::sin(phi);
  }
  std::vector<Vec3> incoming;
  std::vector<double> weight;
  incoming.reserve(kTheta * kHalfPhi);
  weight.reserve(kTheta * kHalfPhi);
  for (int i = 0; i < kTheta; ++i) {
    // theta = u^3 pi/2: dense at the normal; the midpoint rule in u and phi.
    const double u = (i + 0.5) / kTheta;
    const double theta = u * u * u * std::numbers::pi / 2;
    const double d_theta = 3.0 * u * u * std::numbers::pi / 2 / kTheta;
    const double sin_theta = std::sin(theta);
    const double cos_theta = std::cos(theta);
    for (std::size_t j = 0; j < kHalfPhi; ++j) {
      const Vec3 h = {sin_theta * cos_phi[j], sin_theta * sin_phi[j], cos_theta};
      const double cos_d = wo.x * h.x + wo.y * h.y + wo.z * h.z;
      if (cos_d <= 0.0) continue;
      const Vec3 wi = {2.0 * cos_d * h.x - wo.x, 2.0 * cos_d * h.y - wo.y, 2.0 * cos_d * h.z - wo.z};
      if (wi.z <= 0.0) continue;
      incoming.push_back(wi);
      // d wi = 4 (wo.h) d h (Walter et al. 2007, eq. 14).
      weight.push_back(4.0 * cos_d * sin_theta * d_theta * 2.0 * std::numbers::pi / kHalfPhi);
    }
  }
  const std::vector<Vec3> outgoing(incoming.size(), wo);
  std::vector<Rgb> f_cos(incoming.size());
  eval_cos(material, incoming, outgoing, f_cos);
  Rgb albedo = {0.0, 0.0, 0.0};
  for (std::size_t k = 0; k < f_cos.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) albedo[c] += weight[k] * f_cos[k][c];
  }
  return albedo;
}

double largest_directional_albedo(const Material& material) {
  double largest = 0.0;
  for (int deg = 0; deg <= 80; deg += 10) {
    largest =
        std::max(largest, std::ranges::max(directional_albedo(material, deg * std::numbers::pi / 180.0)));
  }
  return largest;
}

}  // namespace brdfit
