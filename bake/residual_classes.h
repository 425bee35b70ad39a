// What the search for lobes knows of an asset: residual covariances between lights, one per class of texels
// of like modulation.
//
// The error that lobes leave in a texel depends on its modulation and, squared and summed over texels of the
// same modulation, on the residuals only through their covariance. So texels are grouped by modulation once,
// and the search never sees them.
#ifndef BRDFIT_BAKE_RESIDUAL_CLASSES_H_
#define BRDFIT_BAKE_RESIDUAL_CLASSES_H_

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/texel_problem.h"

namespace brdfit::bake {

struct ResidualClass {
  std::vector<Vec3> directions;  // of the lights; of near ones the class's mean
  Eigen::VectorXd modulation;    // per light, the root of the mean of weight x modulation^2
  Eigen::MatrixXd factor;        // lights x rank: factor factor^T approximates the sum of residual residual^T
  double energy = 0.0;           // trace of that sum, of which the factor may hold a part
  std::size_t texels = 0;
};

struct ClassOptions {
  int classes = 16;
  int rank = 24;  // of factors, at most
  std::uint64_t seed = 1;
};

// Groups the texels by where their modulation points (k-means, weighted by the residual's energy). Classes
// without energy are left out: none are left of a problem whose residual is 0.
std::vector<ResidualClass> residual_classes(const TexelProblem& problem, std::span<const Vec3> directions,
                                            const ClassOptions& options = {});

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_RESIDUAL_CLASSES_H_
