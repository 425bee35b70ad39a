// The tables of groups.
#include "fit/groups.h"

#include <algorithm>
#include <array>

namespace brdfit::fit {
namespace {

using enum Effect;

// Groups of the tables are ordered: effects as all_effects() lists them, then refinements.
constexpr std::array kCallistoGroups = {
    Group{"specular_fresnel_falloff", kSpecularFresnelFalloff, false},
    Group{"diffuse_fresnel", kDiffuseFresnel, false},
    Group{"retroreflection", kRetroreflection, false},
    Group{"smooth_terminator", kSmoothTerminator, false},
    Group{"dual_specular", kDualSpecular, false},
    Group{"diffuse_fresnel_tint", kDiffuseFresnel, true},
    Group{"retroreflection_tint", kRetroreflection, true},
    Group{"smooth_terminator_tint", kSmoothTerminator, true},
    Group{"diffuse_fresnel_tangent_falloff", kDiffuseFresnel, true},
    Group{"retroreflection_tangent_falloff", kRetroreflection, true},
    Group{"smooth_terminator_length", kSmoothTerminator, true},
};

constexpr std::array kBurleyGroups = {
    Group{"subsurface", kSubsurface, false}, Group{"specular_tint", kSpecularTint, false},
    Group{"sheen", kSheen, false},           Group{"clearcoat", kClearcoat, false},
    Group{"sheen_tint", kSheen, true},
};

// The groups that a condition holds for.
template <class Condition>
Groups where(Model model, const Condition& condition) {
  const auto table = groups_of(model);
  Groups result;
  for (std::size_t k = 0; k < table.size(); ++k) {
    if (condition(table[k], k)) result = result.with(k);
  }
  return result;
}

}  // namespace

std::span<const Group> groups_of(Model model) {
  switch (model) {
    case Model::kLambertGgx:
      return {};
    case Model::kBurley:
      return kBurleyGroups;
    case Model::kCallisto:
      return kCallistoGroups;
  }
  return {};
}

std::optional<std::size_t> group_by_name(Model model, std::string_view name) {
  const auto table = groups_of(model);
  const auto found = std::ranges::find(table, name, &Group::name);
  if (found == table.end()) return std::nullopt;
  return static_cast<std::size_t>(found - table.begin());
}

std::optional<std::size_t> group_of_parameter(Model model, std::string_view parameter) {
  const ParameterInfo* info = find_parameter(model, parameter);
  if (info == nullptr || info->effect == kNone) return std::nullopt;
  const auto refinement = group_by_name(model, parameter);
  return refinement ? refinement : group_by_name(model, effect_name(info->effect));
}

Groups usable_groups(Model model, Tier tier, Effects effects) {
  return where(model, [&](const Group& group, std::size_t k) {
    return effects.has(group.effect) && std::ranges::any_of(parameters_of(model), [&](const auto& info) {
             return info.tier <= tier && group_of_parameter(model, info.name) == k;
           });
  });
}

Groups family_of(Model model, std::size_t group) {
  const Group& head = groups_of(model)[group];
  if (head.refines) return Groups().with(group);
  return where(model, [&](const Group& other, std::size_t) { return other.effect == head.effect; });
}

Groups groups_of_effects(Model model, Effects effects) {
  return where(model, [&](const Group& group, std::size_t) { return effects.has(group.effect); });
}

Effects effects_of_groups(Model model, Groups groups) {
  Effects effects;
  const auto table = groups_of(model);
  for (std::size_t k = 0; k < table.size(); ++k) {
    if (groups.has(k) && !table[k].refines) effects = effects.with(table[k].effect);
  }
  return effects;
}

std::vector<std::string> names_of_groups(Model model, Groups groups) {
  std::vector<std::string> names;
  const auto table = groups_of(model);
  for (std::size_t k = 0; k < table.size(); ++k) {
    if (groups.has(k)) names.emplace_back(table[k].name);
  }
  return names;
}

Groups groups_by_names(Model model, std::span<const std::string> names) {
  const Groups named = where(model, [&](const Group& group, std::size_t) {
    return std::ranges::find(names, group.name) != names.end();
  });
  Effects refined;
  Effects effects;
  const auto table = groups_of(model);
  for (std::size_t k = 0; k < table.size(); ++k) {
    if (!named.has(k)) continue;
    effects = effects.with(table[k].effect);
    if (table[k].refines) refined = refined.with(table[k].effect);
  }
  return where(model, [&](const Group& group, std::size_t k) {
    if (!effects.has(group.effect)) return false;
    return !group.refines || named.has(k) || !refined.has(group.effect);
  });
}

}  // namespace brdfit::fit
