// The jackknife over groups of samples, and its propagation to public parameters.
#include "fit/uncertainty.h"

#include <ceres/cost_function.h>
#include <ceres/covariance.h>
#include <ceres/problem.h>
#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace brdfit::fit {
namespace {

constexpr std::size_t kMostGroups = 256;

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Residuals with a constant Jacobian.
class LinearCost : public ceres::CostFunction {
 public:
  explicit LinearCost(Eigen::MatrixXd jacobian) : jacobian_(std::move(jacobian)) {
    set_num_residuals(static_cast<int>(jacobian_.rows()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(jacobian_.cols()));
  }

  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::VectorXd>(residuals, jacobian_.rows()).setZero();
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<RowMajor>(jacobians[0], jacobian_.rows(), jacobian_.cols()) = jacobian_;
    }
    return true;
  }

 private:
  Eigen::MatrixXd jacobian_;
};

// A square matrix J with J^T J the given one.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& gram) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
  return eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
}

// Numbers that the solve moved and that rest at no bound.
std::vector<Eigen::Index> moving_inside(std::span<const double> x, const Box& box,
                                        const Identifiability& identifiability) {
  std::vector<Eigen::Index> inside;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const Status status = identifiability.status[k];
    if (!box.moves[k] || status == Status::kAtLowerBound || status == Status::kAtUpperBound) continue;
    // Ranges of one sign end inside a number's own range.
    const double margin = 1e-7 * (box.upper[k] - box.lower[k]);
    if (x[k] <= box.lower[k] + margin || x[k] >= box.upper[k] - margin) continue;
    inside.push_back(static_cast<Eigen::Index>(k));
  }
  return inside;
}

Eigen::VectorXd scales_of(const Parametrisation& parametrisation, std::span<const double> x,
                          const std::vector<Eigen::Index>& inside) {
  Eigen::VectorXd scale(static_cast<Eigen::Index>(inside.size()));
  for (std::size_t k = 0; k < inside.size(); ++k) {
    const auto at = static_cast<std::size_t>(inside[k]);
    scale[static_cast<Eigen::Index>(k)] = parametrisation.scale(at, x[at]);
  }
  return scale;
}

// How the solution moves when a group is left out: the others' Newton step m, in the numbers' own units. With
// A the inverse of all products and G and g a group's products and gradient, m = A (g + G m). Most groups say
// little, and repeating that finds m at once; where one does not, the equations are solved.
Eigen::VectorXd move_without(const Eigen::MatrixXd& group, const Eigen::MatrixXd& inverse,
                             const std::vector<Eigen::Index>& inside) {
  constexpr int kMostRepeats = 12;
  constexpr double kTolerance = 1e-9;
  const Eigen::MatrixXd products = group(inside, inside);
  const Eigen::VectorXd alone = inverse * group.col(group.cols() - 1)(inside);
  Eigen::VectorXd move = alone;
  Eigen::VectorXd next(alone.size());
  for (int repeat = 0; repeat < kMostRepeats; ++repeat) {
    next.noalias() = inverse * (products * move);
    next += alone;
    // Number by number, as they differ in size.
    const bool is_settled = ((next - move).array().abs() <= kTolerance * next.array().abs()).all();
    move.swap(next);
    if (is_settled) return move;
  }
  const Eigen::MatrixXd left =
      Eigen::MatrixXd::Identity(products.rows(), products.cols()) - inverse * products;
  return left.partialPivLu().solve(alone);
}

Eigen::MatrixXd jackknife(const std::vector<Eigen::MatrixXd>& groups, const Eigen::MatrixXd& inverse,
                          const std::vector<Eigen::Index>& inside) {
  Eigen::MatrixXd moves(inverse.rows(), static_cast<Eigen::Index>(groups.size()));
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t k) {
    moves.col(static_cast<Eigen::Index>(k)) = move_without(groups[k], inverse, inside);
  });
  const auto count = static_cast<double>(groups.size());
  return (count - 1.0) / count * moves * moves.transpose();
}

// Along an unseen direction the solution may stand anywhere in the ranges. Numbers that take a part in it too
// small to call them unidentifiable are uncertain by that part of their scale all the same: even over
// plus/minus one scale, whose variance is 1/3.
void add_drift(const Parametrisation& parametrisation, std::span<const double> x,
               const Identifiability& identifiability, const std::vector<Eigen::Index>& inside,
               Eigen::MatrixXd& covariance) {
  for (const Eigen::Index k : inside) {
    const auto at = static_cast<std::size_t>(k);
    const double scale = parametrisation.scale(at, x[at]);
    covariance(k, k) += identifiability.unseen(k, k) * scale * scale / 3.0;
  }
}

// The numbers of a public parameter: itself, or the products that it makes with its tint.
struct Numbers {
  std::vector<std::size_t> at;
  bool is_tint = false;
};

