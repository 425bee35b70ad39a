// Predictions of choices against the pictures.
#include "cli/cost/stack_errors.h"

#include <array>
#include <cmath>

#include "bake/gains.h"
#include "bake/luminance.h"
#include "bake/shrunk_stack.h"

namespace brdfit::cli {
namespace {

double root_mean_255(double sum, double count) {
  return count > 0.0 ? 255.0 * std::sqrt(sum / count) : 0.0;
}

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
  std::vector<std::vector<float>> corrections;
  for (const std::vector<float>& amplitudes : stored.amplitudes) {
    corrections.push_back(bake::lobe_sums(stored.lobes, directions_of(base.info), base.rgb[0].directions,
                                          amplitudes, base.rgb[0].texels));
  }
  const std::size_t texels = base.rgb[0].texels;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    for (std::size_t k = 0; k < texels; ++k) {
      if (base.rgb[0].weight_of(l, k) == 0.0F) continue;
      const std::size_t at = base.rgb[0].at(l, k);
      std::array<double, 3> errors{};
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0.0;
        if (!corrections.empty()) sum = static_cast<double>(corrections[corrections.size() == 3 ? c : 0][at]);
        if (!stored.chroma.empty()) sum *= static_cast<double>(stored.chroma[c * texels + k]);
        errors[c] = static_cast<double>(base.rgb[c].residual[at]) -
                    static_cast<double>(base.rgb[c].modulation[at]) * sum;
      }
      sums.add(lights[l], errors, base.shade[at] > 0.0F);
    }
  }
}

}  // namespace

void StackErrorSums::add(std::size_t light, std::span<const double, 3> rgb, bool is_lit) {
  double luminance = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    luminance += bake::kLuminance[c] * rgb[c];
    rgb_ += rgb[c] * rgb[c] / 3.0;
  }
  luminance_[light] += luminance * luminance;
  count_[light] += 1.0;
  if (!is_lit) return;
  lit_ += luminance * luminance;
  lit_count_ += 1.0;
}

StackErrorSummary StackErrorSums::summary() const {
  StackErrorSummary out;
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t light = 0; light < luminance_.size(); ++light) {
    sum += luminance_[light];
    count += count_[light];
    out.worst_light_rmse_255 =
        std::max(out.worst_light_rmse_255, root_mean_255(luminance_[light], count_[light]));
  }
  out.rgb_rmse_255 = root_mean_255(rgb_, count);
  out.rmse_255 = root_mean_255(sum, count);
  out.lit_rmse_255 = root_mean_255(lit_, lit_count_);
  return out;
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
