// From the loader to a logical device: what every Vulkan program begins with. Inside the room only.
#ifndef BRDFIT_GPU_VULKAN_DEVICE_H_
#define BRDFIT_GPU_VULKAN_DEVICE_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "gpu/error.h"

namespace brdfit::gpu {

using OnMessage = std::function<void(const std::string&)>;

// Loader, instance and, where messages are wanted, the validation layers that send them. Members are
// destroyed in the reverse of their order, which is what Vulkan asks for.
class VulkanInstance {
 public:
  // Throws GpuError where there is no loader, no driver, or no layer though on_message is set.
  explicit VulkanInstance(OnMessage on_message);
  VulkanInstance(const VulkanInstance&) = delete;
  VulkanInstance& operator=(const VulkanInstance&) = delete;

  // In the order of their indices.
  std::vector<vk::raii::PhysicalDevice> devices() const;

 private:
  std::unique_ptr<OnMessage> on_message_;  // where the driver finds it
  vk::raii::Context context_;
  vk::raii::Instance instance_;
  vk::raii::DebugUtilsMessengerEXT messenger_;
};

std::string name_of(const vk::raii::PhysicalDevice& device);

// The device that a request names: empty is the first, digits are an index, anything else is a part of the
// name. Throws GpuError (kNoDriver, kNoSuchDevice) with a list of those there are.
vk::raii::PhysicalDevice choose_device(const std::vector<vk::raii::PhysicalDevice>& devices,
                                       const std::string& request);

// The first queue family that computes; GpuError if there is none or the device is older than Vulkan 1.1.
std::uint32_t compute_queue_family(const vk::raii::PhysicalDevice& device);

vk::raii::Device open_device(const vk::raii::PhysicalDevice& physical, std::uint32_t queue_family);

// What a driver threw, as an error that names the device and says what to do.
GpuError gpu_error_of(const vk::SystemError& error, const std::string& device);

}  // namespace brdfit::gpu

#endif  // BRDFIT_GPU_VULKAN_DEVICE_H_
