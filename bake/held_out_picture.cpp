// Bake without a fold, render with it.
#include "bake/held_out_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "bake/base_model.h"
#include "bake/kept_amplitudes.h"
#include "bake/luminance.h"

namespace brdfit::bake {
namespace {

// Amplitudes of each problem of a block, [lobe][texel].
using Amplitudes = std::vector<std::vector<float>>;

// One plan's bake of a block.
struct BakedBy {
  BakedBlock block;
  const LobeSystem* system = nullptr;  // nothing where no lobes help

  Amplitudes solved() const {
    Amplitudes out;
    for (const SolveResult& result : block.solved) out.push_back(result.amplitudes);
    return out;
  }
  // Of a block that was baked with lobes, as its texels lie in a picture of that width.
  KeptAmplitudes kept(const TexelBlock& texels, int width) const {
    return {*system, block.problems, block.solved, texels.texels, width};
  }
};

BakedBy bake_by(const StackInfo& info, const TexelBlock& block, const BakePlan& plan,
                const BakeSettings& settings) {
  return {bake_block(info, block, plan, settings), plan.system ? &*plan.system : nullptr};
}

// How one kind of a plan comes to its amplitudes.
struct Kind {
  RealisKind kind;
  int plan = 0;  // number of lobes of another plan, all of them whole; 0: the plan itself
  std::vector<std::vector<RealisRange>> ranges;  // of each problem; empty where not rounded
};

}  // namespace

FoldPlans plan_fold(const StackInfo& info, const TexelBlock& sample, int fold, int folds,
                    const BakeSettings& settings, std::span<const int> other_lobes) {
  const LightChoice kept = without(info, held_out_lights(info.lights.size(), fold, folds));
  if (kept.empty()) throw std::invalid_argument("plan_fold: no light is left");
  BakeSettings with_others = settings;
  with_others.also_lobes.assign(other_lobes.begin(), other_lobes.end());
  std::erase(with_others.also_lobes, settings.lobes);
  return fold_plans(plan_bake(info, sample, kept, with_others));
}

struct HeldOutBaker::State {
  const StackInfo& info;
  const FoldPlans& plans;
  const BakeSettings& settings;
  std::vector<Kind> kinds;
  std::vector<RealisKind> names;

  const BakePlan& plan_of(const Kind& kind) const {
    return kind.plan == 0 ? plans.plan : plans.other_lobes.at(kind.plan);
  }

  void add_kinds(const TexelBlock& sample, bool dither) {
    for (const auto& [lobes, plan] : plans.other_lobes) {
      if (!plan.system) continue;
      const std::string name = fmt::format("realis-k{}", lobes);
      kinds.push_back(
          {realis_kinds(name, lobes, half_of(lobes), settings.colour, false, dither)[0], lobes, {}});
    }
    const BakedBy baked = bake_by(info, sample, plans.plan, settings);
    if (baked.system) {
      const auto lobes = static_cast<int>(baked.system->lobes().size());
      const std::vector<RealisKind> all =
          realis_kinds("realis", lobes, half_of(lobes), settings.colour, true, dither);
      KeptAmplitudes kept = baked.kept(sample, info.width);
      for (std::size_t k = 1; k < all.size(); ++k) kinds.push_back({all[k], 0, kept.ranges(all[k].options)});
    }
    for (const Kind& kind : kinds) names.push_back(kind.kind);
  }
};

HeldOutBaker::HeldOutBaker(const StackInfo& info, const TexelBlock& sample, const FoldPlans& plans,
                           const BakeSettings& settings, bool with_others, bool dither)
    : state_(new State{info, plans, settings, {}, {}}) {
  if (with_others) state_->add_kinds(sample, dither);
}

HeldOutBaker::~HeldOutBaker() = default;
HeldOutBaker::HeldOutBaker(HeldOutBaker&&) noexcept = default;

const std::vector<RealisKind>& HeldOutBaker::others() const {
  return state_->names;
}

int HeldOutBaker::lobes() const {
  const auto& system = state_->plans.plan.system;
  return system ? static_cast<int>(system->lobes().size()) : 0;
}

struct HeldOutTexels::State {
  // Amplitudes of one way to correct, by which plan they were made.
  struct Way {
    const BakedBy* baked = nullptr;
    Amplitudes amplitudes;
  };

