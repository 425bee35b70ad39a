// What a fit can switch on and off: the effects of a model, and the refinements of each.
#ifndef BRDFIT_FIT_GROUPS_H_
#define BRDFIT_FIT_GROUPS_H_

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/material.h"

namespace brdfit::fit {

// Parameters that are free together or stand at their defaults together. A refinement needs its effect; all
// parameters of an effect that no refinement takes come with the effect.
struct Group {
  std::string_view name;  // of the effect ("dual_specular"), or of the refinement's parameter
  Effect effect;
  bool refines;  // a refinement rather than the effect itself
};

// A set of groups of one model, by their places in groups_of(model).
class Groups {
 public:
  constexpr Groups() = default;
  constexpr explicit Groups(std::uint32_t bits) : bits_(bits) {}

  constexpr bool has(std::size_t group) const { return (bits_ >> group & 1U) != 0; }
  constexpr bool has_all(Groups other) const { return (bits_ & other.bits_) == other.bits_; }
  constexpr Groups with(std::size_t group) const { return Groups(bits_ | 1U << group); }
  constexpr Groups without(Groups other) const { return Groups(bits_ & ~other.bits_); }
  constexpr Groups operator|(Groups other) const { return Groups(bits_ | other.bits_); }
  constexpr Groups operator&(Groups other) const { return Groups(bits_ & other.bits_); }
  constexpr bool empty() const { return bits_ == 0; }
  constexpr int size() const { return std::popcount(bits_); }
  constexpr std::uint32_t bits() const { return bits_; }
  friend constexpr bool operator==(Groups a, Groups b) = default;

 private:
  std::uint32_t bits_ = 0;
};

// Callisto: five effects, then the tints of three, the tangent falloffs of two and the terminator's length.
// Burley: four effects (clearcoat with its gloss), then the sheen's tint. Anisotropy is none, as data are
// isotropic. Lambert + GGX has no groups.
std::span<const Group> groups_of(Model model);

std::optional<std::size_t> group_by_name(Model model, std::string_view name);

// The group that a parameter moves with; none for parameters that are always there, and for `anisotropic`.
std::optional<std::size_t> group_of_parameter(Model model, std::string_view parameter);

// Every group that has a parameter within the tier and whose effect is given.
Groups usable_groups(Model model, Tier tier, Effects effects);

// An effect's group and those that refine it; for a refinement itself alone. What goes when it goes.
Groups family_of(Model model, std::size_t group);

// The groups of the given effects, refinements included.
Groups groups_of_effects(Model model, Effects effects);

// The effects whose groups are in the set.
Effects effects_of_groups(Model model, Groups groups);

// The names in order.
std::vector<std::string> names_of_groups(Model model, Groups groups);

// What a list of names asks of a model: an effect brings its refinements, unless some of them are named
// too; a refinement brings its effect. Names that the model lacks are passed over.
Groups groups_by_names(Model model, std::span<const std::string> names);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_GROUPS_H_
