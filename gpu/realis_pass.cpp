// Buffers, push constants and batches of the Realis pass.
#include "gpu/realis_pass.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "gpu/batches.h"

namespace brdfit {
namespace {

constexpr std::uint32_t kSpirv[] = {
#include "realis.spv.inc"
};

// Laid out as `Light` in gpu/shaders/realis.comp.
struct PushConstants {
  std::uint32_t texel_count = 0;
  std::array<float, 3> direction{};
  std::array<float, 3> intensity{};
  float albedo_range = 0.0F;
  float cos_normal_range = 0.0F;
};

constexpr std::size_t kSurfacePlanes = 12;

std::size_t textures_of(const RealisAsset& asset) {
  return static_cast<std::size_t>(
      realis_textures(asset.packing.dominant * asset.channels(), asset.packing.bits));
}

bool keeps_all(const RealisAsset& asset) {
  return static_cast<std::size_t>(asset.packing.dominant) == asset.lobes.size();
}

void check(const RealisAsset& asset, const RealisTexels& t, std::span<const float> out) {
  const std::size_t planes = 3 * t.count;
  const std::size_t chroma = asset.colour == RealisColour::kScaledChroma ? planes : 0;
  const bool fits = t.codes.size() == textures_of(asset) * t.count &&
                    t.masks.size() == (keeps_all(asset) ? 0 : t.count) && t.normals.size() == planes &&
                    t.albedo.size() == planes && t.baked_normals.size() == planes &&
                    t.baked_albedo.size() == planes && t.chroma.size() == chroma && out.size() == planes &&
                    asset.packing.ranges.size() == asset.plane_count();
  if (!fits) throw std::invalid_argument("RealisPass: sizes disagree");
}

std::vector<float> lobes_of(const RealisAsset& asset) {
  std::vector<float> out;
  const auto add = [&out](double value) { out.push_back(static_cast<float>(value)); };
  for (const Lobe& lobe : asset.lobes) {
    for (const double value : {lobe.axis.x, lobe.axis.y, lobe.axis.z, lobe.sharpness, lobe.cos_cut_off})
      add(value);
  }
  for (const RealisRange& range : asset.packing.ranges) {
    add(range.step);
    add(range.zero);
  }
  return out;
}

PushConstants push_of(const RealisAsset& asset, const RealisLight& light) {
  PushConstants push;
  const std::array direction = {light.direction.x, light.direction.y, light.direction.z};
  for (std::size_t c = 0; c < 3; ++c) {
    push.direction[c] = static_cast<float>(direction[c]);
    push.intensity[c] = static_cast<float>(light.intensity[c]);
  }
  push.albedo_range = static_cast<float>(asset.fade.albedo_range);
  push.cos_normal_range =
      static_cast<float>(std::cos(asset.fade.normal_range_deg * std::numbers::pi / 180.0));
  return push;
}

// A run of texels of planes, added to others.
template <class T>
void add_run(std::span<const T> planes, std::size_t texels, std::size_t first, std::size_t count,
             std::vector<T>& out) {
  for (std::size_t from = first; from < planes.size(); from += texels) {
    const auto begin = planes.begin() + static_cast<std::ptrdiff_t>(from);
    out.insert(out.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
  }
}

// Texels in one batch, by the largest buffer.
std::size_t batch_size(const ComputeLimits& limits, std::size_t wanted, std::size_t planes) {
  return std::max<std::size_t>(
      1, std::min({wanted, limits.invocations, limits.buffer_bytes / (planes * sizeof(float))}));
}

}  // namespace

RealisPass::RealisPass(ComputeDevice& device, std::size_t largest_batch)
    : device_(device), largest_batch_(largest_batch) {}

const ComputePipeline& RealisPass::pipeline_for(const RealisAsset& asset) {
  const Key key = {static_cast<std::int32_t>(asset.lobes.size()),
                   asset.packing.dominant,
                   asset.packing.bits,
                   asset.channels(),
                   asset.colour == RealisColour::kScaledChroma ? 1 : 0,
                   asset.albedo_in_modulation ? 1 : 0};
  const auto found = pipelines_.find(key);
  if (found != pipelines_.end()) return found->second;
  PipelineRequest request;
  request.spirv = kSpirv;
  request.constants = key;
  request.input_count = 3;
  request.push_bytes = sizeof(PushConstants);
  return pipelines_.emplace(key, device_.compile(request)).first->second;
}

std::optional<double> RealisPass::correction(const RealisAsset& asset, const RealisTexels& texels,
                                             const RealisLight& light, std::span<float> out) {
  check(asset, texels, out);
  std::ranges::fill(out, 0.0F);
  if (asset.lobes.empty() || texels.count == 0) return 0.0;
  const ComputePipeline& pipeline = pipeline_for(asset);
  const std::vector<float> lobes = lobes_of(asset);
  PushConstants push = push_of(asset, light);
  std::optional<double> total_ns = 0.0;
  const std::size_t planes = kSurfacePlanes + (texels.chroma.empty() ? 0 : 3);
  run_in_batches(
      texels.count, batch_size(device_.limits(), largest_batch_, planes),
      [&](std::size_t first, std::size_t count) {
        std::vector<std::uint32_t> codes;
        add_run(texels.codes, texels.count, first, count, codes);
        add_run(texels.masks, texels.count, first, count, codes);
        std::vector<float> values;
        for (const std::span<const float> part :
             {texels.normals, texels.albedo, texels.baked_normals, texels.baked_albedo, texels.chroma})
          add_run(part, texels.count, first, count, values);
        push.texel_count = static_cast<std::uint32_t>(count);
        const std::array inputs = {std::as_bytes(std::span(lobes)), std::as_bytes(std::span(codes)),
                                   std::as_bytes(std::span(values))};
        std::vector<float> results(3 * count);
        const auto ns = device_.run(pipeline, {inputs, std::as_bytes(std::span(&push, 1)), count},
                                    std::as_writable_bytes(std::span(results)));
        for (std::size_t c = 0; c < 3; ++c) {
          std::copy_n(results.begin() + static_cast<std::ptrdiff_t>(c * count), count,
                      out.begin() + static_cast<std::ptrdiff_t>(c * texels.count + first));
        }
        total_ns = total_ns && ns ? std::optional(*total_ns + *ns) : std::nullopt;
      });
  return total_ns;
}

}  // namespace brdfit
