// Relighting on a Vulkan device, to be timed.
#ifndef BRDFIT_CLI_COST_STACK_DEVICE_H_
#define BRDFIT_CLI_COST_STACK_DEVICE_H_

#include <memory>
#include <string>
#include <vector>

#include "bake/held_correction.h"
#include "brdf/realis_asset.h"

namespace brdfit::cli {

class StackDevice {
 public:
  virtual ~StackDevice() = default;
  virtual std::string name() const = 0;
  // Nanoseconds of one texel and light by the device's clock, all of the device at work: the base material,
  // where there is one, and the correction from codes of 4 or 8 bits. NaN where it has no clock. correction:
  // of the last light, [channel][texel].
  virtual double nanoseconds(const RealisAsset& asset, const bake::HeldTexels& texels,
                             const std::vector<RealisLight>& lights, std::vector<float>& correction) = 0;
};

// device: as DeviceRequest::device. Null where there is none, with the reason. Two files define it.
std::unique_ptr<StackDevice> open_stack_device(const std::string& device, std::string& why);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_STACK_DEVICE_H_
