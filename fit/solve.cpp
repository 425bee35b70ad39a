// Ceres on the reduced problem.
#include "fit/solve.h"

#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <glog/logging.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace brdfit::fit {
namespace {

// The square factor of a Gram matrix G = R^T R, semidefinite or not quite.
Eigen::MatrixXd factor(const Eigen::MatrixXd& gram) {
  const Eigen::LDLT<Eigen::MatrixXd> ldlt(gram);
  const Eigen::VectorXd roots = ldlt.vectorD().cwiseMax(0.0).cwiseSqrt();
  const Eigen::MatrixXd upper = roots.asDiagonal() * Eigen::MatrixXd(ldlt.matrixU());
  // G = P^T L D L^T P, so R = D^1/2 L^T P, written as (P^T (D^1/2 L^T)^T)^T: transpositions from the right
  // apply in the wrong order for this.
  return (ldlt.transpositionsP().transpose() * upper.transpose().eval()).transpose();
}

// An objective as Ceres sees it: one block of the parameters that move.
class ReducedCost : public ceres::CostFunction {
 public:
  ReducedCost(const Objective& objective, std::vector<double> x, std::vector<std::size_t> moving)
      : objective_(objective), x_(std::move(x)), moving_(std::move(moving)) {
    set_num_residuals(static_cast<int>(moving_.size()) + 2);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(moving_.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    std::vector<double> x = x_;
    for (std::size_t k = 0; k < moving_.size(); ++k) x[moving_[k]] = parameters[0][k];
    const auto n = static_cast<Eigen::Index>(moving_.size());
    Eigen::Map<Eigen::VectorXd> r(residuals, n + 2);
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      const double cost = objective_.cost(x);
      r.setZero();
      r[n + 1] = std::sqrt(2.0 * std::max(cost, 0.0));
      return std::isfinite(cost);
    }
    double cost = 0.0;
    const Eigen::MatrixXd all = objective_.gram(x, &cost);
    std::vector<Eigen::Index> picked(moving_.begin(), moving_.end());
    picked.push_back(all.rows() - 1);
    const Eigen::MatrixXd gram = all(picked, picked);
    if (!gram.allFinite()) return false;
    const Eigen::MatrixXd root = factor(gram);
    r.head(n + 1) = root.col(n);
    // What the robust cost has over half the squares: a constant for the step, but not for the cost.
    r[n + 1] = std::sqrt(std::max(2.0 * cost - root.col(n).squaredNorm(), 0.0));
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor> jacobian(jacobians[0], n + 2, n);
    jacobian.topRows(n + 1) = root.leftCols(n);
    jacobian.row(n + 1).setZero();
    return true;
  }

 private:
  const Objective& objective_;
  std::vector<double> x_;
  std::vector<std::size_t> moving_;
};

std::vector<std::size_t> moving_indices(const Box& box) {
  std::vector<std::size_t> moving;
  for (std::size_t k = 0; k < box.moves.size(); ++k) {
    if (box.moves[k]) moving.push_back(k);
  }
  return moving;
}

// Whether x rests at an end of its range and a step along -gradient would leave it.
bool is_pinned(double x, double gradient, double lower, double upper) {
  const double margin = 1e-9 * (upper - lower);
  return (x <= lower + margin && gradient > 0.0) || (x >= upper - margin && gradient < 0.0);
}

Eigen::VectorXd gradient_at(const Objective& objective, const std::vector<double>& x) {
  const Eigen::MatrixXd gram = objective.gram(x, nullptr);
  return gram.col(gram.cols() - 1).head(gram.rows() - 1);
}

Objective objective_of(const Problem& problem) {
  return {[&problem](std::span<const double> x) { return problem.cost(x); },
          [&problem](std::span<const double> x, double* cost) { return problem.gram(x, cost); }};
}

}  // namespace

Box full_box(const Parametrisation& parametrisation) {
  Box box;
  for (const FreeParameter& parameter : parametrisation.free) {
    box.lower.push_back(parameter.lower);
    box.upper.push_back(parameter.upper);
    box.moves.push_back(true);
  }
  return box;
}

