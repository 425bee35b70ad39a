// Storage that the processor and the device both see. Inside the room only.
#ifndef BRDFIT_GPU_VULKAN_BUFFER_H_
#define BRDFIT_GPU_VULKAN_BUFFER_H_

#include <cstddef>
#include <span>
#include <vulkan/vulkan_raii.hpp>

namespace brdfit::gpu {

// A storage buffer that stays mapped, on the device itself where it has memory that the processor sees.
class SharedBuffer {
 public:
  // Makes room for so many bytes. What the buffer held is gone if it has to grow. Throws vk::SystemError,
  // with the buffer empty.
  void reserve(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device, std::size_t bytes);

  vk::Buffer handle() const { return *buffer_; }
  std::span<std::byte> bytes() const { return bytes_; }

 private:
  // The buffer goes before the memory that it is bound to.
  vk::raii::DeviceMemory memory_ = nullptr;
  vk::raii::Buffer buffer_ = nullptr;
  std::span<std::byte> bytes_;
};

}  // namespace brdfit::gpu

#endif  // BRDFIT_GPU_VULKAN_BUFFER_H_
