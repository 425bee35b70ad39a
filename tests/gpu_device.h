// The Vulkan device of a test program: validation layers on where they are installed, and no message from
// them.
#ifndef BRDFIT_TESTS_GPU_DEVICE_H_
#define BRDFIT_TESTS_GPU_DEVICE_H_

#include <gtest/gtest.h>

#include <iostream>
#include <string>
#include <vector>

#include "gpu/compute.h"

namespace brdfit::tests {

inline std::vector<std::string>& validation_messages() {
  static std::vector<std::string> messages;
  return messages;
}

// A request whose device is watched, or a plain one where the layers are not installed.
inline DeviceRequest watched_request(const std::string& device = "") {
  DeviceRequest request{device, [](const std::string& text) { validation_messages().push_back(text); }};
  try {
    ComputeDevice::open(request);
  } catch (const GpuError& error) {
    if (error.kind() != GpuError::Kind::kNoValidation) throw;
    request.on_validation_message = nullptr;
  }
  return request;
}

// The device that the tests compute on.
inline ComputeDevice& test_device() {
  static auto* const device = new ComputeDevice(ComputeDevice::open(watched_request()));
  return *device;
}

// Says what the tests ran on, and fails if the layers had anything to say.
class VulkanEnvironment : public testing::Environment {
 public:
  void SetUp() override {
    const bool watched = watched_request().on_validation_message != nullptr;
    std::cout << "Vulkan device: " << test_device().name() << ", validation layers "
              << (watched ? "on" : "not installed") << "\n";
  }
  void TearDown() override {
    for (const std::string& message : validation_messages()) ADD_FAILURE() << "validation: " << message;
  }
};

inline const testing::Environment* const vulkan_environment =
    testing::AddGlobalTestEnvironment(new VulkanEnvironment);

}  // namespace brdfit::tests

#endif  // BRDFIT_TESTS_GPU_DEVICE_H_
