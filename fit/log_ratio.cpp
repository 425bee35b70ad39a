// Evaluating a material over samples.
#include "fit/log_ratio.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "brdf/models.h"
#include "brdf/simd/dispatch.h"
#include "fit/loss_kernel.h"

namespace brdfit::fit {

std::vector<double> log_ratios_pct(const Material& material, const SampleSet& samples) {
  const simd::Coefficients coefficients = simd::coefficients_of(material);
  const simd::EvalColumns evaluate = simd::eval_columns(simd::best_isa());
  const std::size_t n = samples.padded_size();
  const auto f_cos = [&](const simd::GeometryColumns& geometry) {
    std::vector<double> columns(3 * n);
    double* const out[3] = {columns.data(), columns.data() + n, columns.data() + 2 * n};
    evaluate(coefficients, geometry, n, out);
    return columns;
  };
  std::vector<double> y = f_cos(samples.geometry());
  if (samples.has_two_orders() && !is_reciprocal(material)) {
    // A stored cell is the mean of both orders.
    simd::GeometryColumns swapped = samples.geometry();
    std::swap(swapped.cos_i, swapped.cos_o);
    const std::vector<double> other = f_cos(swapped);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < n; ++k) {
        const double to_cos_i = samples.cos_i()[k] / samples.cos_o()[k];
        y[c * n + k] = 0.5 * (y[c * n + k] + other[c * n + k] * to_cos_i);
      }
    }
  }
  std::vector<double> result(samples.size(), 0.0);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto f = samples.f(static_cast<int>(c));
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const double r = f[k] * samples.cos_i()[k];
      result[k] += 100.0 / 3.0 * std::abs(std::log((y[c * n + k] + kLogFloor) / (r + kLogFloor)));
    }
  }
  return result;
}

double log_ratio_pct(const Material& material, const SampleSet& samples) {
  const std::vector<double> errors = log_ratios_pct(material, samples);
  return std::inner_product(errors.begin(), errors.end(), samples.weight().begin(), 0.0);
}

}  // namespace brdfit::fit
