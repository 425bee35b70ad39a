// Materials on a Vulkan device: the kernels of brdf/, as the shader gpu/shaders/material.comp includes them.
#ifndef BRDFIT_GPU_MATERIAL_PASS_H_
#define BRDFIT_GPU_MATERIAL_PASS_H_

#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "gpu/compute.h"
#include "gpu/float_material.h"

namespace brdfit {

struct MaterialPassOptions {
  // Pairs in one dispatch at most; the device's own limits come on top. A batch has 36 bytes a pair.
  std::size_t largest_batch = std::size_t{1} << 20;
  // SPIR-V to run in place of the built-in shader, with its bindings and specialisation constants. Empty: the
  // built-in one. Must outlive the pass.
  std::span<const std::uint32_t> shader;
};

// Evaluates materials on a device. Model, effects and options are specialisation constants, so an effect that
// is off is not in the pipeline; pipelines are made when first needed and kept.
class MaterialPass {
 public:
  // The device must outlive the pass.
  explicit MaterialPass(ComputeDevice& device, const MaterialPassOptions& options = {});

  // f cos_i in sr^-1 of each pair, in single precision; 0 where a direction is not above the horizon. The
  // parameters are rounded to float. Returns the nanoseconds that the device took by its own clock, uploads
  // and downloads not counted; null where it has no clock. Batches that are too large are split. Throws
  // GpuError, and std::invalid_argument if the sizes differ.
  std::optional<double> eval_cos(const Material& material, std::span<const FloatPair> pairs,
                                 std::span<FloatRgb> out);

  // How many pipelines there are by now.
  std::size_t pipeline_count() const { return pipelines_.size(); }

 private:
  // What the specialisation constants say: model, effects and the options that the model has.
  using Key = std::array<std::int32_t, 5>;
  static Key key_of(const Material& material);
  const ComputePipeline& pipeline_for(const Material& material);

  ComputeDevice& device_;
  MaterialPassOptions options_;
  std::map<Key, ComputePipeline> pipelines_;
};

}  // namespace brdfit

#endif  // BRDFIT_GPU_MATERIAL_PASS_H_