Solution solve(const Objective& objective, const std::vector<double>& x, const Box& box,
               const SolveOptions& options) {
  Solution solution;
  solution.x = x;
  const std::vector<std::size_t> moving = moving_indices(box);
  if (moving.empty()) {
    solution.cost = objective.cost(x);
    solution.converged = true;
    solution.termination = "nothing to fit";
    return solution;
  }
  std::vector<double> block;
  for (const std::size_t k : moving) block.push_back(std::clamp(x[k], box.lower[k], box.upper[k]));
  ceres::Problem reduced;
  reduced.AddResidualBlock(new ReducedCost(objective, x, moving), nullptr, block.data());
  for (std::size_t k = 0; k < moving.size(); ++k) {
    reduced.SetParameterLowerBound(block.data(), static_cast<int>(k), box.lower[moving[k]]);
    reduced.SetParameterUpperBound(block.data(), static_cast<int>(k), box.upper[moving[k]]);
  }
  ceres::Solver::Options ceres_options;
  ceres_options.linear_solver_type = ceres::DENSE_QR;
  ceres_options.max_num_iterations = options.max_iterations;
  ceres_options.function_tolerance = options.function_tolerance;
  ceres_options.gradient_tolerance = options.gradient_tolerance;
  ceres_options.parameter_tolerance = options.parameter_tolerance;
  ceres_options.initial_trust_region_radius = options.initial_trust_region_radius;
  // A line search along steps that bounds cut costs two more evaluations a step and gains nothing here.
  ceres_options.max_num_line_search_step_size_iterations = 0;
  ceres_options.num_threads = 1;
  ceres_options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(ceres_options, &reduced, &summary);
  for (std::size_t k = 0; k < moving.size(); ++k) solution.x[moving[k]] = block[k];
  solution.cost = summary.final_cost;
  solution.iterations = static_cast<int>(summary.iterations.size());
  solution.evaluations = summary.num_residual_evaluations;
  solution.converged = summary.termination_type == ceres::CONVERGENCE;
  solution.termination = ceres::TerminationTypeToString(summary.termination_type);
  return solution;
}

Solution solve_pinning(const Objective& objective, const std::vector<double>& x, const Box& box,
                       const SolveOptions& options) {
  // Few steps with everything free show which parameters press against their bounds.
  constexpr int kFirstIterations = 12;
  constexpr int kRounds = 8;
  SolveOptions first = options;
  first.max_iterations = std::min(options.max_iterations, kFirstIterations);
  Solution best = solve(objective, x, box, first);
  int iterations = best.iterations;
  int evaluations = best.evaluations;
  std::vector<bool> moved = box.moves;
  for (int round = 0; round < kRounds && iterations < options.max_iterations; ++round) {
    const Eigen::VectorXd gradient = gradient_at(objective, best.x);
    Box active = box;
    for (std::size_t k = 0; k < best.x.size(); ++k) {
      if (is_pinned(best.x[k], gradient[static_cast<Eigen::Index>(k)], box.lower[k], box.upper[k])) {
        active.moves[k] = false;
      }
    }
    if (best.converged && active.moves == moved) break;
    SolveOptions rest = options;
    rest.max_iterations = options.max_iterations - iterations;
    best = solve(objective, best.x, active, rest);
    moved = active.moves;
    iterations += best.iterations;
    evaluations += best.evaluations;
  }
  best.iterations = iterations;
  best.evaluations = evaluations;
  return best;
}

Solution solve(const Problem& problem, const std::vector<double>& x, const Box& box,
               const SolveOptions& options) {
  return solve(objective_of(problem), x, box, options);
}

Solution solve_pinning(const Problem& problem, const std::vector<double>& x, const Box& box,
                       const SolveOptions& options) {
  return solve_pinning(objective_of(problem), x, box, options);
}

void silence_solver_logging() {
  // Ceres reports through its summary; what glog would print besides is not for users.
  FLAGS_minloglevel = google::GLOG_FATAL;
}

}  // namespace brdfit::fit
