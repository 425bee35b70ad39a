// Which parameters a table can tell, by an independent test: the singular values of the Jacobian of the
// log-ratio residuals at the true material.
#ifndef BRDFIT_TESTS_TRUE_JACOBIAN_H_
#define BRDFIT_TESTS_TRUE_JACOBIAN_H_

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <string>
#include <vector>

#include "measured/sampling.h"
#include "tests/product_jets.h"

namespace brdfit::testing_support {

// An entry of the product form that a fit with all tiers and effects moves.
struct TrueParameter {
  ProductEntry entry;
  std::size_t at;  // in the product form
  double value;
  double scale;          // the width of its range; of an intensity its own size
  double visible = 0.0;  // see test_identifiability
  // Standard deviation in units of the scale, for one observation of which the logarithm has deviation 1.
  double deviation = 0.0;
};

inline std::vector<TrueParameter> free_entries(const Material& truth) {
  const std::vector<ProductEntry> layout = product_layout(truth.model());
  const std::vector<double> q = product_form(truth);
  std::vector<TrueParameter> result;
  for (std::size_t k = 0; k < layout.size(); ++k) {
    const ParameterInfo& info = *find_parameter(truth.model(), layout[k].parameter);
    if (!truth.effects().has(info.effect)) continue;
    const bool by_size = info.name == "diffuse_fresnel" || info.name == "retroreflection";
    result.push_back({layout[k], k, q[k], by_size ? q[k] : info.upper - info.lower});
  }
  return result;
}

// Rows: channels of observations; columns: parameters, each in its scale.
inline Eigen::MatrixXd log_jacobian(const Material& truth, const SampleSet& samples,
                                    const std::vector<TrueParameter>& parameters) {
  const std::vector<double> q = product_form(truth);
  Eigen::MatrixXd jacobian(static_cast<Eigen::Index>(3 * samples.size()),
                           static_cast<Eigen::Index>(parameters.size()));
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    for (const Sloped& channel : sloped_mean(truth, q, geometry_of(samples, k))) {
      const double factor = std::sqrt(samples.weight()[k]) / (channel.value + 1e-3);
      for (std::size_t p = 0; p < parameters.size(); ++p) {
        jacobian(row, static_cast<Eigen::Index>(p)) =
            factor * parameters[p].scale * channel.slope[static_cast<Eigen::Index>(parameters[p].at)];
      }
      ++row;
    }
  }
  return jacobian;
}

// The free entries of a material's product form, and what samples of its table say of each.
//
// visible: how much the residuals change when the entry moves by its scale and all others make up for it as
// well as they can, as a share of the largest singular value. It is the smallest relative singular value that
// the entry depends on: 1 / (largest singular value * deviation).
inline std::vector<TrueParameter> test_identifiability(const Material& truth, const SampleSet& samples) {
  std::vector<TrueParameter> parameters = free_entries(truth);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(log_jacobian(truth, samples, parameters));
  const auto n = static_cast<Eigen::Index>(parameters.size());
  const Eigen::MatrixXd upper = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(upper, Eigen::ComputeFullV);
  const double largest = svd.singularValues()[0];
  // Rounding keeps a singular value that should be 0 from being so.
  const Eigen::VectorXd singular = svd.singularValues().cwiseMax(1e-15 * largest);
  for (Eigen::Index p = 0; p < n; ++p) {
    TrueParameter& parameter = parameters[static_cast<std::size_t>(p)];
    parameter.deviation = svd.matrixV().row(p).transpose().cwiseQuotient(singular).norm();
    parameter.visible = 1.0 / (largest * parameter.deviation);
  }
  return parameters;
}

}  // namespace brdfit::testing_support

#endif  // BRDFIT_TESTS_TRUE_JACOBIAN_H_
