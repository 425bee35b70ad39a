// One texel solved in double precision, straight from the equations: what the vector code is held to.
#ifndef BRDFIT_TESTS_TEXEL_SOLUTION_H_
#define BRDFIT_TESTS_TEXEL_SOLUTION_H_

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "bake/solve_job.h"

namespace brdfit::test_data {

// Eigenvalues below this share of the largest count as 0.
inline constexpr double kSingularShare = 1e-10;

struct TexelSolution {
  Eigen::VectorXd amplitudes;
  Eigen::VectorXd hat;       // per light, the diagonal of the hat matrix
  Eigen::VectorXd left;      // per light, residual - what lobes bring back
  Eigen::VectorXd left_out;  // the same had the light not been there
};
// gram^-1 right; mixes of lobes that the matrix does not determine get 0.
inline Eigen::MatrixXd solved(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& right) {
  const Eigen::LLT<Eigen::MatrixXd> triangle(gram);
  if (triangle.info() == Eigen::Success && triangle.rcond() > kSingularShare) return triangle.solve(right);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
  const double least = kSingularShare * std::max(eigen.eigenvalues().maxCoeff(), 0.0);
  const Eigen::VectorXd inverse =
      eigen.eigenvalues().unaryExpr([least](double v) { return v > least ? 1.0 / v : 0.0; });
  return eigen.eigenvectors() * (inverse.asDiagonal() * (eigen.eigenvectors().transpose() * right));
}

// basis: lights x lobes. penalty >= 0, the diagonal. Mixes of lobes that the lights do not determine get 0.
inline TexelSolution solve_texel(const Eigen::MatrixXd& basis, const Eigen::VectorXd& residual,
                                 const Eigen::VectorXd& modulation, const Eigen::VectorXd& weight,
                                 double penalty) {
  const Eigen::MatrixXd modulated = modulation.asDiagonal() * basis;
  const Eigen::MatrixXd weighted = weight.asDiagonal() * modulated;
  Eigen::MatrixXd gram = modulated.transpose() * weighted;
  gram.diagonal().array() += penalty;
  const Eigen::MatrixXd solver = solved(gram, weighted.transpose());
  TexelSolution solution;
  solution.amplitudes = solver * residual;
  solution.hat = (modulated.array() * solver.transpose().array()).rowwise().sum();
  solution.left = residual - modulated * solution.amplitudes;
  solution.left_out = residual;
  for (Eigen::Index l = 0; l < residual.size(); ++l) {
    const double freedom = 1.0 - solution.hat[l];
    if (freedom > bake::kLeastFreedom) solution.left_out[l] = solution.left[l] / freedom;
  }
  return solution;
}

}  // namespace brdfit::test_data

#endif  // BRDFIT_TESTS_TEXEL_SOLUTION_H_