  const HeldOutBaker::State& baker;
  std::vector<std::uint32_t> texels;
  BakedBy baked;
  std::map<int, BakedBy> others;
  Way whole;
  std::vector<Way> ways;

  std::size_t count() const { return texels.size(); }

  std::vector<float> corrected(const Way& way, const StackInfo& lit, const BlockRender& render,
                               std::span<const float> near_directions) const {
    std::vector<float> out = render.rgb;
    if (way.amplitudes.empty()) return out;
    std::vector<std::vector<float>> sums;
    for (const std::vector<float>& amplitudes : way.amplitudes) {
      sums.push_back(
          lobe_sums(way.baked->system->lobes(), directions_of(lit), near_directions, amplitudes, count()));
    }
    const std::vector<float>& chroma = way.baked->block.chroma;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::vector<float>& sum = sums[sums.size() == 1 ? 0 : c];
      for (std::size_t k = 0; k < count(); ++k) {
        const std::size_t at = c * count() + k;
        const double albedo = render.albedo.empty() ? 1.0 : static_cast<double>(render.albedo[at]);
        const double colour = chroma.empty() ? 1.0 : static_cast<double>(chroma[at]);
        const double modulation = lit.lights[0].intensity[c] * albedo * static_cast<double>(render.shade[k]);
        out[at] += static_cast<float>(modulation * colour * static_cast<double>(sum[k]));
      }
    }
    return out;
  }
};

HeldOutTexels::HeldOutTexels(std::unique_ptr<State> state) : state_(std::move(state)) {}
HeldOutTexels::~HeldOutTexels() = default;
HeldOutTexels::HeldOutTexels(HeldOutTexels&&) noexcept = default;

HeldOutTexels HeldOutBaker::bake(const TexelBlock& block) const {
  const State& s = *state_;
  std::unique_ptr<HeldOutTexels::State> texels(new HeldOutTexels::State{
      s, block.texels, bake_by(s.info, block, s.plans.plan, s.settings), {}, {}, {}});
  texels->whole = {&texels->baked, texels->baked.solved()};
  std::optional<KeptAmplitudes> kept;
  if (texels->baked.system != nullptr) kept.emplace(texels->baked.kept(block, s.info.width));
  for (const Kind& kind : s.kinds) {
    if (kind.plan == 0) {
      texels->ways.push_back({&texels->baked, kept->amplitudes(kind.kind.options, kind.ranges)});
      continue;
    }
    const BakedBy& other =
        texels->others.emplace(kind.plan, bake_by(s.info, block, s.plan_of(kind), s.settings)).first->second;
    texels->ways.push_back({&other, other.solved()});
  }
  return HeldOutTexels(std::move(texels));
}

LightPrediction HeldOutTexels::predict(std::uint32_t light, bool with_others) const {
  const State& s = *state_;
  const BakePlan& plan = s.baker.plans.plan;
  const StackInfo lit = with_lights(with_gains(s.baker.info, plan.gains), {light});
  // Texels without a picture: there is nothing of the light to look at.
  TexelBlock block;
  block.texels = s.texels;
  block.lights = 1;
  block.rgb.assign(3 * s.count(), 0.0F);
  const BlockRender render = render_of(lit, block, s.baked.block.surface, all_lights(lit), plan.base,
                                       s.baker.settings.albedo_in_modulation);
  std::vector<float> near;
  if (has_near_lights(lit)) near = luminance_problem(lit, block, render).directions;
  LightPrediction out;
  out.model = render.rgb;
  out.realis = s.corrected(s.whole, lit, render, near);
  if (!with_others) return out;
  for (const State::Way& way : s.ways) out.others.push_back(s.corrected(way, lit, render, near));
  return out;
}

bool HeldOutTexels::is_corrected(std::size_t texel) const {
  const State& s = *state_;
  for (const std::vector<float>& amplitudes : s.whole.amplitudes) {
    for (std::size_t at = texel; at < amplitudes.size(); at += s.count()) {
      if (amplitudes[at] != 0.0F) return true;
    }
  }
  return false;
}

}  // namespace brdfit::bake
