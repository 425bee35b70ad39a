// The plan of a bake: everything that all texels of an asset share, decided on a sample of its texels and on
// the lights that may be looked at.
#ifndef BRDFIT_BAKE_PLAN_H_
#define BRDFIT_BAKE_PLAN_H_

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/base_model.h"
#include "bake/choose_base.h"
#include "bake/choose_lobes.h"
#include "bake/photometric_stereo.h"
#include "bake/shared_material.h"
#include "bake/solve.h"
#include "bake/solve_warnings.h"
#include "brdf/realis_asset.h"
#include "measured/image_stack.h"

namespace brdfit::bake {

// What is rendered before Realis corrects it.
enum class BaseKind {
  kAuto,  // the one whose held-out error is less
  kLambert,
  kMaterial,  // one fitted to the stack
};

struct BakeSettings {
  int lobes = 8;                        // 0: chosen by held-out error; at most kMaxLobes
  bool optimise = true;                 // otherwise lobes stay uniform
  std::vector<int> also_lobes;          // numbers for which lobes are planned beside, to compare with
  std::optional<LobeSet> given_lobes;   // these, whatever the two above say
  std::optional<double> given_penalty;  // and this penalty (LobeSystem::penalty), > 0; else a ridge is chosen
  double ridge_factor = 1.0;            // what a ridge that is chosen is multiplied by, > 0
  BaseKind base = BaseKind::kAuto;
  Model model = Model::kCallisto;  // of the material
  RealisColour colour = RealisColour::kLuminance;
  bool gains = false;  // estimate a gain per light
  bool albedo_in_modulation = false;
  std::uint64_t seed = 1;
  // Called between the folds of planning, from several threads at once; may throw to stop. May be empty.
  std::function<void()> check;

  bool is_valid(std::string* why) const;
};

struct BakePlan {
  LightChoice lights;         // looked at
  std::vector<double> gains;  // per light of the stack: what its stated intensity is multiplied by. 1 where
                              // not estimated, and for lights that were not looked at
  std::optional<GainEstimate> gain_estimate;
  BaseModel base;
  std::optional<SharedMaterial> material;         // the fit, where there is one, whether or not it was chosen
  std::vector<BaseCandidate> candidates;          // that were compared; empty where the base was given
  std::optional<LobeSystem> system;               // nothing where no lobes help
  std::map<int, std::optional<LobeSystem>> also;  // for each of BakeSettings::also_lobes
  std::optional<LobeChoice> lobe_choice;          // what was compared; nothing where lobes were given
  std::vector<SolveWarning> warnings;             // what makes the lobes hard to solve for
};

// Decides all of it. sample: texels of the stack with all its lights, of which only `lights` are looked at;
// of more than a few thousand texels some are left out.
// Throws std::invalid_argument where settings are invalid or sizes disagree.
BakePlan plan_bake(const StackInfo& info, const TexelBlock& sample, const LightChoice& lights,
                   const BakeSettings& settings);

// Whether settings leave nothing to decide, so that no sample is needed: Lambert, no gains, lobes with their
// penalty.
bool is_decided(const BakeSettings& settings);
// The plan that they are, for all lights. Throws std::invalid_argument where they leave something open.
BakePlan decided_plan(const StackInfo& info, const BakeSettings& settings);

// Decides the lobes alone, for a base that is planned. info, sample: of the plan's lights alone, gains in the
// intensities.
void plan_lobes(BakePlan& plan, const StackInfo& info, const TexelBlock& sample,
                const BakeSettings& settings);

// What baking knows of a block's texels. One problem, of luminance, or for kRgb three of channels.
struct BakedBlock {
  Surface surface;
  std::vector<TexelProblem> problems;  // under the plan's lights
  std::vector<SolveResult> solved;     // of each; empty where the plan has no lobes
  std::vector<float> chroma;           // [channel][texel], for kScaledChroma
};
BakedBlock bake_block(const StackInfo& info, const TexelBlock& block, const BakePlan& plan,
                      const BakeSettings& settings);

// Normals and albedo of a block, and the base model's own colours.
Surface surface_of(const StackInfo& info, const TexelBlock& block, const BaseModel& base);

// The render of a block under some lights as a problem takes it: radiance, shade and albedo.
BlockRender render_of(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                      const LightChoice& lights, const BaseModel& base, bool albedo_in_modulation);

// A stack and a block as if they had only these lights.
StackInfo with_lights(const StackInfo& info, const LightChoice& lights);
TexelBlock with_lights(const TexelBlock& block, const LightChoice& lights);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_PLAN_H_
