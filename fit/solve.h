// Minimising a problem with Ceres: bounds, pinning of parameters that stay at them, convergence as data.
#ifndef BRDFIT_FIT_SOLVE_H_
#define BRDFIT_FIT_SOLVE_H_

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "fit/problem.h"

namespace brdfit::fit {

// Where an optimisation stopped. Non-convergence is data, not an exception.
struct Solution {
  std::vector<double> x;
  double cost = 0.0;
  int iterations = 0;
  int evaluations = 0;      // of cost or Gram matrix
  bool converged = false;   // by Ceres' own tests
  std::string termination;  // in words
};

struct SolveOptions {
  int max_iterations = 200;
  // Ceres stops when a step changes the cost by less than this share of it.
  double function_tolerance = 1e-6;
  double gradient_tolerance = 1e-14;
  double parameter_tolerance = 1e-12;
  double initial_trust_region_radius = 1e4;
};

// Bounds and moving parameters of one solve; the parametrisation's own where empty.
struct Box {
  std::vector<double> lower;
  std::vector<double> upper;
  std::vector<bool> moves;  // false: held at the start
};
Box full_box(const Parametrisation& parametrisation);

// What can be minimised: half of a sum of squares at x, and [J r]^T [J r] with the residual last (with the
// cost where asked for), as Problem has them.
struct Objective {
  std::function<double(std::span<const double>)> cost;
  std::function<Eigen::MatrixXd(std::span<const double>, double*)> gram;
};

Solution solve(const Objective& objective, const std::vector<double>& x, const Box& box,
               const SolveOptions& options);
Solution solve_pinning(const Objective& objective, const std::vector<double>& x, const Box& box,
                       const SolveOptions& options);

// One run of Ceres from x, inside the box.
Solution solve(const Problem& problem, const std::vector<double>& x, const Box& box,
               const SolveOptions& options);

// Runs of Ceres in which parameters that rest at a bound with the cost falling outwards are held there, until
// holding them is right for all: at the end none wants to leave its bound. Converges where plain steps that
// are cut off at bounds crawl.
Solution solve_pinning(const Problem& problem, const std::vector<double>& x, const Box& box,
                       const SolveOptions& options);

// Keeps Ceres' logging library from writing to stderr. Call once before the first solve.
void silence_solver_logging();

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_SOLVE_H_
