// Pipelines by effect set, push constants and batches of the material pass.
#include "gpu/material_pass.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "gpu/batches.h"

namespace brdfit {
namespace {

constexpr std::uint32_t kSpirv[] = {
#include "material.spv.inc"
};

// Laid out as `Parameters` in gpu/shaders/material.glsl.
struct PushConstants {
  std::uint32_t pair_count = 0;
  std::array<float, 26> values{};
};

PushConstants push_constants_of(const Material& material) {
  PushConstants push;
  const std::vector<float> values = float_values(material);
  std::ranges::copy(values, push.values.begin());
  return push;
}

std::size_t batch_size(const ComputeLimits& limits, std::size_t wanted) {
  const std::size_t bytes = limits.buffer_bytes / sizeof(FloatPair);
  return std::max<std::size_t>(1, std::min({wanted, limits.invocations, bytes}));
}

}  // namespace

MaterialPass::MaterialPass(ComputeDevice& device, const MaterialPassOptions& options)
    : device_(device), options_(options) {
  if (options_.shader.empty()) options_.shader = kSpirv;
}

MaterialPass::Key MaterialPass::key_of(const Material& material) {
  const MaterialOptions& options = material.options();
  const bool burley = material.model() == Model::kBurley;
  return {static_cast<std::int32_t>(material.model()), static_cast<std::int32_t>(material.effects().bits()),
          burley ? 0 : static_cast<std::int32_t>(options.masking),
          burley ? static_cast<std::int32_t>(options.burley_g) : 0,
          burley ? 0 : static_cast<std::int32_t>(options.diffuse)};
}

const ComputePipeline& MaterialPass::pipeline_for(const Material& material) {
  const Key key = key_of(material);
  const auto found = pipelines_.find(key);
  if (found != pipelines_.end()) return found->second;
  PipelineRequest request;
  request.spirv = options_.shader;
  request.constants = key;
  request.push_bytes = sizeof(PushConstants);
  return pipelines_.emplace(key, device_.compile(request)).first->second;
}

std::optional<double> MaterialPass::eval_cos(const Material& material, std::span<const FloatPair> pairs,
                                             std::span<FloatRgb> out) {
  if (pairs.size() != out.size()) {
    throw std::invalid_argument("MaterialPass::eval_cos: pairs and out differ in size");
  }
  const ComputePipeline& pipeline = pipeline_for(material);
  PushConstants push = push_constants_of(material);
  std::optional<double> total_ns = 0.0;
  run_in_batches(pairs.size(), batch_size(device_.limits(), options_.largest_batch),
                 [&](std::size_t first, std::size_t count) {
                   push.pair_count = static_cast<std::uint32_t>(count);
                   const std::array input = {std::as_bytes(pairs.subspan(first, count))};
                   const ComputeJob job = {input, std::as_bytes(std::span(&push, 1)), count};
                   const auto ns =
                       device_.run(pipeline, job, std::as_writable_bytes(out.subspan(first, count)));
                   total_ns = total_ns && ns ? std::optional(*total_ns + *ns) : std::nullopt;
                 });
  return total_ns;
}

}  // namespace brdfit
