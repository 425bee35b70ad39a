// Which amplitudes the codes of a lobe reach: a wide range cuts none, a narrow one has small steps.
#ifndef BRDFIT_BAKE_CODE_RANGES_H_
#define BRDFIT_BAKE_CODE_RANGES_H_

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "bake/codes.h"

namespace brdfit::bake {

// The range of codes of that many bits with the smallest step that reaches from low <= 0 to high >= 0. Step 0
// where both are 0. Throws std::invalid_argument where they are on the wrong side of 0 or not finite.
RealisRange range_between(double low, double high, int bits);

// Per lobe, from the quantile `tail` of its amplitudes to the quantile 1 - tail, over texels that keep it.
// tail in [0, 0.5). Lobes that no texel keeps have step 0.
std::vector<RealisRange> quantile_ranges(std::span<const CodeSearch> texels, std::size_t lobes, int bits,
                                         double tail);

// The sum over texels of the error that rounding adds, without dither.
double rounding_error(std::span<const CodeSearch> texels, const Quantiser& quantiser);

// Ranges with little rounding error: the best of some quantiles, then one lobe's step and zero at a time
// while that helps. Never worse for these texels than any of the quantiles kTails. The same for any number of
// threads.
std::vector<RealisRange> fitted_ranges(std::span<const CodeSearch> texels, std::size_t lobes, int bits);
inline constexpr std::array kTails{0.0, 0.0005, 0.0025, 0.005, 0.01, 0.02, 0.04};

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_CODE_RANGES_H_
