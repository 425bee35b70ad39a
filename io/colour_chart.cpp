// Reference colours of the chart, and the least squares problem of three by three unknowns.
#include "io/colour_chart.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brdfit::io {
namespace {

// CIE L*a*b*, D50.
constexpr std::array<std::array<double, 3>, kChartPatches> kLab = {
    {{37.986, 13.555, 14.059},  {65.711, 18.130, 17.810},  {49.927, -4.880, -21.925},
     {43.139, -13.095, 21.905}, {55.112, 8.844, -25.399},  {70.719, -33.397, -0.199},
     {62.661, 36.067, 57.096},  {40.020, 10.410, -45.964}, {51.124, 48.239, 16.248},
     {30.325, 22.976, -21.587}, {72.532, -23.709, 57.255}, {71.941, 19.363, 67.857},
     {28.778, 14.179, -50.297}, {55.261, -38.342, 31.370}, {42.101, 53.378, 28.190},
     {81.733, 4.039, 79.819},   {51.935, 49.986, -14.574}, {51.038, -28.631, -28.638},
     {96.539, -0.425, 1.186},   {81.257, -0.638, -0.335},  {66.766, -0.734, -0.504},
     {50.867, -0.153, -0.270},  {35.656, -0.421, -1.231},  {20.461, -0.079, -0.973}}};

constexpr Rgb kWhiteD50 = {0.96422, 1.0, 0.82521};
constexpr Rgb kWhiteD65 = {0.95047, 1.0, 1.08883};
// Lam 1985.
constexpr Matrix3 kBradford = {
    {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
// ITU-R BT.709, from linear to XYZ.
constexpr Matrix3 kXyzFromRec709 = {{{0.4124564, 0.3575761, 0.1804375},
                                     {0.2126729, 0.7151522, 0.0721750},
                                     {0.0193339, 0.1191920, 0.9503041}}};

double determinant(const Matrix3& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

Matrix3 inverse(const Matrix3& m) {
  const double scale = 1.0 / determinant(m);
  Matrix3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      result[i][j] = scale * (m[a][c] * m[b][d] - m[a][d] * m[b][c]);
    }
  }
  return result;
}

Rgb xyz_of_lab(const std::array<double, 3>& lab) {
  const double y = (lab[0] + 16.0) / 116.0;
  const auto cubed = [](double f) {
    constexpr double kKnee = 6.0 / 29.0;
    return f > kKnee ? f * f * f : 3.0 * kKnee * kKnee * (f - 4.0 / 29.0);
  };
  return {kWhiteD50[0] * cubed(y + lab[1] / 500.0), kWhiteD50[1] * cubed(y),
          kWhiteD50[2] * cubed(y - lab[2] / 200.0)};
}

std::array<Rgb, kChartPatches> make_reference() {
  const Rgb from = kBradford * kWhiteD50;
  const Rgb to = kBradford * kWhiteD65;
  const Matrix3 from_cone = inverse(kBradford);
  const Matrix3 from_xyz = inverse(kXyzFromRec709);
  std::array<Rgb, kChartPatches> reference;
  for (std::size_t k = 0; k < kChartPatches; ++k) {
    Rgb cone = kBradford * xyz_of_lab(kLab[k]);
    for (std::size_t c = 0; c < 3; ++c) cone[c] *= to[c] / from[c];
    reference[k] = from_xyz * (from_cone * cone);
  }
  return reference;
}

}  // namespace

Rgb operator*(const Matrix3& matrix, const Rgb& colour) {
  Rgb result{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[i] += matrix[i][j] * colour[j];
  }
  return result;
}

const std::array<Rgb, kChartPatches>& chart_reference() {
  static const std::array<Rgb, kChartPatches> reference = make_reference();
  return reference;
}

ChartFit fit_chart(std::span<const Rgb, kChartPatches> camera) {
  Matrix3 gram{};   // camera by camera
  Matrix3 cross{};  // reference by camera
  for (std::size_t k = 0; k < kChartPatches; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        gram[i][j] += camera[k][i] * camera[k][j];
        cross[i][j] += chart_reference()[k][i] * camera[k][j];
      }
    }
  }
  // 1 for channels that have nothing in common, 0 for those that depend on each other; a real camera has
  // 1e-2.
  const double apart = determinant(gram) / (gram[0][0] * gram[1][1] * gram[2][2]);
  if (!(apart > 1e-6)) {
    throw std::invalid_argument("the 24 patches do not span three colours");
  }
  const Matrix3 gram_inverse = inverse(gram);
  ChartFit fit;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      fit.matrix[i][j] = 0.0;
      for (std::size_t k = 0; k < 3; ++k) fit.matrix[i][j] += cross[i][k] * gram_inverse[k][j];
    }
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < kChartPatches; ++k) {
    const Rgb got = fit.matrix * camera[k];
    for (std::size_t c = 0; c < 3; ++c) sum += std::pow(got[c] - chart_reference()[k][c], 2);
  }
  fit.rms = std::sqrt(sum / (3.0 * kChartPatches));
  return fit;
}

}  // namespace brdfit::io
