// Shared bakes of a sample, and what choices store.
#include "cli/cost/choice_bake.h"

#include <span>
#include <utility>

#include "bake/channel_errors.h"
#include "bake/kept_amplitudes.h"

namespace brdfit::cli {

LobePlans LobePlans::of(bake::BakePlan plan, int lobes) {
  LobePlans plans;
  plans.systems = plan.also;
  plans.systems[lobes] = plan.system;
  plans.plan = std::move(plan);
  plans.plan.also.clear();
  return plans;
}

ChoiceBake::ChoiceBake(const StackInfo& info, const TexelBlock& sample, const LobePlans& plans,
                       const bake::BakeSettings& settings, bool dither)
    : info_(info), sample_(sample), plans_(plans), settings_(settings), dither_(dither) {}

// The problems of a colour; luminance serves scaled chroma too.
const bake::BakedBlock& ChoiceBake::baked(RealisColour colour) {
  if (colour == RealisColour::kScaledChroma) colour = RealisColour::kLuminance;
  auto found = baked_.find(colour);
  if (found != baked_.end()) return found->second;
  bake::BakeSettings settings = settings_;
  settings.colour = colour;
  bake::BakePlan plan = plans_.plan;
  plan.system.reset();
  return baked_.emplace(colour, bake::bake_block(info_, sample_, plan, settings)).first->second;
}

bake::LobeSystem ChoiceBake::system_of(const StackChoice& choice, const bake::LobeSystem& planned) {
  if (choice.ridge_factor == 1.0) return planned;
  return bake::LobeSystem::with_penalty(
      planned.lobes(), planned.directions(),
      bake::mean_squared_modulation(baked(RealisColour::kLuminance).problems.front()),
      choice.ridge_factor * planned.penalty());
}

const std::vector<bake::SolveResult>& ChoiceBake::solved(const StackChoice& choice,
                                                         const bake::LobeSystem& system) {
  const RealisColour colour =
      choice.colour == RealisColour::kScaledChroma ? RealisColour::kLuminance : choice.colour;
  std::vector<bake::SolveResult>& results = solved_[{colour, choice.lobes, choice.ridge_factor}];
  if (results.empty()) {
    for (const bake::TexelProblem& problem : baked(colour).problems) {
      results.push_back(bake::solve(system, problem));
    }
  }
  return results;
}

Stored ChoiceBake::stored(const StackChoice& choice) {
  Stored out;
  const std::optional<bake::LobeSystem>& planned = plans_.systems.at(choice.lobes);
  if (!planned) return out;
  const bake::LobeSystem system = system_of(choice, *planned);
  out.lobes = system.lobes();
  const std::vector<bake::TexelProblem>& problems = baked(choice.colour).problems;
  const std::vector<bake::SolveResult>& results = solved(choice, system);
  if (choice.colour == RealisColour::kScaledChroma) {
    const std::span<const bake::TexelProblem, 3> rgb(baked(RealisColour::kRgb).problems);
    out.chroma = bake::chroma_of(system, rgb, results.front().amplitudes);
  }
  const bake::CompressOptions options{choice.is_code() ? static_cast<int>(choice.bits) : 0, choice.dominant,
                                      dither_};
  bake::KeptAmplitudes kept(system, problems, results, sample_.texels, info_.width);
  const std::vector<std::vector<RealisRange>> ranges = kept.ranges(options);
  out.amplitudes = kept.amplitudes(options, ranges);
  out.masks = kept.masks(choice.dominant);
  const std::size_t channels = problems.size();
  out.ranges.resize(out.lobes.size() * channels);
  for (std::size_t c = 0; c < channels; ++c) {
    for (std::size_t k = 0; k < ranges[c].size(); ++k) out.ranges[k * channels + c] = ranges[c][k];
    if (choice.bits != bake::AmplitudeBits::kHalf) continue;
    for (float& amplitude : out.amplitudes[c]) amplitude = bake::rounded_to_half(amplitude);
  }
  return out;
}

}  // namespace brdfit::cli
