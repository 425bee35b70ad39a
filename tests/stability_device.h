// The Vulkan device of the walks, where there is one.
#ifndef BRDFIT_TESTS_STABILITY_DEVICE_H_
#define BRDFIT_TESTS_STABILITY_DEVICE_H_

#include <string>
#include <vector>

#include "gpu/compute.h"

namespace brdfit::stability {

// The device, under the validation layers where these are installed; null where there is none, with the
// reason. Throws GpuError where a driver fails.
ComputeDevice* device(std::string* why_not);

// What the layers had to say.
std::vector<std::string>& validation_messages();

}  // namespace brdfit::stability

#endif  // BRDFIT_TESTS_STABILITY_DEVICE_H_
