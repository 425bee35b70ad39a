// What a user can choose of a bake, as points of `brdfit cost`.
#ifndef BRDFIT_CLI_COST_STACK_CHOICE_H_
#define BRDFIT_CLI_COST_STACK_CHOICE_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bake/held_correction.h"
#include "brdf/realis_asset.h"
#include "cli/bake_options.h"
#include "cli/cost/cost_point.h"

namespace brdfit::cli {

struct StackChoice {
  int lobes = 8;
  int dominant = 8;  // lobes kept per texel, in [1, lobes]
  bake::AmplitudeBits bits = bake::AmplitudeBits::k8;
  RealisColour colour = RealisColour::kLuminance;
  double ridge_factor = 1.0;
  std::optional<Model> base;  // Lambert where absent
  int shrink = 1;             // texels along a side that become one

  bool is_code() const { return static_cast<int>(bits) <= 8; }
  // At run time, of one texel of the whole picture: textures that were shrunk are shared by several.
  double bytes_per_texel(const StackInfo& whole) const;
  friend bool operator==(const StackChoice&, const StackChoice&) = default;
};

// By the names of the options of `brdfit bake`; "half" and "float" are --bits of which it writes EXR files.
std::vector<std::pair<std::string, std::string>> settings_of(const StackChoice& choice);
// The other way. Throws std::invalid_argument where a setting is missing or is none.
StackChoice choice_of(const CostPoint& point);
// The arguments with which `brdfit bake` makes it; what is no choice stays as it is.
BakeArguments with_choice(BakeArguments arguments, const StackChoice& choice);

struct PlannedChoice {
  std::string name;
  std::string sweep;
  StackChoice choice;
};

// The default, 8 lobes of luminance in 8 bits over the base given, then each choice around it, and numbers of
// lobes with 4 bits and with half of the lobes kept. other_base: to compare with. quick: about a third of
// them. None is named twice.
std::vector<PlannedChoice> plan_choices(std::optional<Model> base, std::optional<Model> other_base,
                                        bool quick);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_STACK_CHOICE_H_
