// The product form of a material.
#include "brdf/coefficients.h"

namespace brdfit {
namespace {

void add_colour(std::vector<ProductEntry>& layout, std::string_view parameter, std::string_view tint) {
  for (int channel = 0; channel < 3; ++channel) layout.push_back({parameter, tint, channel});
}

}  // namespace

std::vector<ProductEntry> product_layout(Model model) {
  std::vector<ProductEntry> layout;
  add_colour(layout, "base_color", "");
  for (const std::string_view name : {"metallic", "specular", "roughness"}) layout.push_back({name, "", 0});
  if (model == Model::kBurley) {
    for (const std::string_view name : {"subsurface", "specular_tint", "anisotropic", "sheen", "sheen_tint",
                                        "clearcoat", "clearcoat_gloss"}) {
      layout.push_back({name, "", 0});
    }
  }
  if (model == Model::kCallisto) {
    for (const std::string_view name :
         {"dual_specular_roughness_scale", "dual_specular_opacity", "diffuse_fresnel_falloff",
          "diffuse_fresnel_tangent_falloff", "retroreflection_falloff", "retroreflection_tangent_falloff",
          "specular_fresnel_falloff", "smooth_terminator_length"}) {
      layout.push_back({name, "", 0});
    }
    for (const std::string_view name : {"diffuse_fresnel", "retroreflection", "smooth_terminator"}) {
      add_colour(layout, name, find_parameter(model, name)->partner);
    }
  }
  return layout;
}

std::vector<double> product_form(const Material& material) {
  const auto component = [&](std::string_view name, int channel) {
    const ParameterInfo& info = *find_parameter(material.model(), name);
    if (!material.effects().has(info.effect)) return info.default_value;
    return material.values()[static_cast<std::size_t>(info.offset + (info.components == 3 ? channel : 0))];
  };
  std::vector<double> product;
  for (const ProductEntry& entry : product_layout(material.model())) {
    const double value = component(entry.parameter, entry.channel);
    product.push_back(entry.tint.empty() ? value : value * component(entry.tint, entry.channel));
  }
  return product;
}

}  // namespace brdfit
