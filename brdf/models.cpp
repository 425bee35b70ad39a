// Evaluation of materials: scalar through the double kernels, spans through vector code.
#include "brdf/models.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "brdf/coefficients.h"
#include "brdf/simd/dispatch.h"

namespace brdfit {
namespace {

template <class Coefs, class Terms, class Combine>
Rgb combine_channels(const Coefs& coefs, const Terms& terms, const kernel::Geometry<double>& g,
                     const Combine& combine) {
  Rgb result;
  for (std::size_t c = 0; c < 3; ++c) {
    result[c] = kernel::above_horizon(combine(coefs.colour[c], terms), g.cos_i, g.cos_o);
  }
  return result;
}

bool above(const Vec3& wi, const Vec3& wo) {
  return wi.z > 0.0 && wo.z > 0.0;
}

}  // namespace

Rgb eval_cos(const Material& material, const Vec3& wi, const Vec3& wo) {
  if (!above(wi, wo)) return {0.0, 0.0, 0.0};
  const auto g = kernel::geometry_from_directions(wi.x, wi.y, wi.z, wo.x, wo.y, wo.z);
  const std::vector<double> q = product_form(material);
  const MaterialOptions& options = material.options();
  const int masking = static_cast<int>(options.masking);
  const int diffuse = static_cast<int>(options.diffuse);
  const int effects = static_cast<int>(material.effects().bits());
  switch (material.model()) {
    case Model::kLambertGgx: {
      const auto coefs = lambert_ggx_coefficients(q.data());
      return combine_channels(coefs, kernel::lambert_ggx_terms(coefs.shape, g, masking, diffuse), g,
                              [](const auto& c, const auto& t) { return kernel::lambert_ggx_combine(c, t); });
    }
    case Model::kBurley: {
      const auto coefs = burley_coefficients(q.data(), effects);
      const int burley_g = static_cast<int>(options.burley_g);
      return combine_channels(coefs, kernel::burley_terms(coefs.shape, g, burley_g, effects), g,
                              [](const auto& c, const auto& t) { return kernel::burley_combine(c, t); });
    }
    case Model::kCallisto:
      break;
  }
  const auto coefs = callisto_coefficients(q.data());
  const auto logs = kernel::geometry_logs(g);
  return combine_channels(coefs, kernel::callisto_terms(coefs.shape, g, logs, masking, diffuse, effects), g,
                          [](const auto& c, const auto& t) { return kernel::callisto_combine(c, t); });
}

Rgb eval(const Material& material, const Vec3& wi, const Vec3& wo) {
  Rgb f = eval_cos(material, wi, wo);
  if (!above(wi, wo)) return f;
  for (double& channel : f) channel /= wi.z;
  return f;
}

void eval_cos(const Material& material, std::span<const Vec3> wi, std::span<const Vec3> wo,
              std::span<Rgb> out) {
  if (wi.size() != wo.size() || wi.size() != out.size()) {
    throw std::invalid_argument("eval: wi, wo and out differ in size");
  }
  constexpr std::size_t kChunk = simd::kBlock * 8;
  const simd::Coefficients coefficients = simd::coefficients_of(material);
  const simd::EvalDirections evaluate = simd::eval_directions(simd::best_isa());
  std::array<std::array<double, kChunk>, 9> columns;
  const simd::DirectionColumns directions = {columns[0].data(), columns[1].data(), columns[2].data(),
                                             columns[3].data(), columns[4].data(), columns[5].data()};
  double* const results[3] = {columns[6].data(), columns[7].data(), columns[8].data()};
  for (std::size_t first = 0; first < wi.size(); first += kChunk) {
    const std::size_t count = std::min(kChunk, wi.size() - first);
    const std::size_t padded = (count + simd::kBlock - 1) / simd::kBlock * simd::kBlock;
    for (std::size_t k = 0; k < padded; ++k) {
      // Padding repeats the last pair.
      const Vec3& i = wi[first + std::min(k, count - 1)];
      const Vec3& o = wo[first + std::min(k, count - 1)];
      const std::array<double, 6> pair = {i.x, i.y, i.z, o.x, o.y, o.z};
      for (std::size_t column = 0; column < 6; ++column) columns[column][k] = pair[column];
    }
    evaluate(coefficients, directions, padded, results);
    for (std::size_t k = 0; k < count; ++k) out[first + k] = {results[0][k], results[1][k], results[2][k]};
  }
}

void eval(const Material& material, std::span<const Vec3> wi, std::span<const Vec3> wo, std::span<Rgb> out) {
  eval_cos(material, wi, wo, out);
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (!above(wi[k], wo[k])) continue;
    for (double& channel : out[k]) channel /= wi[k].z;
  }
}

bool is_reciprocal(const Material& material) {
  switch (material.model()) {
    case Model::kLambertGgx:
      return material.options().diffuse == Diffuse::kLambert;
    case Model::kBurley:
      return true;
    case Model::kCallisto:
      break;
  }
  return material.options().diffuse == Diffuse::kLambert &&
         !material.effects().has(Effect::kSmoothTerminator);
}

}  // namespace brdfit
