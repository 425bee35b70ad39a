// Polynomials and spherical harmonics per texel, by singular values.
#include "bake/baselines.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brdfit::bake {
namespace {

constexpr double kUndetermined = 1e-6;

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& values = svd.singularValues();
  const double least = values.size() > 0 ? kUndetermined * values[0] : 0.0;
  const Eigen::VectorXd inverse = values.unaryExpr([least](double v) { return v > least ? 1.0 / v : 0.0; });
  return svd.matrixV() * inverse.asDiagonal() * svd.matrixU().transpose();
}

}  // namespace

Eigen::MatrixXd ptm_basis(std::span<const Vec3> directions) {
  Eigen::MatrixXd basis(static_cast<Eigen::Index>(directions.size()), 6);
  for (std::size_t l = 0; l < directions.size(); ++l) {
    const double u = directions[l].x;
    const double v = directions[l].y;
    basis.row(static_cast<Eigen::Index>(l)) << u * u, v * v, u * v, u, v, 1.0;
  }
  return basis;
}

Eigen::MatrixXd harmonics_basis(std::span<const Vec3> directions) {
  Eigen::MatrixXd basis(static_cast<Eigen::Index>(directions.size()), 9);
  for (std::size_t l = 0; l < directions.size(); ++l) {
    const auto [x, y, z] = directions[l];
    basis.row(static_cast<Eigen::Index>(l)) << 0.282095, 0.488603 * y, 0.488603 * z, 0.488603 * x,
        1.092548 * x * y, 1.092548 * y * z, 0.315392 * (3.0 * z * z - 1.0), 1.092548 * x * z,
        0.546274 * (x * x - y * y);
  }
  return basis;
}

std::vector<float> fit_and_predict(const Eigen::MatrixXd& basis, std::span<const float> values,
                                   std::size_t texels, const Eigen::MatrixXd& target) {
  const auto lights = static_cast<std::size_t>(basis.rows());
  if (values.size() != lights * texels || target.cols() != basis.cols()) {
    throw std::invalid_argument("fit_and_predict: sizes disagree");
  }
  // The same for all texels: what each light's value adds to each prediction.
  const Eigen::MatrixXd shares = target * pseudo_inverse(basis);
  std::vector<float> predicted(static_cast<std::size_t>(target.rows()) * texels, 0.0F);
  std::vector<double> sums(texels);
  for (Eigen::Index t = 0; t < target.rows(); ++t) {
    std::fill(sums.begin(), sums.end(), 0.0);
    for (std::size_t l = 0; l < lights; ++l) {
      const double share = shares(t, static_cast<Eigen::Index>(l));
      const float* from = values.data() + l * texels;
      for (std::size_t i = 0; i < texels; ++i) sums[i] += share * from[i];
    }
    std::copy(sums.begin(), sums.end(),
              predicted.begin() + static_cast<std::ptrdiff_t>(t) * static_cast<std::ptrdiff_t>(texels));
  }
  return predicted;
}

}  // namespace brdfit::bake
