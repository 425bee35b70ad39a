// Predictions of choices against the pictures.
#include "cli/cost/stack_errors.h"

#include <array>

#include "bake/channel_errors.h"
#include "bake/gains.h"
#include "bake/shrunk_stack.h"

namespace brdfit::cli {
namespace {

// What there is to correct under the lights to predict.
struct Base {
  StackInfo info;
  std::array<bake::TexelProblem, 3> rgb;
  std::vector<float> shade;
};

Base base_of(const StackTargets& targets, const bake::LightChoice& lights, const bake::Surface& surface,
             const bake::BakePlan& plan, bool albedo_in_modulation) {
  Base base;
  base.info = bake::with_lights(bake::with_gains(targets.info, plan.gains), lights);
  const TexelBlock block = bake::with_lights(targets.sample, lights);
  bake::BlockRender render = bake::render_of(base.info, block, surface, bake::all_lights(base.info),
                                             plan.base, albedo_in_modulation);
  base.rgb = bake::rgb_problems(base.info, block, render);
  base.shade = std::move(render.shade);
  return base;
}

// In the size of the whole picture, from the lights that the plan has seen.
bake::Surface whole_surface(const StackTargets& targets, const bake::BakePlan& plan) {
  const StackInfo seen = bake::with_lights(bake::with_gains(targets.info, plan.gains), plan.lights);
  const TexelBlock block = bake::with_lights(targets.sample, plan.lights);
  const bake::LightChoice all = bake::all_lights(seen);
  return bake::with_base_colour(seen, block, bake::photometric_stereo(seen, block, all), all, plan.base);
}

void magnify(Stored& stored, const StackTargets& targets, int shrink, const TexelBlock& baked_sample) {
  for (std::vector<float>& planes : stored.amplitudes) {
    planes = bake::magnified(targets.info, shrink, planes, baked_sample.texels, targets.sample.texels);
  }
  if (!stored.chroma.empty()) {
    stored.chroma =
        bake::magnified(targets.info, shrink, stored.chroma, baked_sample.texels, targets.sample.texels);
  }
}

void add_choice(const Base& base, const Stored& stored, const bake::LightChoice& lights,
                StackErrorSums& sums) {
  const bake::ChannelPlanes errors = bake::channel_errors(base.rgb, stored.lobes, directions_of(base.info),
                                                          stored.amplitudes, stored.chroma);
  sums.luminance.add(lights, base.rgb[0], base.shade, bake::luminance_of(errors));
  for (std::size_t c = 0; c < 3; ++c) sums.rgb.add(lights, base.rgb[c], base.shade, errors[c]);
}

}  // namespace

StackErrorSummary StackErrorSums::summary() const {
  const bake::StackErrors errors = luminance.errors();
  return {rgb.errors().rmse_255, errors.rmse_255, errors.lit_rmse_255, errors.worst_light_rmse_255};
}

void add_errors(const StackTargets& targets, const bake::LightChoice& lights, const TexelBlock& baked_sample,
                const LobePlans& plans, const bake::BakeSettings& settings, ChoiceBake& baked,
                std::span<const StackChoice> choices, std::span<StackErrorSums* const> sums) {
  if (choices.empty()) return;
  const int shrink = choices.front().shrink;
  const Base base =
      base_of(targets, lights, shrink == 1 ? baked.surface() : whole_surface(targets, plans.plan), plans.plan,
              settings.albedo_in_modulation);
  for (std::size_t k = 0; k < choices.size(); ++k) {
    Stored stored = baked.stored(choices[k]);
    if (shrink != 1) magnify(stored, targets, shrink, baked_sample);
    add_choice(base, stored, lights, *sums[k]);
  }
}

}  // namespace brdfit::cli
