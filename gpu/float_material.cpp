// Materials and pairs in float on the processor, and in double for comparison.
#include "gpu/float_material.h"

#include <stdexcept>

#include "brdf/models.h"
#include "brdf/product_eval.h"

namespace brdfit {
namespace {

void require_equal_sizes(std::size_t pairs, std::size_t out) {
  if (pairs != out) throw std::invalid_argument("eval_cos: pairs and out differ in size");
}

Vec3 widened(const std::array<float, 3>& w) {
  return {w[0], w[1], w[2]};
}

// The product form in float: every parameter is rounded first, as on the device.
std::vector<float> float_product_form(const Material& material) {
  const Material rounded = rounded_to_float(material);
  const auto component = [&](std::string_view name, int channel) {
    const ParameterInfo& info = *find_parameter(material.model(), name);
    if (!material.effects().has(info.effect)) return static_cast<float>(info.default_value);
    const int offset = info.offset + (info.components == 3 ? channel : 0);
    return static_cast<float>(rounded.values()[static_cast<std::size_t>(offset)]);
  };
  std::vector<float> product;
  for (const ProductEntry& entry : product_layout(material.model())) {
    const float value = component(entry.parameter, entry.channel);
    product.push_back(entry.tint.empty() ? value : value * component(entry.tint, entry.channel));
  }
  return product;
}

}  // namespace

std::vector<float> float_values(const Material& material) {
  std::vector<float> values;
  for (const double value : material.values()) values.push_back(static_cast<float>(value));
  return values;
}

Material rounded_to_float(const Material& material) {
  Material rounded = material;
  const std::vector<float> values = float_values(material);
  std::copy(values.begin(), values.end(), rounded.values().begin());
  return rounded;
}

void eval_cos_float(const Material& material, std::span<const FloatPair> pairs, std::span<FloatRgb> out) {
  require_equal_sizes(pairs.size(), out.size());
  const std::vector<float> q = float_product_form(material);
  with_coefficients(material.model(), material.effects(), q.data(), [&](const auto& coefficients) {
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto& [wi, wo] = pairs[k];
      const auto g = kernel::geometry_from_directions(wi[0], wi[1], wi[2], wo[0], wo[1], wo[2]);
      out[k] = eval_coefficients(coefficients, material.options(), material.effects(), g);
    }
  });
}

void eval_cos_reference(const Material& material, std::span<const FloatPair> pairs, std::span<Rgb> out) {
  require_equal_sizes(pairs.size(), out.size());
  std::vector<Vec3> wi;
  std::vector<Vec3> wo;
  for (const FloatPair& pair : pairs) {
    wi.push_back(widened(pair.wi));
    wo.push_back(widened(pair.wo));
  }
  eval_cos(rounded_to_float(material), wi, wo, out);
}

}  // namespace brdfit
