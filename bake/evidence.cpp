// Folds over lights: plan, bake, predict, tally.
#include "bake/evidence.h"

#include <algorithm>
#include <map>
#include <utility>

namespace brdfit::bake {
namespace {

// Above this many lights, leaving each out by itself costs too much.
constexpr std::size_t kMostSingleFolds = 24;
constexpr std::size_t kLightsPerFold = 10;

using SumsByName = std::map<std::string, MethodSums>;

void add(const std::vector<MethodSums>& sums, SumsByName& all) {
  for (const MethodSums& of_fold : sums) {
    const auto [found, is_first] = all.try_emplace(of_fold.name, of_fold);
    if (is_first) continue;
    found->second.luminance.add(of_fold.luminance);
    found->second.rgb.add(of_fold.rgb);
  }
}

// held: nothing where no light was held out.
void set_errors(MethodEvidence& method, const MethodSums& train, const MethodSums* held) {
  method.train = train.luminance.errors();
  if (held != nullptr) method.held_out = held->luminance.errors();
  if (train.rgb.is_empty()) return;
  method.rgb.emplace().train = train.rgb.errors();
  if (held != nullptr) method.rgb->held_out = held->rgb.errors();
}

}  // namespace

int fold_count(std::size_t lights, int asked) {
  if (asked > 0) return std::min(asked, static_cast<int>(lights));
  const std::size_t folds = lights <= kMostSingleFolds
                                ? lights
                                : std::max<std::size_t>(5, (lights + kLightsPerFold - 1) / kLightsPerFold);
  return static_cast<int>(folds);
}

LightChoice held_out_lights(std::size_t lights, int fold, int count) {
  LightChoice held;
  for (auto light = static_cast<std::uint32_t>(fold); light < lights;
       light += static_cast<std::uint32_t>(count)) {
    held.push_back(light);
  }
  return held;
}

const MethodEvidence* Evidence::find(const std::string& name) const {
  const auto found =
      std::find_if(methods.begin(), methods.end(), [&](const MethodEvidence& m) { return m.name == name; });
  return found == methods.end() ? nullptr : &*found;
}

FoldPlans fold_plans(BakePlan plan) {
  FoldPlans plans;
  for (const auto& [lobes, system] : plan.also) {
    BakePlan other = plan;
    other.also.clear();
    other.system = system;
    plans.other_lobes.emplace(lobes, std::move(other));
  }
  plans.plan = std::move(plan);
  return plans;
}

BakeSettings with_compared_lobes(BakeSettings settings, const EvidenceOptions& options) {
  settings.also_lobes = options.other_lobes;
  std::erase(settings.also_lobes, settings.lobes);
  return settings;
}

Evidence evaluate(const StackInfo& info, const TexelBlock& sample, const BakePlan& whole_plan,
                  const BakeSettings& whole_settings, const EvidenceOptions& options) {
  const BakeSettings settings = with_compared_lobes(whole_settings, options);
  BakePlan plan = whole_plan;
  if (plan.also.size() != settings.also_lobes.size()) {
    plan_lobes(plan, with_lights(with_gains(info, plan.gains), plan.lights), with_lights(sample, plan.lights),
               settings);
  }
  const std::size_t lights = info.lights.size();
  Evidence evidence;
  evidence.folds = fold_count(lights, options.folds);
  evidence.texels = sample.count();
  // Folds may choose other numbers of lobes than the whole plan: they keep as many per texel as it would.
  const int most_kept = half_of(plan.system ? static_cast<int>(plan.system->lobes().size()) : settings.lobes);
  const MethodOptions methods{options.compressed, most_kept, options.dither, options.check};
  const auto compare = [&](const BakePlan& by, const LightChoice& under) {
    return compare_methods(info, sample, by, settings, methods, under);
  };
  ComparedMethods train = compare(plan, plan.lights);
  SumsByName held;
  for (int fold = 0; fold < evidence.folds; ++fold) {
    const LightChoice out = held_out_lights(lights, fold, evidence.folds);
    const LightChoice kept = without(info, out);
    if (kept.empty()) continue;
    const auto make = [&] {
      FoldEvidence made;
      made.plan = plan_bake(info, sample, kept, settings);
      made.sums = compare(made.plan, out).sums;
      return made;
    };
    FoldEvidence found = options.fold_of ? options.fold_of(fold, make) : make();
    add(found.sums, held);
    if (options.on_fold) options.on_fold(fold, fold_plans(std::move(found.plan)));
    if (options.progress) options.progress(static_cast<double>(fold + 1) / evidence.folds);
  }
  evidence.methods = std::move(train.methods);
  for (std::size_t k = 0; k < evidence.methods.size(); ++k) {
    const auto found = held.find(evidence.methods[k].name);
    set_errors(evidence.methods[k], train.sums[k], found == held.end() ? nullptr : &found->second);
  }
  return evidence;
}

}  // namespace brdfit::bake
