// A texel's normal equations, and fewer lobes per texel, made good by those that are left.
//
// The error of amplitudes a is (a - best)^T A (a - best) above that of the best ones, so that what dropping
// or rounding one amplitude spoils can be given to the others.
#ifndef BRDFIT_BAKE_COMPRESS_H_
#define BRDFIT_BAKE_COMPRESS_H_

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/lobes.h"

namespace brdfit::bake {

using LobeVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxLobes, 1>;
using LobeMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxLobes, kMaxLobes>;

// A a = b at the best amplitudes of one texel, A symmetric with the ridge on its diagonal. A may be singular
// (a texel that no light reaches): amplitudes along such directions are 0.
struct TexelEquations {
  LobeMatrix a;
  LobeVector b;
};

// Lobes of a mask (bit k for lobe k), ascending; `count` of all lobes.
std::vector<int> lobes_of(std::uint32_t mask, Eigen::Index count);

// The equations of some lobes, with just enough added to the diagonal that empty directions stay at 0.
TexelEquations restricted(const TexelEquations& equations, const std::vector<int>& lobes);

// The solution; 0 for a texel without any light.
LobeVector solve(const TexelEquations& equations);

// The solution with the lobes of a mask alone; the others' amplitudes are 0.
LobeVector refit(const TexelEquations& equations, std::uint32_t mask);

// The `count` lobes that are missed least when the others go, taken away one by one: the one whose loss costs
// least, then the rest solved again. Bit k: lobe k is kept. Several equations, as those of a texel's colour
// channels, share one mask.
std::uint32_t dominant_mask(std::span<const TexelEquations> channels, int count);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_COMPRESS_H_
