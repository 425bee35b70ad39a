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
      (block.channels == 3 ||
       (block.channels == 1 && block.normals.size() == 3 * texels && block.albedo.size() == 3 * texels));
  if (!fits) throw std::invalid_argument("bake_rows: sizes disagree");
}

NoiseOf noise_of(const TexelBlock& block, std::size_t lobes, int width) {
  return [&block, lobes, width](std::size_t first, std::size_t count, std::vector<float>& noise) {
    noise.resize(lobes * count);
    const auto wide = static_cast<std::uint32_t>(width);
    std::vector<std::uint32_t> x(count);
    std::vector<std::uint32_t> y(count);
    for (std::size_t k = 0; k < count; ++k) {
      y[k] = block.texels[first + k] / wide;
      x[k] = block.texels[first + k] - y[k] * wide;
    }
    for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
      float* to = noise.data() + lobe * count;
      for (std::size_t k = 0; k < count; ++k) {
        to[k] = static_cast<float>(dither_threshold(x[k], y[k], static_cast<int>(lobe)));
      }
    }
  };
}

}  // namespace

bool has_short_way(const StackInfo& info, const BakePlan& plan, const BakeSettings& settings,
                   const RealisPacking& packing) {
  return settings.colour == RealisColour::kLuminance && packing.bits == kBits && plan.system &&
         packing.dominant == static_cast<int>(plan.system->lobes().size()) && !has_near_lights(info) &&
         plan.lights.size() == info.lights.size() &&
         std::ranges::all_of(packing.ranges, [](const RealisRange& range) { return range.step > 0.0; });
}

bool needs_luminance_alone(const StackInfo& info, const BakePlan& plan) {
  return !plan.base.material && info.has_normals && info.has_albedo;
}

std::size_t cut_codes(const BakedRows& rows) {
  return static_cast<std::size_t>(
      std::ranges::count_if(rows.stored, [](std::uint8_t code) { return code == 0 || code == kTop; }));
}

BakedRows bake_rows(const StackInfo& whole, const TexelBlock& block, const BakePlan& plan,
                    const BakeSettings& settings, const RealisPacking& packing, bool dither) {
  const StackInfo info = with_gains(whole, plan.gains);
  check(info, block);
  BakedRows baked;
  const LightChoice all = all_lights(info);
  ShadeSource source;
  source.values = block.rgb.data();
  source.channels = block.channels;
  std::vector<float> render;
  std::vector<float> residual;
  if (block.channels == 1) {
    baked.surface = given_surface(block);
  } else if (plan.base.material && block.albedo.empty()) {
    ColouredSurface coloured =
        base_colour_and_residual(info, block, photometric_stereo(info, block, all), all, plan.base);
    baked.surface = std::move(coloured.surface);
    residual = std::move(coloured.residual);
    source.values = residual.data();
    source.channels = 1;
    source.is_residual = true;
  } else {
    baked.surface = photometric_stereo(info, block, all);
    if (plan.base.material) render = render_block(info, block, baked.surface, all, plan.base);
  }
  const LightTables lights(info);
  source.render = render.empty() ? nullptr : render.data();
  source.normals = baked.surface.normals.data();
  source.albedo = baked.surface.albedo.data();
  source.direction = lights.direction.data();
  source.colour = lights.colour.data();
  for (std::size_t c = 0; c < 3; ++c) source.mix[c] = static_cast<float>(kLuminance[c]);
  source.albedo_in_modulation = settings.albedo_in_modulation;

  const LobeSystem& system = *plan.system;
  const std::size_t lobes = system.lobes().size();
  const SolveOptions options;
  SolveJob job = solve_job(system, block.lights, block.count(), options, baked.solved);
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
  job.source = &source;
  job.weight = block.weight.empty() ? nullptr : block.weight.data();
  job.round = &round;
  solve_parallel(job, options.isa, dither ? noise_of(block, lobes, info.width) : NoiseOf());
  return baked;
}

}  // namespace brdfit::bake
