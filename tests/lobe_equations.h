// Normal equations of texels made up in the test.
#ifndef BRDFIT_TESTS_LOBE_EQUATIONS_H_
#define BRDFIT_TESTS_LOBE_EQUATIONS_H_

#include <Eigen/Dense>
#include <random>

#include "bake/compress.h"

namespace brdfit::test_data {

// Equations of lobes that overlap, as those of real light sets do.
inline bake::TexelEquations overlapping_lobes(unsigned seed, int lobes = 8) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd basis(20, lobes);
  for (Eigen::Index i = 0; i < basis.rows(); ++i) {
    const double common = normal(engine);
    for (Eigen::Index k = 0; k < lobes; ++k) basis(i, k) = common + 0.7 * normal(engine);
  }
  Eigen::VectorXd target(20);
  for (Eigen::Index i = 0; i < 20; ++i) target[i] = normal(engine);
  bake::TexelEquations equations{bake::LobeMatrix(basis.transpose() * basis),
                                 bake::LobeVector(basis.transpose() * target)};
  equations.a.diagonal().array() += 0.05;
  return equations;
}

inline double error_of(const bake::TexelEquations& equations, const bake::LobeVector& amplitudes) {
  const bake::LobeVector off = amplitudes - bake::solve(equations);
  return off.dot(equations.a * off);
}

}  // namespace brdfit::test_data

#endif  // BRDFIT_TESTS_LOBE_EQUATIONS_H_
