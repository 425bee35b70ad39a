// What makes a parameter vanish, and what it is tied to.
#include "fit/reasons.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace brdfit::fit {
namespace {

// While `by` is at `neutral` in all channels, `parameter` changes nothing.
struct Gate {
  std::string_view parameter;
  std::string_view by;
  double neutral;
  std::string_view what;  // how the sentence names the parameter
};

constexpr std::array kGates = {
    Gate{"dual_specular_roughness_scale", "dual_specular_opacity", 0.0, "its scale"},
    Gate{"dual_specular_opacity", "dual_specular_roughness_scale", 1.0, "its opacity"},
    Gate{"diffuse_fresnel_falloff", "diffuse_fresnel", 1.0, "its falloff"},
    Gate{"diffuse_fresnel_tangent_falloff", "diffuse_fresnel", 1.0, "its tangent falloff"},
    Gate{"diffuse_fresnel_tint", "diffuse_fresnel", 0.0, "its tint"},
    Gate{"retroreflection_falloff", "retroreflection", 1.0, "its falloff"},
    Gate{"retroreflection_tangent_falloff", "retroreflection", 1.0, "its tangent falloff"},
    Gate{"retroreflection_tint", "retroreflection", 0.0, "its tint"},
    Gate{"smooth_terminator_tint", "smooth_terminator", 0.0, "its tint"},
    Gate{"smooth_terminator_length", "smooth_terminator", 0.0, "its length"},
    Gate{"clearcoat_gloss", "clearcoat", 0.0, "its gloss"},
    Gate{"sheen_tint", "sheen", 0.0, "its tint"},
    Gate{"specular_tint", "specular", 0.0, "its tint"},
    Gate{"specular", "metallic", 1.0, "specular"},
    Gate{"specular_tint", "metallic", 1.0, "specular tint"},
    Gate{"subsurface", "metallic", 1.0, "subsurface"},
    Gate{"sheen", "metallic", 1.0, "sheen"},
    Gate{"sheen_tint", "metallic", 1.0, "sheen tint"},
    Gate{"diffuse_fresnel", "metallic", 1.0, "diffuse Fresnel"},
    Gate{"retroreflection", "metallic", 1.0, "retroreflection"},
    Gate{"diffuse_fresnel", "base_color", 0.0, "diffuse Fresnel"},
    Gate{"retroreflection", "base_color", 0.0, "retroreflection"},
};

constexpr std::string_view kHardlySeen = "the samples hardly depend on it";

// How far from its neutral value what hides another may be.
constexpr double kNeutral = 1e-3;
// Of two numbers, as a cosine between their parts in unseen directions.
constexpr double kTied = 0.3;

std::string words(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '_', ' ');
  return text;
}

bool is_neutral(const Material& material, const Gate& gate) {
  // Where a product has a tint, what counts is both together.
  const std::string tint = std::string(gate.by) + "_tint";
  const bool has_tint = gate.neutral != 0.0 && find_parameter(material.model(), tint) != nullptr &&
                        find_parameter(material.model(), tint)->components == 3;
  const Rgb value = material.colour(gate.by);
  const Rgb share = has_tint ? material.colour(tint) : Rgb{1.0, 1.0, 1.0};
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(std::abs(value[c] * share[c] - gate.neutral) <= kNeutral)) return false;
  }
  return true;
}

std::string gate_reason(const Material& material, std::string_view parameter) {
  for (const Gate& gate : kGates) {
    if (gate.parameter != parameter || find_parameter(material.model(), gate.by) == nullptr) continue;
    if (!is_neutral(material, gate)) continue;
    const Rgb value = material.colour(gate.by);
    const double furthest =
        *std::ranges::max_element(value, {}, [&](double v) { return std::abs(v - gate.neutral); });
    return fmt::format("{} is {:.3g}: {} does not matter", words(gate.by), furthest, gate.what);
  }
  return "";
}

// Public parameters other than its own that number k is tied to.
std::vector<std::string> partners(const Parametrisation& parametrisation, const Identifiability& before,
                                  std::size_t k) {
  const Eigen::MatrixXd& unseen = before.unseen;
  std::vector<std::string> names;
  const auto at = static_cast<Eigen::Index>(k);
  for (std::size_t j = 0; j < parametrisation.size(); ++j) {
    const auto other = static_cast<Eigen::Index>(j);
    const std::string& name = parametrisation.free[j].parameter;
    if (name == parametrisation.free[k].parameter || before.status[j] != Status::kUnidentifiable) continue;
    if (std::abs(unseen(at, other)) <= kTied * std::sqrt(unseen(at, at) * unseen(other, other))) continue;
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names;
}

// The second lobe can be no rougher than 1.
std::string clipped_scale_reason(const Material& material, std::string_view parameter) {
  if (parameter != "dual_specular_roughness_scale") return "";
  const double roughness = material.number("roughness") * material.number(parameter);
  return roughness > 1.0 ? "the second lobe's roughness is cut off at 1: more scale changes nothing" : "";
}

}  // namespace

std::string in_words(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (k > 0) text += k + 1 == names.size() ? " and " : ", ";
    text += words(names[k]);
  }
  return text;
}

std::vector<std::string> reasons_of(const Parametrisation& parametrisation, std::span<const double> x,
                                    const Identifiability& before, const Identifiability& now) {
  const Material material = parametrisation.to_material(x);
  std::vector<std::string> reasons(parametrisation.size());
  for (std::size_t k = 0; k < reasons.size(); ++k) {
    if (now.status[k] != Status::kUnidentifiable) continue;
    reasons[k] = gate_reason(material, parametrisation.free[k].parameter);
    if (reasons[k].empty()) reasons[k] = clipped_scale_reason(material, parametrisation.free[k].parameter);
    if (!reasons[k].empty()) continue;
    const std::vector<std::string> tied = partners(parametrisation, before, k);
    reasons[k] = tied.empty() ? std::string(kHardlySeen)
                              : "tied to " + in_words(tied) + ": another combination fits as well";
  }
  return reasons;
}

void add_reasons(const Parametrisation& parametrisation, std::span<const double> x,
                 const std::vector<std::string>& reasons, std::vector<ParameterState>& states) {
  const Material material = parametrisation.to_material(x);
  for (ParameterState& state : states) {
    if (state.status != Status::kUnidentifiable) continue;
    state.reason = gate_reason(material, state.name);
    for (std::size_t k = 0; k < reasons.size() && state.reason.empty(); ++k) {
      const FreeParameter& parameter = parametrisation.free[k];
      if (parameter.parameter == state.name || parameter.tint == state.name) state.reason = reasons[k];
    }
    if (state.reason.empty()) state.reason = kHardlySeen;
  }
}

}  // namespace brdfit::fit
