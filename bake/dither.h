// The noise that rounding is dithered by, for one texel or for vectors of them.
#ifndef BRDFIT_BAKE_DITHER_H_
#define BRDFIT_BAKE_DITHER_H_

#include <cmath>
#include <cstdint>

namespace brdfit::bake {

// Columns by which lobes take the noise from elsewhere.
inline constexpr double kDitherShift = 5.588238;

// Interleaved gradient noise (Jimenez 2014), in [0, 1), of a column and a row, neither negative. Real: double
// or a vector of doubles; round_down: of such.
template <class Real, class RoundDown>
inline Real interleaved_gradient_noise(const Real& column, const Real& row, const RoundDown& round_down) {
  const Real inner = Real(0.06711056) * column + Real(0.00583715) * row;
  const Real noise = Real(52.9829189) * (inner - round_down(inner));
  return noise - round_down(noise);
}

// A number in [-0.5, 0.5) for a texel and a lobe: neighbours differ, so that what rounding takes away at one
// is given at the next. Shifted from lobe to lobe.
inline double dither_threshold(std::uint32_t x, std::uint32_t y, int lobe) {
  return interleaved_gradient_noise(static_cast<double>(x) + kDitherShift * lobe, static_cast<double>(y),
                                    [](double value) { return std::floor(value); }) -
         0.5;
}

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_DITHER_H_
