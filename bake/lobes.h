// Lobe sets of a bake: their values under the lights of a stack.
#ifndef BRDFIT_BAKE_LOBES_H_
#define BRDFIT_BAKE_LOBES_H_

#include <Eigen/Core>
#include <span>

#include "brdf/realis.h"

namespace brdfit::bake {

// Values of the lobes (columns) under lights from these directions (rows; unit, towards the light).
Eigen::MatrixXd lobe_values(const LobeSet& lobes, std::span<const Vec3> directions);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_LOBES_H_
