// Weighted k-means of points in space (Lloyd 1982, started as in Arthur and Vassilvitskii 2007).
#ifndef BRDFIT_BAKE_K_MEANS_H_
#define BRDFIT_BAKE_K_MEANS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "brdf/vec3.h"

namespace brdfit::bake {

struct Clusters {
  std::vector<Vec3> centres;    // at most as many as asked for
  std::vector<std::size_t> of;  // per point, its centre
};

// weights >= 0, one per point. The same for the same seed.
Clusters k_means(std::span<const Vec3> points, std::span<const double> weights, int count,
                 std::uint64_t seed);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_K_MEANS_H_
