// Singular values and correlations of a fit's Jacobian, from its Gram matrix.
#include "fit/identifiability.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace brdfit::fit {
namespace {

constexpr double kCorrelated = 0.95;

Status bound_status(const FreeParameter& parameter, double x) {
  const double margin = 1e-7 * (parameter.upper - parameter.lower);
  if (x <= parameter.lower + margin) return Status::kAtLowerBound;
  if (x >= parameter.upper - margin) return Status::kAtUpperBound;
  return Status::kOk;
}

// J^T J of the given numbers, each measured in its own scale.
Eigen::MatrixXd scaled_normal_matrix(const Parametrisation& parametrisation, std::span<const double> x,
                                     const Eigen::MatrixXd& gram, const std::vector<Eigen::Index>& inside) {
  const auto n = static_cast<Eigen::Index>(inside.size());
  Eigen::VectorXd scale(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto at = static_cast<std::size_t>(inside[static_cast<std::size_t>(k)]);
    scale[k] = parametrisation.scale(at, x[at]);
  }
  return scale.asDiagonal() * Eigen::MatrixXd(gram(inside, inside)) * scale.asDiagonal();
}

void mark_unseen(const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>& eigen,
                 const std::vector<Eigen::Index>& inside, Identifiability& result) {
  const Eigen::VectorXd singular = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const double largest = singular.maxCoeff();
  for (Eigen::Index k = singular.size() - 1; k >= 0; --k) {
    result.relative_singular_values.push_back(largest > 0.0 ? singular[k] / largest : 0.0);
  }
  const Eigen::VectorXd weight =
      (singular.array() > kSingularThreshold * largest)
          .select(Eigen::VectorXd::Zero(singular.size()), Eigen::VectorXd::Ones(singular.size()));
  const Eigen::MatrixXd unseen =
      eigen.eigenvectors() * weight.asDiagonal() * eigen.eigenvectors().transpose();
  result.unseen(inside, inside) = unseen;
  for (std::size_t row = 0; row < inside.size(); ++row) {
    const auto at = static_cast<Eigen::Index>(row);
    if (std::sqrt(std::max(unseen(at, at), 0.0)) > kVisiblePart) {
      result.status[static_cast<std::size_t>(inside[row])] = Status::kUnidentifiable;
    }
  }
}

// Numbers at bounds on which nothing depends.
void mark_inert(const Parametrisation& parametrisation, std::span<const double> x,
                const Eigen::MatrixXd& gram, double largest_square, Identifiability& result) {
  for (std::size_t k = 0; k < parametrisation.size(); ++k) {
    if (result.status[k] != Status::kAtLowerBound && result.status[k] != Status::kAtUpperBound) continue;
    const auto at = static_cast<Eigen::Index>(k);
    const double column_square = gram(at, at) * std::pow(parametrisation.scale(k, x[k]), 2);
    if (column_square <= kSingularThreshold * kSingularThreshold * largest_square) {
      result.status[k] = Status::kUnidentifiable;
    }
  }
}

void list_correlated(const Parametrisation& parametrisation,
                     const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>& eigen,
                     const std::vector<Eigen::Index>& inside, Identifiability& result) {
  const double floor = eigen.eigenvalues().maxCoeff() * 1e-15;
  const Eigen::VectorXd inverse = eigen.eigenvalues().cwiseMax(floor).cwiseInverse();
  const Eigen::MatrixXd covariance =
      eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
  for (Eigen::Index a = 0; a < covariance.rows(); ++a) {
    for (Eigen::Index b = a + 1; b < covariance.rows(); ++b) {
      // Rounding may take it beyond 1.
      const double correlation =
          std::clamp(covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b)), -1.0, 1.0);
      if (!(std::abs(correlation) > kCorrelated)) continue;
      const auto name = [&](Eigen::Index k) {
        return parametrisation.free[static_cast<std::size_t>(inside[static_cast<std::size_t>(k)])].name;
      };
      result.correlated.push_back({name(a), name(b), correlation});
    }
  }
}

// Whether all channels of number k's product are 0.
bool vanishes(const Parametrisation& parametrisation, std::span<const double> x, std::size_t k) {
  for (std::size_t j = 0; j < parametrisation.size(); ++j) {
    if (parametrisation.free[j].parameter == parametrisation.free[k].parameter && x[j] != 0.0) return false;
  }
  return true;
}

Status worse(Status a, Status b) {
  const auto rank = [](Status s) {
    switch (s) {
      case Status::kUnidentifiable:
        return 3;
      case Status::kAtLowerBound:
      case Status::kAtUpperBound:
        return 2;
      case Status::kOk:
        return 1;
      case Status::kFixed:
        return 0;
    }
    return 0;
  };
  return rank(b) > rank(a) ? b : a;
}

}  // namespace

std::string_view name_of(Status status) {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kAtLowerBound:
      return "at lower bound";
    case Status::kAtUpperBound:
      return "at upper bound";
    case Status::kUnidentifiable:
      return "unidentifiable";
    case Status::kFixed:
      return "fixed";
  }
  return "";
}

Identifiability identify(const Parametrisation& parametrisation, std::span<const double> x,
                         const Eigen::MatrixXd& gram, const std::vector<bool>& held) {
  Identifiability result;
  std::vector<Eigen::Index> inside;
  const auto n = static_cast<Eigen::Index>(parametrisation.size());
  result.unseen = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t k = 0; k < parametrisation.size(); ++k) {
    const bool is_held = !held.empty() && held[k];
    result.status.push_back(is_held ? Status::kFixed : bound_status(parametrisation.free[k], x[k]));
    if (result.status.back() == Status::kOk) inside.push_back(static_cast<Eigen::Index>(k));
  }
  if (inside.empty()) return result;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      scaled_normal_matrix(parametrisation, x, gram, inside));
  mark_unseen(eigen, inside, result);
  mark_inert(parametrisation, x, gram, eigen.eigenvalues().maxCoeff(), result);
  list_correlated(parametrisation, eigen, inside, result);
  return result;
}

std::vector<ParameterState> public_states(const Parametrisation& parametrisation, std::span<const double> x,
                                          const Identifiability& identifiability) {
  std::vector<ParameterState> states;
  const Material& material = parametrisation.start;
  for (const ParameterInfo& info : parameters_of(material.model())) {
    if (!material.effects().has(info.effect)) continue;
    ParameterState state = {std::string(info.name), Status::kFixed, {}};
    for (std::size_t k = 0; k < parametrisation.size(); ++k) {
      const FreeParameter& parameter = parametrisation.free[k];
      if (parameter.parameter == info.name) state.components.push_back(identifiability.status[k]);
      // A tint shares its products with its intensity; it is as unidentifiable as they are, and its own
      // bounds are those of a share, which the largest channel always meets.
      if (parameter.tint == info.name) {
        const bool is_dark = x[k] == 0.0;
        const bool unseen = identifiability.status[k] == Status::kUnidentifiable ||
                            (is_dark && vanishes(parametrisation, x, k));
        state.components.push_back(unseen    ? Status::kUnidentifiable
                                   : is_dark ? Status::kAtLowerBound
                                             : Status::kOk);
      }
    }
    for (const Status status : state.components) state.status = worse(state.status, status);
    states.push_back(std::move(state));
  }
  return states;
}

}  // namespace brdfit::fit
