// The Realis correction on a Vulkan device, from codes as they are stored (8 and 4 bits).
#ifndef BRDFIT_GPU_REALIS_PASS_H_
#define BRDFIT_GPU_REALIS_PASS_H_

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "brdf/realis_asset.h"
#include "gpu/compute.h"

namespace brdfit {

// What a shader has of some texels. Planes are [plane][texel].
struct RealisTexels {
  std::size_t count = 0;
  // [texture][texel]: the four bytes of a texel of each packed texture, red in the lowest.
  std::span<const std::uint32_t> codes;
  std::span<const std::uint32_t> masks;  // bit k: lobe k is kept; empty where all are
  std::span<const float> normals;        // 3 planes, at run time
  std::span<const float> albedo;         // 3 planes, at run time
  std::span<const float> baked_normals;
  std::span<const float> baked_albedo;
  std::span<const float> chroma;  // 3 planes for scaled chroma, otherwise empty
};

// Corrects texels on a device. How many lobes, bits and channels are specialisation constants; pipelines are
// made when first needed and kept.
class RealisPass {
 public:
  // The device must outlive the pass. largest_batch: texels in one dispatch at most.
  explicit RealisPass(ComputeDevice& device, std::size_t largest_batch = std::size_t{1} << 20);

  // What is added to the render: modulation x fade x sum over lobes, [channel][texel], in single precision; 0
  // where the texel faces away. Returns the device's nanoseconds as ComputeDevice::run. Throws GpuError, and
  // std::invalid_argument if sizes disagree.
  std::optional<double> correction(const RealisAsset& asset, const RealisTexels& texels,
                                   const RealisLight& light, std::span<float> out);

 private:
  using Key = std::array<std::int32_t, 6>;
  const ComputePipeline& pipeline_for(const RealisAsset& asset);

  ComputeDevice& device_;
  std::size_t largest_batch_;
  std::map<Key, ComputePipeline> pipelines_;
};

}  // namespace brdfit

#endif  // BRDFIT_GPU_REALIS_PASS_H_
