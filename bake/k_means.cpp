// Lloyd's rounds from seeded starts.
#include "bake/k_means.h"

#include <algorithm>
#include <limits>
#include <random>

namespace brdfit::bake {
namespace {

constexpr int kRounds = 30;

double squared_distance(const Vec3& a, const Vec3& b) {
  const double x = a.x - b.x;
  const double y = a.y - b.y;
  const double z = a.z - b.z;
  return x * x + y * y + z * z;
}

// A uniform number in [0, 1), the same with every standard library.
double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

// The index that a share of the sum falls on; the last with weight for shares of 1.
std::size_t pick(std::span<const double> weights, double share) {
  double sum = 0.0;
  for (const double w : weights) sum += w;
  double left = share * sum;
  std::size_t last = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] <= 0.0) continue;
    last = i;
    left -= weights[i];
    if (left < 0.0) break;
  }
  return last;
}

std::vector<Vec3> first_centres(std::span<const Vec3> points, std::span<const double> weights, int count,
                                std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<double> chance(weights.begin(), weights.end());
  std::vector<double> nearest(points.size(), std::numeric_limits<double>::infinity());
  std::vector<Vec3> centres;
  while (static_cast<int>(centres.size()) < count) {
    if (std::all_of(chance.begin(), chance.end(), [](double c) { return c <= 0.0; })) break;
    centres.push_back(points[pick(chance, uniform(random))]);
    for (std::size_t i = 0; i < points.size(); ++i) {
      nearest[i] = std::min(nearest[i], squared_distance(points[i], centres.back()));
      chance[i] = weights[i] * nearest[i];
    }
  }
  return centres;
}

}  // namespace

Clusters k_means(std::span<const Vec3> points, std::span<const double> weights, int count,
                 std::uint64_t seed) {
  Clusters clusters;
  clusters.centres = first_centres(points, weights, count, seed);
  clusters.of.assign(points.size(), 0);
  if (clusters.centres.empty()) return clusters;
  for (int round = 0; round < kRounds; ++round) {
    bool moved = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto closer = [&](const Vec3& a, const Vec3& b) {
        return squared_distance(points[i], a) < squared_distance(points[i], b);
      };
      const auto nearest = static_cast<std::size_t>(
          std::min_element(clusters.centres.begin(), clusters.centres.end(), closer) -
          clusters.centres.begin());
      moved = moved || nearest != clusters.of[i];
      clusters.of[i] = nearest;
    }
    if (!moved && round > 0) break;
    std::vector<Vec3> sums(clusters.centres.size(), Vec3{0.0, 0.0, 0.0});
    std::vector<double> masses(clusters.centres.size(), 0.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      Vec3& sum = sums[clusters.of[i]];
      const double w = weights[i];
      sum = {sum.x + w * points[i].x, sum.y + w * points[i].y, sum.z + w * points[i].z};
      masses[clusters.of[i]] += w;
    }
    for (std::size_t c = 0; c < sums.size(); ++c) {
      if (masses[c] <= 0.0) continue;
      clusters.centres[c] = {sums[c].x / masses[c], sums[c].y / masses[c], sums[c].z / masses[c]};
    }
  }
  return clusters;
}

}  // namespace brdfit::bake
