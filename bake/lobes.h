// Lobe sets of a bake: uniform ones, and their values under the lights of a stack.
#ifndef BRDFIT_BAKE_LOBES_H_
#define BRDFIT_BAKE_LOBES_H_

#include <Eigen/Core>
#include <span>

#include "brdf/realis.h"

namespace brdfit::bake {

// The largest set that is solved for.
inline constexpr int kMaxLobes = 16;

// Values of the lobes (columns) under lights from these directions (rows; unit, towards the light).
Eigen::MatrixXd lobe_values(const LobeSet& lobes, std::span<const Vec3> directions);

// The cone that holds all directions: the axis is their mean.
struct Cap {
  Vec3 axis;
  double angle = 0.0;  // from the axis to the outermost direction, in radians
};
Cap cap_of(std::span<const Vec3> directions);

// Point k of `count` spread evenly over the cap (Fibonacci's; Swinbank and Purser 2006).
Vec3 cap_point(const Cap& cap, int k, int count);

// The angle that is typical of neighbours among count points spread evenly over the cap; at least 1e-3.
double spacing(const Cap& cap, std::size_t count);

// count lobes at the cap's points, without cut-off short of the
// opposite pole, each `overlap` of its peak at the distance of a neighbour. count in [1, kMaxLobes], overlap
// in (0, 1). Throws std::invalid_argument outside of them.
LobeSet uniform_lobes(int count, const Cap& cap, double overlap = 0.6);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_LOBES_H_
