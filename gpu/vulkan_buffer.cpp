// Memory types, allocation and mapping of shared buffers.
#include "gpu/vulkan_buffer.h"

#include <optional>

#include "gpu/error.h"

namespace brdfit::gpu {
namespace {

std::optional<std::uint32_t> memory_type(const vk::PhysicalDeviceMemoryProperties& memory,
                                         std::uint32_t allowed, vk::MemoryPropertyFlags wanted) {
  for (std::uint32_t k = 0; k < memory.memoryTypeCount; ++k) {
    if ((allowed >> k & 1U) != 0 && (memory.memoryTypes[k].propertyFlags & wanted) == wanted) return k;
  }
  return std::nullopt;
}

// Every implementation has a memory type that is both visible and coherent for buffers.
std::uint32_t shared_memory_type(const vk::PhysicalDeviceMemoryProperties& memory, std::uint32_t allowed) {
  const vk::MemoryPropertyFlags shared =
      vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent;
  if (const auto type = memory_type(memory, allowed, shared | vk::MemoryPropertyFlagBits::eDeviceLocal)) {
    return *type;
  }
  if (const auto type = memory_type(memory, allowed, shared)) return *type;
  throw GpuError(GpuError::Kind::kFailed,
                 "the Vulkan device has no memory that it shares with the processor");
}

}  // namespace

void SharedBuffer::reserve(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device,
                           std::size_t bytes) {
  if (bytes <= bytes_.size()) return;
  bytes_ = {};
  buffer_ = nullptr;
  memory_ = nullptr;
  buffer_ = device.createBuffer(vk::BufferCreateInfo({}, bytes, vk::BufferUsageFlagBits::eStorageBuffer));
  const vk::MemoryRequirements needs = buffer_.getMemoryRequirements();
  const std::uint32_t type = shared_memory_type(physical.getMemoryProperties(), needs.memoryTypeBits);
  memory_ = device.allocateMemory(vk::MemoryAllocateInfo(needs.size, type));
  buffer_.bindMemory(*memory_, 0);
  bytes_ = {static_cast<std::byte*>(memory_.mapMemory(0, bytes)), bytes};
}

}  // namespace brdfit::gpu