Numbers numbers_of(const Parametrisation& parametrisation, const std::string& name) {
  Numbers numbers;
  for (std::size_t k = 0; k < parametrisation.size(); ++k) {
    const FreeParameter& parameter = parametrisation.free[k];
    if (parameter.parameter != name && parameter.tint != name) continue;
    numbers.at.push_back(k);
    numbers.is_tint = parameter.tint == name;
  }
  return numbers;
}

using Error = std::optional<double>;

// Nothing where the variance is no number.
Error root(double variance) {
  return std::isfinite(variance) && variance >= 0.0 ? Error(std::sqrt(variance)) : std::nullopt;
}

class Propagation {
 public:
  Propagation(std::span<const double> x, const Uncertainty& uncertainty) : x_(x), uncertainty_(uncertainty) {}

  Error of_number(std::size_t k) const {
    return uncertainty_.known[k] ? root(covariance(k, k)) : std::nullopt;
  }

  std::size_t largest(const std::vector<std::size_t>& at) const {
    return *std::ranges::max_element(at, {}, [&](std::size_t k) { return std::abs(x_[k]); });
  }

  // Of x[k] / x[m].
  Error of_share(std::size_t k, std::size_t m) const {
    if (k == m || x_[m] == 0.0 || !uncertainty_.known[k]) return std::nullopt;
    const double by_k = 1.0 / x_[m];
    const double by_m = -x_[k] / (x_[m] * x_[m]);
    return root(by_k * by_k * covariance(k, k) + by_m * by_m * covariance(m, m) +
                2.0 * by_k * by_m * covariance(k, m));
  }

 private:
  double covariance(std::size_t a, std::size_t b) const {
    return uncertainty_.covariance(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
  }

  std::span<const double> x_;
  const Uncertainty& uncertainty_;
};

}  // namespace

Eigen::MatrixXd inverse_of_gram(const Eigen::MatrixXd& gram, const Eigen::VectorXd& scale) {
  const Eigen::Index n = gram.rows();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * gram * scale.asDiagonal();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, n);
  if (n == 0 || !scaled.allFinite() || scaled.isZero(0.0)) return inverse;
  std::vector<double> block(static_cast<std::size_t>(n), 0.0);
  ceres::Problem linear;
  linear.AddResidualBlock(new LinearCost(root_of(scaled)), nullptr, block.data());
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;
  options.null_space_rank = -1;  // as many directions as are unseen
  // Ceres compares squares of singular values.
  options.min_reciprocal_condition_number = kSingularThreshold * kSingularThreshold;
  options.num_threads = 1;
  options.apply_loss_function = false;
  ceres::Covariance covariance(options);
  const std::vector<std::pair<const double*, const double*>> blocks = {{block.data(), block.data()}};
  if (!covariance.Compute(blocks, &linear)) return inverse;
  RowMajor rows(n, n);
  covariance.GetCovarianceBlock(block.data(), block.data(), rows.data());
  return rows;
}

Uncertainty estimate_uncertainty(const Problem& problem, std::span<const double> x, const Box& box,
                                 const Identifiability& identifiability) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Uncertainty result = {Eigen::MatrixXd::Zero(n, n), std::vector<bool>(x.size(), false)};
  const std::vector<Eigen::Index> inside = moving_inside(x, box, identifiability);
  if (inside.empty()) return result;
  const std::vector<Eigen::MatrixXd> groups = problem.curvature_by_group(x, kMostGroups);
  Eigen::MatrixXd total = groups.front();
  for (std::size_t k = 1; k < groups.size(); ++k) total += groups[k];
  const Eigen::VectorXd scale = scales_of(problem.parametrisation(), x, inside);
  const Eigen::MatrixXd inverse =
      scale.asDiagonal() * inverse_of_gram(total(inside, inside), scale) * scale.asDiagonal();
  result.covariance(inside, inside) = jackknife(groups, inverse, inside);
  add_drift(problem.parametrisation(), x, identifiability, inside, result.covariance);
  for (const Eigen::Index k : inside) {
    const auto at = static_cast<std::size_t>(k);
    result.known[at] = identifiability.status[at] == Status::kOk && std::isfinite(result.covariance(k, k));
  }
  return result;
}

void add_standard_errors(const Parametrisation& parametrisation, std::span<const double> x,
                         const Uncertainty& uncertainty, std::vector<ParameterState>& states) {
  const Propagation propagation(x, uncertainty);
  for (ParameterState& state : states) {
    state.standard_error.clear();
    const Numbers numbers = numbers_of(parametrisation, state.name);
    if (numbers.at.empty()) continue;
    const bool is_product = !parametrisation.free[numbers.at.front()].tint.empty();
    const std::size_t largest = propagation.largest(numbers.at);
    if (is_product && !numbers.is_tint) {
      state.standard_error.push_back(propagation.of_number(largest));
      continue;
    }
    for (const std::size_t k : numbers.at) {
      state.standard_error.push_back(numbers.is_tint ? propagation.of_share(k, largest)
                                                     : propagation.of_number(k));
    }
  }
}

}  // namespace brdfit::fit
