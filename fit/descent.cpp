// Levenberg-Marquardt on Gram matrices.
#include "fit/descent.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace brdfit::fit {
namespace {

constexpr double kFirstDamping = 1e-2;
constexpr double kLeastDamping = 1e-9;
constexpr double kMostDamping = 1e6;
constexpr double kRelax = 0.1;
constexpr double kTighten = 8.0;

// A damped step from x that ends in the box.
class Step {
 public:
  Step(const Eigen::MatrixXd& gram, const std::vector<double>& x, const Box& box)
      : n_(gram.rows() - 1), gram_(gram), x_(x), box_(box), step_(Eigen::VectorXd::Zero(n_)) {
    for (Eigen::Index k = 0; k < n_; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const double gradient = gram(k, n_);
      const bool pressed =
          (x[at] <= box.lower[at] && gradient > 0.0) || (x[at] >= box.upper[at] && gradient < 0.0);
      if (box.moves[at] && !pressed && gram(k, k) > 0.0) moving_.push_back(k);
    }
  }

  std::vector<double> end(double damping) {
    step_.setZero();
    std::vector<Eigen::Index> moving = moving_;
    while (!moving.empty()) {
      solve(moving, damping);
      if (std::erase_if(moving, [&](Eigen::Index k) { return stops_at_bound(k); }) == 0) break;
    }
    std::vector<double> end = x_;
    for (std::size_t k = 0; k < end.size(); ++k) {
      end[k] = std::clamp(end[k] + step_[static_cast<Eigen::Index>(k)], box_.lower[k], box_.upper[k]);
    }
    return end;
  }

 private:
  // The step of the moving numbers, the others' given.
  void solve(const std::vector<Eigen::Index>& moving, double damping) {
    for (const Eigen::Index k : moving) step_[k] = 0.0;
    Eigen::MatrixXd normal = gram_(moving, moving);
    Eigen::VectorXd right(static_cast<Eigen::Index>(moving.size()));
    for (std::size_t k = 0; k < moving.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(k);
      right[at] = -gram_(moving[k], n_) - gram_.row(moving[k]).head(n_).dot(step_);
      normal(at, at) *= 1.0 + damping;
    }
    const Eigen::VectorXd solution = normal.ldlt().solve(right);
    for (std::size_t k = 0; k < moving.size(); ++k) {
      const double value = solution[static_cast<Eigen::Index>(k)];
      step_[moving[k]] = std::isfinite(value) ? value : 0.0;
    }
  }

  bool stops_at_bound(Eigen::Index k) {
    const auto at = static_cast<std::size_t>(k);
    const double target = x_[at] + step_[k];
    if (target >= box_.lower[at] && target <= box_.upper[at]) return false;
    step_[k] = std::clamp(target, box_.lower[at], box_.upper[at]) - x_[at];
    return true;
  }

  Eigen::Index n_;
  const Eigen::MatrixXd& gram_;
  const std::vector<double>& x_;
  const Box& box_;
  Eigen::VectorXd step_;
  std::vector<Eigen::Index> moving_;
};

}  // namespace

Solution descend(const Problem& problem, const std::vector<double>& x, const Box& box,
                 const DescentOptions& options) {
  Solution solution;
  solution.x = x;
  for (std::size_t k = 0; k < x.size(); ++k) solution.x[k] = std::clamp(x[k], box.lower[k], box.upper[k]);
  Eigen::MatrixXd gram = problem.gram(solution.x, &solution.cost);
  solution.evaluations = 1;
  double damping = kFirstDamping;
  int small_steps = 0;
  while (solution.evaluations < options.max_evaluations && damping < kMostDamping && small_steps < 2) {
    const std::vector<double> next = Step(gram, solution.x, box).end(damping);
    if (next == solution.x) break;
    double cost = 0.0;
    Eigen::MatrixXd next_gram = problem.gram(next, &cost);
    ++solution.evaluations;
    if (!(cost < solution.cost) || !next_gram.allFinite()) {
      damping *= kTighten;
      continue;
    }
    small_steps = solution.cost - cost < options.tolerance * solution.cost ? small_steps + 1 : 0;
    solution.x = next;
    solution.cost = cost;
    gram = std::move(next_gram);
    damping = std::max(damping * kRelax, kLeastDamping);
    ++solution.iterations;
  }
  solution.converged = small_steps >= 2 || damping >= kMostDamping;
  solution.termination = solution.converged ? "CONVERGENCE" : "NO_CONVERGENCE";
  return solution;
}

}  // namespace brdfit::fit
