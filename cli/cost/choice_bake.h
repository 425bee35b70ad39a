// A sample of texels baked by a plan, once for all choices that share it, and what each choice stores of it.
#ifndef BRDFIT_CLI_COST_CHOICE_BAKE_H_
#define BRDFIT_CLI_COST_CHOICE_BAKE_H_

#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "bake/compress_block.h"
#include "bake/plan.h"
#include "cli/cost/stack_choice.h"

namespace brdfit::cli {

// What all texels share, for several numbers of lobes.
struct LobePlans {
  bake::BakePlan plan;                                     // its own system is not looked at
  std::map<int, std::optional<bake::LobeSystem>> systems;  // by number of lobes; nothing where none help

  static LobePlans of(bake::BakePlan plan, int lobes);
};

// What a choice stores of the sample's texels.
struct Stored {
  std::vector<std::vector<float>>
      amplitudes;                    // [channel], each [lobe][texel]: what codes stand for; empty: none
  std::vector<float> chroma;         // [channel][texel], for kScaledChroma
  std::vector<std::uint32_t> masks;  // per texel; empty where all lobes are kept
  std::vector<RealisRange> ranges;   // [lobe][channel], of codes
  LobeSet lobes;
};

class ChoiceBake {
 public:
  // All must outlive it. info, sample: of the stack in the size of the choices, with all its lights.
  // settings: what is no choice.
  ChoiceBake(const StackInfo& info, const TexelBlock& sample, const LobePlans& plans,
             const bake::BakeSettings& settings, bool dither);

  const bake::Surface& surface() { return baked(RealisColour::kLuminance).surface; }
  Stored stored(const StackChoice& choice);

 private:
  const bake::BakedBlock& baked(RealisColour colour);
  bake::LobeSystem system_of(const StackChoice& choice, const bake::LobeSystem& planned);
  const std::vector<bake::SolveResult>& solved(const StackChoice& choice, const bake::LobeSystem& system);

  const StackInfo& info_;
  const TexelBlock& sample_;
  const LobePlans& plans_;
  bake::BakeSettings settings_;
  bool dither_;
  std::map<RealisColour, bake::BakedBlock> baked_;
  std::map<std::tuple<RealisColour, int, double>, std::vector<bake::SolveResult>> solved_;
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_CHOICE_BAKE_H_
