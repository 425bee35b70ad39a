// The classic chart of 24 colour patches, photographed to find a camera's colour matrix.
#ifndef BRDFIT_IO_COLOUR_CHART_H_
#define BRDFIT_IO_COLOUR_CHART_H_

#include <array>
#include <span>
#include <string>

#include "brdf/vec3.h"

namespace brdfit::io {

using Matrix3 = std::array<std::array<double, 3>, 3>;  // rows
inline constexpr Matrix3 kIdentity3 = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
Rgb operator*(const Matrix3& matrix, const Rgb& colour);

inline constexpr std::size_t kChartPatches = 24;

// What the patches reflect, in linear Rec.709 where a perfect white is 1: from dark skin to black, row by
// row. X-Rite, "Colorimetric values for ColorChecker family of targets", charts made before November 2014
// (CIE L*a*b* under D50), adapted to D65 by Bradford (Lam 1985). Cyan lies outside Rec.709: its red is
// negative.
const std::array<Rgb, kChartPatches>& chart_reference();

// A matrix from camera to linear Rec.709, and how well it does.
struct ChartFit {
  Matrix3 matrix = kIdentity3;
  double rms = 0.0;  // of the patches' differences to the reference, over patches and channels
};

// Least squares over the patches, in their order. camera: linear camera RGB with black taken off; the scale
// is that of the exposure, so a matrix also says how bright a perfect white is. Throws std::invalid_argument
// when the patches do not span three dimensions (a grey picture, a wrong column) or are not finite.
ChartFit fit_chart(std::span<const Rgb, kChartPatches> camera);

}  // namespace brdfit::io

#endif  // BRDFIT_IO_COLOUR_CHART_H_
