// Relighting a few thousand texels by one thread.
#include "cli/cost/stack_evaluation.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "cli/cost/paired_timing.h"

namespace brdfit::cli {
namespace {

constexpr std::size_t kLeastTexels = 8192;
constexpr int kLights = 8;

// Over the upper hemisphere, none near its rim.
std::vector<RealisLight> lights_to_time() {
  std::vector<RealisLight> lights;
  for (int k = 0; k < kLights; ++k) {
    const double z = 1.0 - 0.7 * (k + 0.5) / kLights;
    const double phi = k * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double s = std::sqrt(1.0 - z * z);
    lights.push_back({{s * std::cos(phi), s * std::sin(phi), z}, {1.0, 0.9, 0.8}});
  }
  return lights;
}

// Each plane's columns again and again.
template <class Value>
std::vector<Value> repeated(const std::vector<Value>& planes, std::size_t count, std::size_t times) {
  std::vector<Value> out;
  out.reserve(planes.size() * times);
  for (std::size_t at = 0; at < planes.size(); at += count) {
    for (std::size_t k = 0; k < times; ++k) {
      out.insert(out.end(), planes.begin() + static_cast<std::ptrdiff_t>(at),
                 planes.begin() + static_cast<std::ptrdiff_t>(at + count));
    }
  }
  return out;
}

RealisAsset asset_of(const StackInfo& info, const bake::BaseModel& base, const StackChoice& choice,
                     const Stored& stored, bool albedo_in_modulation) {
  RealisAsset asset;
  asset.width = info.width;
  asset.height = info.height;
  asset.view = info.view;
  asset.colour = choice.colour;
  asset.albedo_in_modulation = albedo_in_modulation;
  asset.lobes = stored.lobes;
  asset.base = base.material;
  asset.packing.bits = choice.is_code() ? static_cast<int>(choice.bits) : 8;
  asset.packing.dominant = std::min(choice.dominant, static_cast<int>(stored.lobes.size()));
  asset.packing.ranges = stored.ranges;
  return asset;
}

}  // namespace

StackEvaluation::StackEvaluation(const StackInfo& info, const bake::BaseModel& base,
                                 const StackChoice& choice, const Stored& stored,
                                 const bake::Surface& surface, bool albedo_in_modulation)
    : base_(base),
      info_(info),
      asset_(asset_of(info, base, choice, stored, albedo_in_modulation)),
      lights_(lights_to_time()) {
  const std::size_t count = surface.count();
  const std::size_t times = (kLeastTexels + count - 1) / count;
  texels_.surface = {repeated(surface.normals, count, times), repeated(surface.albedo, count, times),
                     repeated(surface.state, count, times)};
  texels_.baked = texels_.surface;
  texels_.chroma = repeated(stored.chroma, count, times);
  // [lobe][channel][texel] of [channel][lobe][texel].
  for (std::size_t lobe = 0; lobe < stored.lobes.size(); ++lobe) {
    for (const std::vector<float>& channel : stored.amplitudes) {
      const auto from = channel.begin() + static_cast<std::ptrdiff_t>(lobe * count);
      const std::vector<float> plane(from, from + static_cast<std::ptrdiff_t>(count));
      const std::vector<float> all = repeated(plane, count, times);
      texels_.amplitudes.insert(texels_.amplitudes.end(), all.begin(), all.end());
    }
  }
  held_ = bake::held_texels(asset_, choice.bits, texels_, repeated(stored.masks, count, times));
  block_.texels.resize(held_.count);
  std::iota(block_.texels.begin(), block_.texels.end(), 0U);
  block_.lights = 1;
  radiance_.resize(3 * held_.count);
  correction_.resize(3 * held_.count);
}

template <class Relight>
double StackEvaluation::timed(const Relight& relight) {
  double seconds = 0.0;
  tbb::task_arena alone(1);
  alone.execute([&] {
    const double start = thread_cpu_seconds();
    for (const RealisLight& light : lights_) relight(light);
    seconds = thread_cpu_seconds() - start;
  });
  return 1e9 * seconds / static_cast<double>(held_.count * lights_.size());
}

double StackEvaluation::nanoseconds() {
  return timed([this](const RealisLight& light) {
    info_.lights = {{"", light.direction, {}, light.intensity}};
    bake::render_block(info_, block_, held_.surface, bake::all_lights(info_), base_, radiance_);
    bake::held_correction(asset_, held_, light, correction_);
    for (std::size_t k = 0; k < radiance_.size(); ++k) radiance_[k] += correction_[k];
  });
}

double StackEvaluation::nanoseconds_in_double() {
  return timed(
      [this](const RealisLight& light) { radiance_ = bake::relight(asset_, texels_, light).corrected; });
}

}  // namespace brdfit::cli
