// Loader, instance, validation and choice of the device.
#include "gpu/vulkan_device.h"

#include <dlfcn.h>

#include <algorithm>
#include <charconv>
#include <cstring>

namespace brdfit::gpu {
namespace {

using Kind = GpuError::Kind;

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

constexpr const char* kInstallDriver =
    " Install the driver of the GPU or, for a device on the processor, on Debian: apt-get install "
    "mesa-vulkan-drivers";

// The loader is opened when the program runs, so that a program with this library starts without one.
vk::raii::Context open_loader() {
  try {
    return vk::raii::Context();
  } catch (const std::exception& error) {
    throw GpuError(Kind::kNoDriver, std::string("there is no Vulkan loader (") + error.what() +
                                        "). On Debian: apt-get install libvulkan1 mesa-vulkan-drivers");
  }
}

VKAPI_ATTR VkBool32 VKAPI_CALL pass_message_on(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                               VkDebugUtilsMessageTypeFlagsEXT,
                                               const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  (*static_cast<const OnMessage*>(user))(data->pMessage);
  return VK_FALSE;
}

vk::DebugUtilsMessengerCreateInfoEXT messenger_info(OnMessage* on_message) {
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
  return {{},
          Severity::eWarning | Severity::eError,
          Type::eValidation | Type::ePerformance,
          &pass_message_on,
          on_message};
}

void require_validation_layer(const vk::raii::Context& context) {
  const std::vector<vk::LayerProperties> layers = context.enumerateInstanceLayerProperties();
  const bool found = std::ranges::any_of(layers, [](const vk::LayerProperties& layer) {
    return std::strcmp(layer.layerName, kValidationLayer) == 0;
  });
  if (!found) {
    throw GpuError(Kind::kNoValidation,
                   "the Vulkan validation layers are not installed. On Debian: apt-get install "
                   "vulkan-validationlayers");
  }
}

vk::raii::Instance create_instance(const vk::raii::Context& context, OnMessage* on_message) {
  const vk::ApplicationInfo application("brdfit", 1, nullptr, 0, VK_API_VERSION_1_1);
  vk::InstanceCreateInfo info({}, &application);
  std::vector<const char*> layers;
  std::vector<const char*> extensions;
  vk::DebugUtilsMessengerCreateInfoEXT messages;
  if (*on_message) {
    require_validation_layer(context);
    layers = {kValidationLayer};
    extensions = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    messages = messenger_info(on_message);
    info.setPEnabledLayerNames(layers);
    info.setPEnabledExtensionNames(extensions);
    info.setPNext(&messages);
  }
  try {
    return context.createInstance(info);
  } catch (const vk::SystemError& error) {
    throw GpuError(Kind::kNoDriver,
                   std::string("there is no usable Vulkan driver (") + error.what() + ")." + kInstallDriver);
  }
}

// Whose memory it is that a driver never frees, the leak sanitizer can tell only as long as the driver is
// loaded.
void keep_drivers_loaded() {
#if defined(__SANITIZE_ADDRESS__)
  for (const char* module : {"libvulkan_lvp.so", "libVkLayer_khronos_validation.so"}) {
    dlopen(module, RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE);
  }
#endif
}

// "0: llvmpipe, 1: ..."
std::string list_of(const std::vector<vk::raii::PhysicalDevice>& devices) {
  std::string list;
  for (std::size_t k = 0; k < devices.size(); ++k) {
    list += (k == 0 ? "" : ", ") + std::to_string(k) + ": " + name_of(devices[k]);
  }
  return list;
}

bool is_index(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

VulkanInstance::VulkanInstance(OnMessage on_message)
    : on_message_(std::make_unique<OnMessage>(std::move(on_message))),
      context_(open_loader()),
      instance_(create_instance(context_, on_message_.get())),
      messenger_(nullptr) {
  if (*on_message_) messenger_ = instance_.createDebugUtilsMessengerEXT(messenger_info(on_message_.get()));
}

std::vector<vk::raii::PhysicalDevice> VulkanInstance::devices() const {
  try {
    std::vector<vk::raii::PhysicalDevice> devices = instance_.enumeratePhysicalDevices();
    keep_drivers_loaded();
    return devices;
  } catch (const vk::SystemError& error) {
    throw GpuError(Kind::kNoDriver, std::string("the Vulkan devices could not be listed (") + error.what() +
                                        ")." + kInstallDriver);
  }
}

std::string name_of(const vk::raii::PhysicalDevice& device) {
  return std::string(device.getProperties().deviceName.data());
}

vk::raii::PhysicalDevice choose_device(const std::vector<vk::raii::PhysicalDevice>& devices,
                                       const std::string& request) {
  if (devices.empty()) {
    throw GpuError(Kind::kNoDriver, std::string("there is a Vulkan driver but no device.") + kInstallDriver);
  }
  if (request.empty()) return devices.front();
  if (is_index(request)) {
    std::size_t index = devices.size();
    std::from_chars(request.data(), request.data() + request.size(), index);
    if (index < devices.size()) return devices[index];
    throw GpuError(Kind::kNoSuchDevice,
                   "there is no Vulkan device " + request + ". There are: " + list_of(devices));
  }
  const auto found = std::ranges::find_if(devices, [&](const vk::raii::PhysicalDevice& device) {
    return name_of(device).find(request) != std::string::npos;
  });
  if (found != devices.end()) return *found;
  throw GpuError(Kind::kNoSuchDevice,
                 "no Vulkan device has \"" + request + "\" in its name. There are: " + list_of(devices));
}

std::uint32_t compute_queue_family(const vk::raii::PhysicalDevice& device) {
  if (device.getProperties().apiVersion < VK_API_VERSION_1_1) {
    throw GpuError(Kind::kNoSuchDevice,
                   "the Vulkan device " + name_of(device) +
                       " is older than Vulkan 1.1: choose another one or update its driver");
  }
  const std::vector<vk::QueueFamilyProperties> families = device.getQueueFamilyProperties();
  for (std::uint32_t k = 0; k < families.size(); ++k) {
    if (families[k].queueFlags & vk::QueueFlagBits::eCompute) return k;
  }
  throw GpuError(Kind::kNoSuchDevice,
                 "the Vulkan device " + name_of(device) + " cannot compute: choose another one");
}

vk::raii::Device open_device(const vk::raii::PhysicalDevice& physical, std::uint32_t queue_family) {
  const float priority = 1.0F;
  const vk::DeviceQueueCreateInfo queue({}, queue_family, 1, &priority);
  try {
    return physical.createDevice(vk::DeviceCreateInfo({}, queue));
  } catch (const vk::SystemError& error) {
    throw gpu_error_of(error, name_of(physical));
  }
}

GpuError gpu_error_of(const vk::SystemError& error, const std::string& device) {
  const std::string subject = "the Vulkan device " + device;
  if (error.code() == vk::Result::eErrorDeviceLost) {
    return {Kind::kDeviceLost, subject +
                                   " was lost: its driver gave up. Start again; if that repeats, take "
                                   "another device or update the driver"};
  }
  if (error.code() == vk::Result::eErrorOutOfDeviceMemory) {
    return {Kind::kOutOfMemory, subject + " ran out of memory: free some, or use fewer pairs"};
  }
  if (error.code() == vk::Result::eErrorOutOfHostMemory) {
    return {Kind::kOutOfMemory, "the machine ran out of memory for " + subject +
                                    ": free some, or use fewer "
                                    "pairs"};
  }
  return {Kind::kFailed, subject + " failed (" + error.what() + ")"};
}

}  // namespace brdfit::gpu

#if defined(__SANITIZE_ADDRESS__)
// The leak sanitizer's hooks: what Mesa's processor driver, the layers and the loader keep for themselves is
// not ours, and not worth a word.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libvulkan_lvp.so\nleak:libVkLayer_khronos_validation.so\nleak:libvulkan.so\n";
}
extern "C" const char* __lsan_default_options() {
  return "print_suppressions=0";
}
#endif
