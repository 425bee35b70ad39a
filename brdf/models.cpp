// Evaluation of materials: scalar through the double kernels, spans through vector code.
#include "brdf/models.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "brdf/product_eval.h"
#include "brdf/simd/dispatch.h"

namespace brdfit {
namespace {

bool above(const Vec3& wi, const Vec3& wo) {
  return wi.z > 0.0 && wo.z > 0.0;
}

}  // namespace

Rgb eval_cos(const Material& material, const Vec3& wi, const Vec3& wo) {
  if (!above(wi, wo)) return {0.0, 0.0, 0.0};
  const auto g = kernel::geometry_from_directions(wi.x, wi.y, wi.z, wo.x, wo.y, wo.z);
  const std::vector<double> q = product_form(material);
  return eval_product(material.model(), material.options(), material.effects(), q.data(), g);
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
