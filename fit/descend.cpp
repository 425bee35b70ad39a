// Damped steps that respect bounds.
#include "fit/descend.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace brdfit::fit {
namespace {

// Ceres' rules (Madsen et al. 2004, Methods for non-linear least squares problems): a step that does what the
// quadratic model said lowers the damping, one that fails raises it faster each time.
class Damping {
 public:
  explicit Damping(double first) : value_(first) {}

  double value() const { return value_; }
  void accept(double quality) {
    value_ = std::max(value_ * std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * quality - 1.0, 3)), 1e-12);
    growth_ = 2.0;
  }
  void reject() {
    value_ *= growth_;
    growth_ *= 2.0;
  }

 private:
  double value_;
  double growth_ = 2.0;
};

class Descent {
 public:
  Descent(const Problem& problem, const std::vector<double>& x, const Box& box)
      : problem_(problem), box_(box), x_(x) {
    for (std::size_t k = 0; k < x_.size(); ++k) {
      if (box_.moves[k]) x_[k] = std::clamp(x_[k], box_.lower[k], box_.upper[k]);
    }
    gram_ = problem_.gram(x_, &cost_);
  }

  Solution run(const DescentOptions& options) {
    Damping damping(options.damping);
    Solution solution;
    solution.evaluations = 1;
    solution.termination = "stopped";
    for (; solution.iterations < options.max_iterations; ++solution.iterations) {
      const std::vector<double> trial = step(damping.value());
      if (trial == x_) break;
      double cost = 0.0;
      Eigen::MatrixXd gram = problem_.gram(trial, &cost);
      ++solution.evaluations;
      // A step that bounds have cut need not go down even in the quadratic model. Conditions are written so
      // that what is not a number is rejected.
      const double expected = expected_decrease(trial);
      const double quality = expected > 0.0 ? (cost_ - cost) / expected : 0.0;
      if (!(quality > kLeastQuality)) {
        if (damping.value() > 1e8) break;
        damping.reject();
        continue;
      }
      damping.accept(quality);
      const bool is_flat = cost_ - cost <= options.function_tolerance * cost_;
      const int left = options.max_iterations - solution.iterations - 1;
      const bool is_hopeless = cost - left * (cost_ - cost) > options.goal;
      x_ = trial;
      cost_ = cost;
      gram_ = std::move(gram);
      if (is_flat) {
        solution.converged = true;
        break;
      }
      if (is_hopeless) break;
    }
    solution.x = x_;
    solution.cost = cost_;
    return solution;
  }

 private:
  double gradient(std::size_t k) const { return gram_(static_cast<Eigen::Index>(k), gram_.cols() - 1); }

  // Parameters that move and do not press against a bound.
  std::vector<Eigen::Index> free_ones() const {
    std::vector<Eigen::Index> result;
    for (std::size_t k = 0; k < x_.size(); ++k) {
      if (!box_.moves[k]) continue;
      const double g = gradient(k);
      if ((x_[k] <= box_.lower[k] && g > 0.0) || (x_[k] >= box_.upper[k] && g < 0.0)) continue;
      result.push_back(static_cast<Eigen::Index>(k));
    }
    return result;
  }

  // The minimum of the damped quadratic model; where it lies outside the box, what crosses a bound is put
  // there and the rest solved again.
  std::vector<double> step(double damping) const {
    std::vector<double> trial = x_;
    std::vector<Eigen::Index> inside = free_ones();
    Eigen::VectorXd rest = gram_.col(gram_.cols() - 1);
    while (!inside.empty()) {
      Eigen::MatrixXd matrix = gram_(inside, inside);
      for (Eigen::Index k = 0; k < matrix.rows(); ++k) {
        matrix(k, k) += damping * std::max(matrix(k, k), kLeastDiagonal);
      }
      const Eigen::VectorXd move = matrix.llt().solve(-rest(inside));
      std::vector<Eigen::Index> still_inside;
      for (std::size_t j = 0; j < inside.size(); ++j) {
        const auto k = static_cast<std::size_t>(inside[j]);
        const double to = x_[k] + move[static_cast<Eigen::Index>(j)];
        trial[k] = std::clamp(to, box_.lower[k], box_.upper[k]);
        if (trial[k] == to) {
          still_inside.push_back(inside[j]);
        } else {
          rest += gram_.col(inside[j]) * (trial[k] - x_[k]);
        }
      }
      if (still_inside.size() == inside.size()) break;
      inside = std::move(still_inside);
    }
    return trial;
  }

  // By which the quadratic model without damping falls.
  double expected_decrease(const std::vector<double>& trial) const {
    const auto n = static_cast<Eigen::Index>(x_.size());
    const Eigen::VectorXd move =
        Eigen::Map<const Eigen::VectorXd>(trial.data(), n) - Eigen::Map<const Eigen::VectorXd>(x_.data(), n);
    return -move.dot(gram_.col(n).head(n)) - 0.5 * move.dot(gram_.topLeftCorner(n, n) * move);
  }

  static constexpr double kLeastDiagonal = 1e-9;
  static constexpr double kLeastQuality = 1e-3;

  const Problem& problem_;
  const Box& box_;
  std::vector<double> x_;
  Eigen::MatrixXd gram_;
  double cost_ = 0.0;
};

}  // namespace

Solution descend(const Problem& problem, const std::vector<double>& x, const Box& box,
                 const DescentOptions& options) {
  return Descent(problem, x, box).run(options);
}

}  // namespace brdfit::fit
