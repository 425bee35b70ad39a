// Unseen directions that lead away from bounds.
#include "fit/ties.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace brdfit::fit {
namespace {

enum class Place { kInside, kLower, kUpper };

Place place_of(double x, double lower, double upper) {
  const double margin = 1e-7 * (upper - lower);
  if (x <= lower + margin) return Place::kLower;
  return x >= upper - margin ? Place::kUpper : Place::kInside;
}

// Whether a step along sign * direction stays in the box, as far as visible parts of it go.
bool leads_inside(const Eigen::VectorXd& direction, double sign, const std::vector<Place>& places) {
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double part = sign * direction[static_cast<Eigen::Index>(k)];
    if (std::abs(part) <= kVisiblePart) continue;
    if (places[k] == Place::kLower && part < 0.0) return false;
    if (places[k] == Place::kUpper && part > 0.0) return false;
  }
  return true;
}

}  // namespace

void add_hidden_ties(const Parametrisation& parametrisation, std::span<const double> x, const Box& box,
                     const Eigen::MatrixXd& gram, const std::vector<bool>& held,
                     Identifiability& identifiability) {
  if (x.empty()) return;
  Eigen::VectorXd scale(static_cast<Eigen::Index>(x.size()));
  for (std::size_t k = 0; k < x.size(); ++k) {
    scale[static_cast<Eigen::Index>(k)] = parametrisation.scale(k, x[k]);
  }
  const Eigen::Index n = scale.size();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * gram.topLeftCorner(n, n) * scale.asDiagonal();
  const double least = kSingularThreshold * kSingularThreshold * scaled.diagonal().cwiseAbs().maxCoeff();
  // What changes nothing at all is tied to nothing.
  std::vector<Eigen::Index> numbers;
  std::vector<Place> places;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    if ((!held.empty() && held[k]) || scaled(at, at) <= least) continue;
    numbers.push_back(at);
    places.push_back(place_of(x[k], box.lower[k], box.upper[k]));
  }
  if (std::ranges::all_of(places, [](Place place) { return place == Place::kInside; })) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Eigen::MatrixXd(scaled(numbers, numbers)));
  const double threshold =
      kSingularThreshold * kSingularThreshold * std::max(eigen.eigenvalues().maxCoeff(), 0.0);
  for (Eigen::Index k = 0; k < eigen.eigenvalues().size() && eigen.eigenvalues()[k] <= threshold; ++k) {
    const Eigen::VectorXd direction = eigen.eigenvectors().col(k);
    if (!leads_inside(direction, 1.0, places) && !leads_inside(direction, -1.0, places)) continue;
    identifiability.unseen(numbers, numbers) += direction * direction.transpose();
    for (std::size_t j = 0; j < numbers.size(); ++j) {
      if (std::abs(direction[static_cast<Eigen::Index>(j)]) <= kVisiblePart) continue;
      identifiability.status[static_cast<std::size_t>(numbers[j])] = Status::kUnidentifiable;
    }
  }
}

}  // namespace brdfit::fit
