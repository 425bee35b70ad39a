// The stages of planning in their order, and a block baked by a plan.
#include "bake/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "bake/channel_errors.h"
#include "bake/luminance.h"
#include "bake/ridge.h"

namespace brdfit::bake {
namespace {

std::vector<float> shades_of(const StackInfo& info, const TexelBlock& block, const Surface& surface) {
  const std::size_t texels = block.count();
  std::vector<float> shade(info.lights.size() * texels);
  for (std::size_t light = 0; light < info.lights.size(); ++light) {
    for (std::size_t k = 0; k < texels; ++k) {
      const Incidence from = incidence(info, light, block.texels[k]);
      const double cos_i = from.direction.x * static_cast<double>(surface.normals[k]) +
                           from.direction.y * static_cast<double>(surface.normals[texels + k]) +
                           from.direction.z * static_cast<double>(surface.normals[2 * texels + k]);
      shade[light * texels + k] = static_cast<float>(from.falloff * std::max(cos_i, 0.0));
    }
  }
  return shade;
}

// Numbers of lobes to choose from where none is asked for.
const std::vector<int> kLobeCounts = {2, 4, 6, 8, 12, 16};

}  // namespace

bool BakeSettings::is_valid(std::string* why) const {
  if (given_penalty && !(*given_penalty > 0.0 && std::isfinite(*given_penalty))) {
    if (why != nullptr) *why = "given_penalty must be positive";
    return false;
  }
  if (!(ridge_factor > 0.0 && std::isfinite(ridge_factor))) {
    if (why != nullptr) *why = "ridge_factor must be positive";
    return false;
  }
  if (lobes >= 0 && lobes <= kMaxLobes) return true;
  if (why != nullptr) *why = fmt::format("lobes is {}, not in [0, {}]", lobes, kMaxLobes);
  return false;
}

StackInfo with_lights(const StackInfo& info, const LightChoice& lights) {
  StackInfo out = info;
  out.lights.clear();
  for (const std::uint32_t light : lights) out.lights.push_back(info.lights[light]);
  return out;
}

TexelBlock with_lights(const TexelBlock& block, const LightChoice& lights) {
  TexelBlock out;
  out.texels = block.texels;
  out.lights = lights.size();
  out.normals = block.normals;
  out.albedo = block.albedo;
  const auto plane = static_cast<std::ptrdiff_t>(block.count());
  for (const std::uint32_t light : lights) {
    const auto from = block.rgb.begin() + static_cast<std::ptrdiff_t>(light) * 3 * plane;
    out.rgb.insert(out.rgb.end(), from, from + 3 * plane);
    if (block.weight.empty()) continue;
    const auto weight = block.weight.begin() + static_cast<std::ptrdiff_t>(light) * plane;
    out.weight.insert(out.weight.end(), weight, weight + plane);
  }
  return out;
}

BlockRender render_of(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                      const LightChoice& lights, const BaseModel& base, bool albedo_in_modulation) {
  BlockRender render;
  render.rgb = render_block(info, block, surface, lights, base);
  render.shade = shades_of(with_lights(info, lights), block, surface);
  if (albedo_in_modulation) render.albedo = surface.albedo;
  return render;
}

namespace {

std::vector<TexelProblem> problems_of(const StackInfo& info, const TexelBlock& block,
                                      const BlockRender& render, RealisColour colour) {
  std::vector<TexelProblem> problems;
  if (colour != RealisColour::kRgb) {
    problems.push_back(luminance_problem(info, block, render));
  } else {
    for (TexelProblem& problem : rgb_problems(info, block, render)) problems.push_back(std::move(problem));
  }
  return problems;
}

// Squared modulations of a white texel that faces the viewer: a scale for lobes whose penalty is known, which
// does not depend on any picture.
std::vector<double> facing_modulation(const StackInfo& info) {
  std::vector<double> squares;
  for (const StackLight& light : info.lights) {
    const Vec3& d = light.direction;
    double luminance = 0.0;
    for (std::size_t c = 0; c < 3; ++c) luminance += kLuminance[c] * light.intensity[c];
    const double cosine = d.x * info.view.x + d.y * info.view.y + d.z * info.view.z;
    squares.push_back(std::pow(luminance * std::max(cosine, 0.0), 2));
  }
  return squares;
}

LobeSystem given_system(const StackInfo& info, const BakeSettings& settings) {
  return LobeSystem::with_penalty(*settings.given_lobes, directions_of(info), facing_modulation(info),
                                  *settings.given_penalty);
}

}  // namespace

bool is_decided(const BakeSettings& settings) {
  return settings.base == BaseKind::kLambert && !settings.gains && settings.given_lobes &&
         settings.given_penalty;
}

BakePlan decided_plan(const StackInfo& info, const BakeSettings& settings) {
  std::string why = "something is left to decide";
  if (!is_decided(settings) || !settings.is_valid(&why)) {
    throw std::invalid_argument("decided_plan: " + why);
  }
  BakePlan plan;
  plan.lights = all_lights(info);
  plan.gains.assign(info.lights.size(), 1.0);
  plan.system.emplace(given_system(info, settings));
  TexelProblem empty;
  empty.lights = info.lights.size();
  plan.warnings =
      solve_warnings(plan.system->directions(), plan.system->lobes().size(), &*plan.system, empty);
  return plan;
}

namespace {

// Those that are not given, and those to compare with.
void choose_open_lobes(BakePlan& plan, const ProblemOf& problem_of, std::span<const Vec3> directions,
                       const BakeSettings& settings) {
  for (const int count : settings.also_lobes) plan.also[count].reset();
  if (directions.size() < 2) return;
  std::vector<std::vector<int>> groups;
  for (const int count : settings.also_lobes) groups.push_back({count});
  if (!settings.given_lobes) {
    groups.push_back(settings.lobes == 0 ? kLobeCounts : std::vector<int>{settings.lobes});
  }
  if (groups.empty()) return;
  ChoiceOptions options;
  options.optimise = settings.optimise;
  options.search.seed = settings.seed;
  options.classes.seed = settings.seed;
  options.check = settings.check;
  std::vector<LobeChoice> choices = choose_lobes_each(problem_of, directions, groups, options);
  const auto system_of = [&](const LobeChoice& choice) -> std::optional<LobeSystem> {
    if (choice.lobes.empty()) return std::nullopt;
    return LobeSystem(choice.lobes, directions, choice.squared_modulation,
                      settings.ridge_factor * choice.ridge);
  };
  for (std::size_t k = 0; k < settings.also_lobes.size(); ++k) {
    plan.also[settings.also_lobes[k]] = system_of(choices[k]);
  }
  if (settings.given_lobes) return;
  plan.system = system_of(choices.back());
  plan.lobe_choice = std::move(choices.back());
}

// Choices are made on so many texels; more of them say little that is new.
constexpr std::size_t kChoiceTexels = 4096;

// The least that would have been baked.
std::size_t lobes_asked_for(const BakeSettings& settings) {
  if (settings.given_lobes) return settings.given_lobes->size();
  return static_cast<std::size_t>(settings.lobes == 0 ? kLobeCounts.front() : settings.lobes);
}

}  // namespace

void plan_lobes(BakePlan& plan, const StackInfo& info, const TexelBlock& sample,
                const BakeSettings& settings) {
  plan.system.reset();
  const std::vector<Vec3> directions = directions_of(info);
  const auto problem_of = [&](std::span<const std::size_t> training) {
    const LightChoice kept(training.begin(), training.end());
    const StackInfo seen = with_lights(info, kept);
    const Surface surface = surface_of(seen, with_lights(sample, kept), plan.base);
    return luminance_problem(
        info, sample,
        render_of(info, sample, surface, all_lights(info), plan.base, settings.albedo_in_modulation));
  };
  std::vector<std::size_t> all(info.lights.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const TexelProblem problem = problem_of(all);
  if (settings.given_lobes && settings.given_penalty) {
    plan.system.emplace(given_system(info, settings));
  } else if (settings.given_lobes) {
    const RidgeChoice ridge = choose_ridge(*settings.given_lobes, directions, problem);
    if (ridge.helps()) {
      plan.system.emplace(*settings.given_lobes, directions, mean_squared_modulation(problem),
                          settings.ridge_factor * ridge.ridge);
    }
  }
  choose_open_lobes(plan, problem_of, directions, settings);
  const std::size_t lobes = plan.system ? plan.system->lobes().size() : lobes_asked_for(settings);
  const LobeSystem* system = plan.system ? &*plan.system : nullptr;
  plan.warnings = solve_warnings(directions, lobes, system, problem);
  if (!plan.system) {
    plan.warnings.push_back(
        {"no-lobes-help",
         "no lobes lower the error under lights that they have not seen: nothing is corrected"});
  }
}

namespace {

// Gains and the base model, by held-out error where the choice is left open.
void plan_base(BakePlan& plan, const StackInfo& info, const TexelBlock& sample,
               const BakeSettings& settings) {
  const LightChoice all = all_lights(info);
  if (settings.base == BaseKind::kAuto) {
    ChooseBaseOptions options;
    options.models = {Model::kLambertGgx};
    if (settings.model != Model::kLambertGgx) options.models.push_back(settings.model);
    options.with_gains = settings.gains;
    options.check = settings.check;
    BaseChoice choice = choose_base_model(info, sample, all, options);
    plan.base = choice.fit.model;
    plan.candidates = std::move(choice.candidates);
    if (choice.chosen > 0) plan.material = std::move(choice.fit);
    if (settings.gains) plan.gain_estimate = std::move(choice.gains);
    return;
  }
  if (settings.gains) plan.gain_estimate = estimate_gains(info, sample, all);
  if (settings.base == BaseKind::kLambert) return;
  const StackInfo lit = plan.gain_estimate ? with_gains(info, plan.gain_estimate->gain) : info;
  SharedMaterialOptions options;
  options.model = settings.model;
  options.effects = effects_of(settings.model);
  plan.material = fit_shared_material(lit, sample, photometric_stereo(lit, sample, all), all, options);
  plan.base = plan.material->model;
}

}  // namespace

BakePlan plan_bake(const StackInfo& whole, const TexelBlock& whole_sample, const LightChoice& lights,
                   const BakeSettings& settings) {
  std::string why;
  if (!settings.is_valid(&why)) throw std::invalid_argument("BakeSettings: " + why);
  BakePlan plan;
  plan.lights = lights;
  plan.gains.assign(whole.lights.size(), 1.0);
  const TexelBlock sample = with_lights(thinned(whole_sample, kChoiceTexels), lights);
  plan_base(plan, with_lights(whole, lights), sample, settings);
  for (std::size_t k = 0; plan.gain_estimate && k < lights.size(); ++k) {
    plan.gains[lights[k]] = plan.gain_estimate->gain[k];
  }
  const StackInfo info = with_lights(with_gains(whole, plan.gains), lights);
  plan_lobes(plan, info, sample, settings);
  return plan;
}

Surface surface_of(const StackInfo& info, const TexelBlock& block, const BaseModel& base) {
  const LightChoice all = all_lights(info);
  return with_base_colour(info, block, photometric_stereo(info, block, all), all, base);
}

BakedBlock bake_block(const StackInfo& whole, const TexelBlock& whole_block, const BakePlan& plan,
                      const BakeSettings& settings) {
  const StackInfo info = with_lights(with_gains(whole, plan.gains), plan.lights);
  const TexelBlock block = with_lights(whole_block, plan.lights);
  BakedBlock baked;
  baked.surface = surface_of(info, block, plan.base);
  const BlockRender render =
      render_of(info, block, baked.surface, all_lights(info), plan.base, settings.albedo_in_modulation);
  baked.problems = problems_of(info, block, render, settings.colour);
  if (!plan.system) return baked;
  for (const TexelProblem& problem : baked.problems) baked.solved.push_back(solve(*plan.system, problem));
  if (settings.colour != RealisColour::kScaledChroma) return baked;
  baked.chroma = chroma_of(*plan.system, rgb_problems(info, block, render), baked.solved[0].amplitudes);
  return baked;
}

}  // namespace brdfit::bake
