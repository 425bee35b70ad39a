// What the samples say about each parameter: at a bound, unidentifiable, tied to another.
#ifndef BRDFIT_FIT_IDENTIFIABILITY_H_
#define BRDFIT_FIT_IDENTIFIABILITY_H_

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fit/parameters.h"

namespace brdfit::fit {

enum class Status { kOk, kAtLowerBound, kAtUpperBound, kUnidentifiable, kFixed };

std::string_view name_of(
    Status status);  // "ok", "at lower bound", "at upper bound", "unidentifiable", "fixed"

// The state of a public parameter after a fit. Of several components the most telling status counts:
// unidentifiable, then at a bound, then ok.
struct ParameterState {
  std::string name;
  Status status = Status::kOk;
  std::vector<Status> components;
  // One per component, or a single one; none where the samples do not say or where the value is at a bound.
  std::vector<std::optional<double>> standard_error = {};
  std::string reason = {};  // why it is unidentifiable, in words; empty otherwise
};

// Two free numbers whose estimates move together.
struct CorrelatedPair {
  std::string first;
  std::string second;
  double correlation = 0.0;
};

struct Identifiability {
  // Per free number of the parametrisation.
  std::vector<Status> status;
  // Singular values of the scaled Jacobian of the numbers away from bounds, relative to the largest;
  // descending.
  std::vector<double> relative_singular_values;
  std::vector<CorrelatedPair> correlated;  // |correlation| above 0.95
  // The projection onto unseen directions of scaled numbers; 0 in rows and columns of those at bounds.
  Eigen::MatrixXd unseen;
};

// A direction counts as unseen when its singular value is below this share of the largest.
inline constexpr double kSingularThreshold = 1e-4;
// The least part of a scaled number in unseen directions at which it is unidentifiable.
inline constexpr double kVisiblePart = 0.01;

// gram: [J r]^T [J r] at x (fit/problem.h). Columns are scaled by Parametrisation::scale. A number at a bound
// has that status and stays out of the Jacobian, unless its own column is as good as 0: then it is
// unidentifiable. So is one that takes a visible part (a hundredth or more) in an unseen direction. Numbers
// that are held (none where empty) are kFixed and stay out.
Identifiability identify(const Parametrisation& parametrisation, std::span<const double> x,
                         const Eigen::MatrixXd& gram, const std::vector<bool>& held = {});

// Per public parameter of the model whose effect is on, in the order of its table.
std::vector<ParameterState> public_states(const Parametrisation& parametrisation, std::span<const double> x,
                                          const Identifiability& identifiability);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_IDENTIFIABILITY_H_
