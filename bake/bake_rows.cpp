// Sources of vector jobs, from blocks.
#include "bake/bake_rows.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "bake/codes.h"
#include "bake/gains.h"
#include "bake/luminance.h"
#include "bake/solve_parallel.h"

namespace brdfit::bake {
namespace {

constexpr int kBits = 8;
constexpr int kTop = realis_top_code(kBits);

Surface given_surface(const TexelBlock& block) {
  return {block.normals, block.albedo, std::vector<TexelState>(block.count(), TexelState::kOk)};
}

// What the vector code reads of lights.
struct LightTables {
  std::vector<float> direction;
  std::vector<float> colour;

  explicit LightTables(const StackInfo& info) {
    for (const StackLight& light : info.lights) {
      for (const double part : {light.direction.x, light.direction.y, light.direction.z}) {
        direction.push_back(static_cast<float>(part));
      }
      for (std::size_t c = 0; c < 3; ++c)
        colour.push_back(static_cast<float>(kLuminance[c] * light.intensity[c]));
    }
  }
};

void check(const StackInfo& info, const TexelBlock& block) {
  const std::size_t texels = block.count();
  const bool fits =
      block.lights == info.lights.size() && block.rgb.size() == block.lights * block.channels * texels &&
      (block.weight.empty() || block.weight.size() == block.lights * texels) &&
      (block.channels == 3 || (block.channels == 1 && !has_near_lights(info) &&
                               block.normals.size() == 3 * texels && block.albedo.size() == 3 * texels));
  if (!fits) throw std::invalid_argument("bake_rows: sizes disagree");
}

}  // namespace

bool has_short_way(const StackInfo& info, const BakePlan& plan, const BakeSettings& settings,
                   const RealisPacking& packing) {
  return settings.colour == RealisColour::kLuminance && packing.bits == kBits && plan.system &&
         packing.dominant == static_cast<int>(plan.system->lobes().size()) &&
         plan.lights.size() == info.lights.size() &&
         std::ranges::all_of(packing.ranges, [](const RealisRange& range) { return range.step > 0.0; });
}

bool needs_luminance_alone(const StackInfo& info, const BakePlan& plan) {
  return !plan.base.material && info.has_normals && info.has_albedo && !has_near_lights(info);
}

std::size_t cut_codes(const BakedRows& rows) {
  return static_cast<std::size_t>(
      std::ranges::count_if(rows.stored, [](std::uint8_t code) { return code == 0 || code == kTop; }));
}

namespace {

// What a job reads, and where it lies. Filled in once, in place.
struct Source {
  ShadeSource shade;
  std::vector<float>& residual;
  LightTables lights;
  TexelProblem problem;  // of near lights: each texel sees them elsewhere
  std::vector<double> lobes;
  NearLights near;

  Source(const StackInfo& info, std::vector<float>& room) : residual(room), lights(info) {}
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  Surface prepare(const StackInfo& info, const TexelBlock& block, const BaseModel& base,
                  bool albedo_in_modulation) {
    const LightChoice all = all_lights(info);
    shade.values = block.rgb.data();
    shade.channels = block.channels;
    Surface surface;
    if (block.channels == 1) {
      surface = given_surface(block);
    } else if (base.material) {
      surface =
          base_colour_and_residual(info, block, photometric_stereo(info, block, all), all, base, residual);
      shade.values = residual.data();
      shade.channels = 1;
      shade.is_residual = true;
    } else {
      surface = photometric_stereo(info, block, all);
    }
    shade.direction = lights.direction.data();
    shade.colour = lights.colour.data();
    for (std::size_t c = 0; c < 3; ++c) shade.mix[c] = static_cast<float>(kLuminance[c]);
    shade.albedo_in_modulation = albedo_in_modulation;
    return surface;
  }

  Surface prepare_near(const StackInfo& info, const TexelBlock& block, const BakePlan& plan,
                       bool albedo_in_modulation) {
    Surface surface = surface_of(info, block, plan.base);
    problem = luminance_problem(
        info, block, render_of(info, block, surface, all_lights(info), plan.base, albedo_in_modulation));
    lobes = lobe_numbers(plan.system->lobes());
    near = {problem.directions.data(), lobes.data()};
    return surface;
  }

  void put(const BakedRows& baked, const TexelBlock& block, SolveJob& job) {
    if (near.directions != nullptr) {
      job.residual = problem.residual.data();
      job.modulation = problem.modulation.data();
      job.weight = problem.weight.empty() ? nullptr : problem.weight.data();
      job.near = &near;
      return;
    }
    shade.normals = baked.surface.normals.data();
    shade.albedo = baked.surface.albedo.data();
    job.source = &shade;
    job.weight = block.weight.empty() ? nullptr : block.weight.data();
  }
};

}  // namespace

BakedRows bake_rows(const StackInfo& whole, const TexelBlock& block, const BakePlan& plan,
                    const BakeSettings& settings, const RealisPacking& packing, bool dither,
                    std::vector<float>* room) {
  const StackInfo info = with_gains(whole, plan.gains);
  check(info, block);
  BakedRows baked;
  std::vector<float> own;
  Source source(info, room != nullptr ? *room : own);
  baked.surface = has_near_lights(info)
                      ? source.prepare_near(info, block, plan, settings.albedo_in_modulation)
                      : source.prepare(info, block, plan.base, settings.albedo_in_modulation);
  const LobeSystem& system = *plan.system;
  const std::size_t lobes = system.lobes().size();
  const SolveOptions options;
  SolveJob job = solve_job(system, block.lights, block.count(), options, baked.solved);
  source.put(baked, block, job);
  baked.stored.assign(lobes * block.count(), 0);
  std::vector<float> steps;
  std::vector<float> zeros;
  for (const RealisRange& range : packing.ranges) {
    steps.push_back(static_cast<float>(range.step));
    zeros.push_back(static_cast<float>(range.zero));
  }
  RoundJob round;
  round.steps = steps.data();
  round.zeros = zeros.data();
  round.dither = static_cast<float>(kDitherStrength);
  round.top = static_cast<float>(kTop);
  round.stored = baked.stored.data();
  if (dither) round.texels = block.texels.data();
  round.asset_width = static_cast<std::uint32_t>(info.width);
  job.round = &round;
  solve_parallel(job, options.isa);
  return baked;
}

}  // namespace brdfit::bake
