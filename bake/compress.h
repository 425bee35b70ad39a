// Fewer bits and fewer lobes per texel, each made good by the lobes that are left.
//
// Both work on a texel's normal equations: the error of amplitudes a is (a - best)^T A (a - best) above that
// of the best ones, so that what rounding one amplitude spoils can be given to the others.
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

// The solution; 0 for a texel without any light.
LobeVector solve(const TexelEquations& equations);

// The `count` lobes that are missed least when the others go, taken away one by one (the one whose loss costs
// least, then the rest solved again), and their refitted amplitudes; the others' are 0. Bit k of mask: lobe k
// is kept.
struct Dominant {
  LobeVector amplitudes;
  std::uint32_t mask = 0;
};
Dominant dominant_lobes(const TexelEquations& equations, int count);

// How amplitudes become whole numbers in [-largest_code, largest_code].
struct Quantiser {
  int bits = 8;                   // 2 to 16
  std::vector<double> precision;  // per lobe: amplitude of the largest code; 0 where a lobe is not used
  int largest_code() const { return realis_largest_code(bits); }
  double amplitude(int lobe, int code) const;
};

// Precision per lobe from amplitudes [lobe][texel]: that quantile of their absolute values, over texels whose
// amplitudes are not all 0. quantile in (0, 1]. Rare larger values are cut, as one texel would cost all
// others their precision.
std::vector<double> precision_per_lobe(std::span<const float> amplitudes, std::size_t lobes, double quantile);

// Codes of one texel. Lobes outside `mask` get 0. Each amplitude is rounded at its best value given those
// that are rounded already (Babai 1986, nearest plane). dither: shift of the rounding threshold per lobe in
// [-0.5, 0.5), or empty.
std::vector<int> quantise(const TexelEquations& equations, const Quantiser& quantiser, std::uint32_t mask,
                          std::span<const double> dither);

// A threshold shift in [-0.5, 0.5) for a texel and a lobe: neighbours differ, so that what rounding takes
// away at one is given at the next. Interleaved gradient noise (Jimenez 2014), shifted from lobe to lobe.
double dither_threshold(std::uint32_t x, std::uint32_t y, int lobe);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_COMPRESS_H_
