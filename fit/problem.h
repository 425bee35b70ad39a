// The least-squares problem of a fit: a model's residuals over samples, reduced to a triangular factor.
//
// Ceres sees a residual vector of one entry more than there are parameters, r' = R_r, with the Jacobian J' =
// R_J, where R^T R = [J r]^T [J r] over all samples: the same cost, gradient and Gauss-Newton matrix at a
// fraction of the memory and time. The factor is exact wherever a cost and its derivatives are asked for
// together; where the cost alone is, r' has the right length and no more, which is all that Ceres uses.
#ifndef BRDFIT_FIT_PROBLEM_H_
#define BRDFIT_FIT_PROBLEM_H_

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "brdf/simd/dispatch.h"
#include "fit/gram.h"
#include "fit/loss.h"
#include "fit/parameters.h"
#include "measured/sampling.h"

namespace brdfit::fit {

// Observations as residuals want them: transformed targets and roots of weights.
struct Targets {
  std::vector<double> sqrt_weight;
  std::vector<double> value[3];
  std::vector<double> clipped[3];     // min(f, 1)
  std::vector<double> clipped_share;  // of that residual; see LossShape
  double robust_width = 0.0;
  double clipped_width = 0.0;
};
Targets make_targets(const SampleSet& samples, Loss loss);

// In which numbers Gram matrices are summed. Single precision is for a search, which does not see the
// difference: twice the lanes, products good to about 1e-5 of their size. Losses for which there is no such
// code are summed in double precision.
enum class Precision { kDouble, kSingle };

// Cost and derivatives over one set of samples. Holds references to all of its arguments.
class Problem {
 public:
  Problem(const Parametrisation& parametrisation, const SampleSet& samples, const Targets& targets, Loss loss,
          Precision precision = Precision::kDouble);

  std::size_t parameter_count() const { return parametrisation_.size(); }
  const Parametrisation& parametrisation() const { return parametrisation_; }

  // The cost at x: half of the weighted sum of squared residuals, large ones counted less where the loss says
  // so. In double precision always.
  double cost(std::span<const double> x) const;

  // [J r]^T [J r] at x, of side parameter_count() + 1, the residual last; *cost (when not null) is the cost
  // there.
  Eigen::MatrixXd gram(std::span<const double> x, double* cost = nullptr) const;

  // The same with GramJob::curvature: in place of J^T J how fast the gradient changes, as far as the
  // residuals are linear.
  Eigen::MatrixXd curvature(std::span<const double> x) const;

  // Its parts, which sum to it, from at most most_groups groups of consecutive samples (of a table: of
  // neighbours), at least eight in each.
  std::vector<Eigen::MatrixXd> curvature_by_group(std::span<const double> x, std::size_t most_groups) const;

 private:
  GramJob job() const;  // without values of coefficients
  Gram sum_of(const GramJob& job) const;

  const Parametrisation& parametrisation_;
  const SampleSet& samples_;
  const Targets& targets_;
  Loss loss_;
  bool has_two_orders_;
  std::vector<float> single_;  // as GramJob::single; empty in double precision
  GramFunction gram_function_;
  CostFunction cost_function_;
};

// The vector code behind a Problem, for tests and benchmarks of it.
GramFunction gram_function(simd::Isa isa);
CostFunction cost_function(simd::Isa isa);

// The columns of a job as GramJob::single, job.count apart.
std::vector<float> single_columns(const GramJob& job);

// d(coefficients of channel c)/dq, rows in the order of fit/gram.h, columns in that of the product form.
Eigen::MatrixXd coefficient_jacobian(const Material& options, std::span<const double> q, int channel);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_PROBLEM_H_
