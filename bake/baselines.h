// What Realis is compared with: polynomial texture maps and spherical harmonics, fitted per texel.
#ifndef BRDFIT_BAKE_BASELINES_H_
#define BRDFIT_BAKE_BASELINES_H_

#include <Eigen/Core>
#include <span>
#include <vector>

#include "brdf/vec3.h"

namespace brdfit::bake {

// Six terms per light (rows): u^2, v^2, uv, u, v, 1 of the direction's x and y. Malzbender et al. 2001.
Eigen::MatrixXd ptm_basis(std::span<const Vec3> directions);
// Nine real spherical harmonics per light, of orders 0 to 2. Ramamoorthi and Hanrahan 2001.
Eigen::MatrixXd harmonics_basis(std::span<const Vec3> directions);

// Per texel, the least-squares fit of the basis to values ([light][texel]), predicted under other lights
// (rows of `target`): [target light][texel]. Where lights do not determine all terms, the shortest solution;
// directions of less than 1e-6 of the largest singular value count as undetermined.
std::vector<float> fit_and_predict(const Eigen::MatrixXd& basis, std::span<const float> values,
                                   std::size_t texels, const Eigen::MatrixXd& target);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_BASELINES_H_
