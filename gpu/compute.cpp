// The Vulkan side of ComputeDevice: instance, device, buffers, pipeline, dispatch.
#include "gpu/compute.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vulkan/vulkan_raii.hpp>

namespace brdfit {
namespace {

constexpr std::uint32_t kInputBinding = 0;
constexpr std::uint32_t kOutputBinding = 1;

// The loader is opened when the program runs, so that a program with this library starts without one.
vk::raii::Context open_loader() {
  try {
    return vk::raii::Context();
  } catch (const std::exception& error) {
    throw std::runtime_error(std::string("There is no Vulkan loader (") + error.what() +
                             "). On Debian: apt-get install libvulkan1");
  }
}

vk::raii::Instance create_instance(const vk::raii::Context& context) {
  const vk::ApplicationInfo application("brdfit", 1, nullptr, 0, VK_API_VERSION_1_1);
  try {
    return context.createInstance(vk::InstanceCreateInfo({}, &application));
  } catch (const vk::SystemError& error) {
    throw std::runtime_error(
        std::string("There is no usable Vulkan driver (") + error.what() +
        "). Install the driver of the GPU or, for the processor, on Debian: apt-get install "
        "mesa-vulkan-drivers");
  }
}

std::string name_of(const vk::raii::PhysicalDevice& device) {
  return std::string(device.getProperties().deviceName.data());
}

std::vector<std::string> names_of(const std::vector<vk::raii::PhysicalDevice>& devices) {
  std::vector<std::string> names;
  for (const vk::raii::PhysicalDevice& device : devices) names.push_back(name_of(device));
  return names;
}

std::vector<vk::raii::PhysicalDevice> enumerate_devices(const vk::raii::Instance& instance) {
  try {
    return instance.enumeratePhysicalDevices();
  } catch (const vk::SystemError& error) {
    throw std::runtime_error(std::string("The Vulkan devices could not be listed (") + error.what() + ").");
  }
}

// "0: llvmpipe, 1: ..."
std::string list_of(const std::vector<vk::raii::PhysicalDevice>& devices) {
  std::string list;
  for (std::size_t k = 0; k < devices.size(); ++k) {
    list += (k == 0 ? "" : ", ") + std::to_string(k) + ": " + name_of(devices[k]);
  }
  return list;
}

std::size_t index_by_name(const std::vector<vk::raii::PhysicalDevice>& devices, std::string_view text) {
  for (std::size_t k = 0; k < devices.size(); ++k) {
    if (name_of(devices[k]).find(text) != std::string::npos) return k;
  }
  throw std::runtime_error("No Vulkan device has \"" + std::string(text) +
                           "\" in its name. There are: " + list_of(devices));
}

const vk::raii::PhysicalDevice& device_at(const std::vector<vk::raii::PhysicalDevice>& devices,
                                          std::size_t index) {
  if (index >= devices.size()) {
    throw std::runtime_error("There is no Vulkan device " + std::to_string(index) +
                             ". There are: " + list_of(devices));
  }
  return devices[index];
}

std::uint32_t compute_queue_family(const vk::raii::PhysicalDevice& device) {
  if (device.getProperties().apiVersion < VK_API_VERSION_1_1) {
    throw std::runtime_error("The Vulkan device " + name_of(device) +
                             " is older than Vulkan 1.1: choose another one or update its driver.");
  }
  const std::vector<vk::QueueFamilyProperties> families = device.getQueueFamilyProperties();
  for (std::uint32_t k = 0; k < families.size(); ++k) {
    if (families[k].queueFlags & vk::QueueFlagBits::eCompute) return k;
  }
  throw std::runtime_error("The Vulkan device " + name_of(device) + " cannot compute: choose another one.");
}

vk::raii::Device create_device(const vk::raii::PhysicalDevice& physical, std::uint32_t queue_family) {
  const float priority = 1.0F;
  const vk::DeviceQueueCreateInfo queue({}, queue_family, 1, &priority);
  try {
    return physical.createDevice(vk::DeviceCreateInfo({}, queue));
  } catch (const vk::SystemError& error) {
    throw std::runtime_error("The Vulkan device " + name_of(physical) + " could not be opened (" +
                             error.what() + ").");
  }
}

// Storage that the processor and the device both see.
struct SharedBuffer {
  vk::raii::Buffer buffer;
  vk::raii::DeviceMemory memory;
};

// Every implementation has a memory type that is both visible and coherent for buffers.
std::uint32_t shared_memory_type(const vk::PhysicalDeviceMemoryProperties& memory, std::uint32_t allowed) {
  const vk::MemoryPropertyFlags wanted =
      vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent;
  for (std::uint32_t k = 0; k < memory.memoryTypeCount; ++k) {
    if ((allowed >> k & 1U) != 0 && (memory.memoryTypes[k].propertyFlags & wanted) == wanted) return k;
  }
  throw std::runtime_error("The Vulkan device has no memory that it shares with the processor.");
}

SharedBuffer create_shared_buffer(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device,
                                  std::size_t bytes) {
  vk::raii::Buffer buffer =
      device.createBuffer(vk::BufferCreateInfo({}, bytes, vk::BufferUsageFlagBits::eStorageBuffer));
  const vk::MemoryRequirements needs = buffer.getMemoryRequirements();
  const std::uint32_t type = shared_memory_type(physical.getMemoryProperties(), needs.memoryTypeBits);
  vk::raii::DeviceMemory memory = device.allocateMemory(vk::MemoryAllocateInfo(needs.size, type));
  buffer.bindMemory(*memory, 0);
  return {std::move(buffer), std::move(memory)};
}

void write(const SharedBuffer& buffer, std::span<const float> values) {
  std::memcpy(buffer.memory.mapMemory(0, values.size_bytes()), values.data(), values.size_bytes());
  buffer.memory.unmapMemory();
}

void read(const SharedBuffer& buffer, std::span<float> values) {
  std::memcpy(values.data(), buffer.memory.mapMemory(0, values.size_bytes()), values.size_bytes());
  buffer.memory.unmapMemory();
}

// A compute pipeline over two storage buffers.
struct Pipeline {
  vk::raii::DescriptorSetLayout set_layout;
  vk::raii::PipelineLayout layout;
  vk::raii::Pipeline pipeline;
};

vk::raii::DescriptorSetLayout create_set_layout(const vk::raii::Device& device) {
  const auto storage = [](std::uint32_t binding) {
    return vk::DescriptorSetLayoutBinding(binding, vk::DescriptorType::eStorageBuffer, 1,
                                          vk::ShaderStageFlagBits::eCompute);
  };
  const std::array bindings = {storage(kInputBinding), storage(kOutputBinding)};
  return device.createDescriptorSetLayout(vk::DescriptorSetLayoutCreateInfo({}, bindings));
}

Pipeline create_pipeline(const vk::raii::Device& device, std::span<const std::uint32_t> spirv) {
  const std::uint32_t group_size = ComputeDevice::kGroupSize;
  const vk::SpecializationMapEntry entry(0, 0, sizeof(group_size));
  const vk::SpecializationInfo constants(1, &entry, sizeof(group_size), &group_size);
  const vk::raii::ShaderModule shader =
      device.createShaderModule(vk::ShaderModuleCreateInfo({}, spirv.size_bytes(), spirv.data()));
  const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *shader, "main",
                                                &constants);

  vk::raii::DescriptorSetLayout set_layout = create_set_layout(device);
  vk::raii::PipelineLayout layout =
      device.createPipelineLayout(vk::PipelineLayoutCreateInfo({}, *set_layout));
  vk::raii::Pipeline pipeline =
      device.createComputePipeline(nullptr, vk::ComputePipelineCreateInfo({}, stage, *layout));
  return {std::move(set_layout), std::move(layout), std::move(pipeline)};
}

// The descriptor set of a pipeline's two buffers, with the pool that it lives in.
struct Bindings {
  vk::raii::DescriptorPool pool;
  vk::raii::DescriptorSet set;
};

Bindings bind(const vk::raii::Device& device, const Pipeline& pipeline, const SharedBuffer& in,
              const SharedBuffer& out) {
  const vk::DescriptorPoolSize two_buffers(vk::DescriptorType::eStorageBuffer, 2);
  vk::raii::DescriptorPool pool = device.createDescriptorPool(
      vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, two_buffers));
  vk::raii::DescriptorSets sets(device, vk::DescriptorSetAllocateInfo(*pool, *pipeline.set_layout));
  const vk::DescriptorBufferInfo in_info(*in.buffer, 0, VK_WHOLE_SIZE);
  const vk::DescriptorBufferInfo out_info(*out.buffer, 0, VK_WHOLE_SIZE);
  const auto storage = [&](std::uint32_t binding, const vk::DescriptorBufferInfo& info) {
    return vk::WriteDescriptorSet(*sets[0], binding, 0, vk::DescriptorType::eStorageBuffer, {}, info);
  };
  device.updateDescriptorSets({storage(kInputBinding, in_info), storage(kOutputBinding, out_info)}, {});
  return {std::move(pool), std::move(sets[0])};
}

// Records one dispatch, after which the processor may read what the shader wrote.
void record(const vk::raii::CommandBuffer& commands, const Pipeline& pipeline, const Bindings& bindings,
            std::uint32_t groups) {
  commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline.pipeline);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *pipeline.layout, 0, {*bindings.set}, {});
  commands.dispatch(groups, 1, 1);
  const vk::MemoryBarrier shader_to_host(vk::AccessFlagBits::eShaderWrite, vk::AccessFlagBits::eHostRead);
  commands.pipelineBarrier(vk::PipelineStageFlagBits::eComputeShader, vk::PipelineStageFlagBits::eHost, {},
                           shader_to_host, {}, {});
  commands.end();
}

std::size_t groups_for(std::size_t invocations) {
  return (invocations + ComputeDevice::kGroupSize - 1) / ComputeDevice::kGroupSize;
}

void require_within_limits(const vk::raii::PhysicalDevice& device, std::span<const float> in,
                           std::span<const float> out) {
  const vk::PhysicalDeviceLimits limits = device.getProperties().limits;
  const std::size_t bytes = std::max(in.size_bytes(), out.size_bytes());
  if (bytes > limits.maxStorageBufferRange) {
    throw std::runtime_error("A buffer of " + std::to_string(bytes) + " bytes is more than the " +
                             std::to_string(limits.maxStorageBufferRange) + " that the Vulkan device " +
                             name_of(device) + " takes: run it in parts.");
  }
  if (groups_for(out.size()) > limits.maxComputeWorkGroupCount[0]) {
    throw std::runtime_error("More invocations (" + std::to_string(out.size()) + ") than the Vulkan device " +
                             name_of(device) + " takes at once: run it in parts.");
  }
}

}  // namespace

struct ComputeDevice::State {
  vk::raii::Context context = open_loader();
  vk::raii::Instance instance = create_instance(context);
  std::vector<vk::raii::PhysicalDevice> devices = enumerate_devices(instance);
  vk::raii::PhysicalDevice physical = nullptr;
  std::string name;
  std::uint32_t queue_family = 0;
  vk::raii::Device device = nullptr;

  State() {
    if (devices.empty()) {
      throw std::runtime_error(
          "There is a Vulkan driver but no device. For a device on the processor, on Debian: apt-get install "
          "mesa-vulkan-drivers");
    }
  }

  void open(std::size_t index) {
    physical = device_at(devices, index);
    name = name_of(physical);
    queue_family = compute_queue_family(physical);
    device = create_device(physical, queue_family);
  }

  void submit(const Pipeline& pipeline, const Bindings& bindings, std::uint32_t groups) {
    const vk::raii::CommandPool pool = device.createCommandPool(
        vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eTransient, queue_family));
    const vk::raii::CommandBuffers commands(
        device, vk::CommandBufferAllocateInfo(*pool, vk::CommandBufferLevel::ePrimary, 1));
    record(commands[0], pipeline, bindings, groups);
    const vk::raii::Queue queue = device.getQueue(queue_family, 0);
    queue.submit(vk::SubmitInfo({}, {}, *commands[0]));
    queue.waitIdle();
  }

  void run(std::span<const std::uint32_t> spirv, std::span<const float> in, std::span<float> out) {
    require_within_limits(physical, in, out);
    const SharedBuffer in_buffer = create_shared_buffer(physical, device, in.size_bytes());
    const SharedBuffer out_buffer = create_shared_buffer(physical, device, out.size_bytes());
    write(in_buffer, in);
    const Pipeline pipeline = create_pipeline(device, spirv);
    const Bindings bindings = bind(device, pipeline, in_buffer, out_buffer);
    submit(pipeline, bindings, static_cast<std::uint32_t>(groups_for(out.size())));
    read(out_buffer, out);
  }
};

std::vector<std::string> compute_device_names() {
  const vk::raii::Context context = open_loader();
  const vk::raii::Instance instance = create_instance(context);
  return names_of(enumerate_devices(instance));
}

ComputeDevice::ComputeDevice(std::unique_ptr<State> state) : state_(std::move(state)) {}
ComputeDevice::ComputeDevice(ComputeDevice&&) noexcept = default;
ComputeDevice& ComputeDevice::operator=(ComputeDevice&&) noexcept = default;
ComputeDevice::~ComputeDevice() = default;

ComputeDevice ComputeDevice::first() {
  return by_index(0);
}

ComputeDevice ComputeDevice::by_index(std::size_t index) {
  auto state = std::make_unique<State>();
  state->open(index);
  return ComputeDevice(std::move(state));
}

ComputeDevice ComputeDevice::by_name(std::string_view text) {
  auto state = std::make_unique<State>();
  state->open(index_by_name(state->devices, text));
  return ComputeDevice(std::move(state));
}

const std::string& ComputeDevice::name() const {
  return state_->name;
}

void ComputeDevice::run(std::span<const std::uint32_t> spirv, std::span<const float> in,
                        std::span<float> out) {
  if (spirv.empty() || in.empty() || out.empty()) {
    throw std::invalid_argument(
        "ComputeDevice::run needs a shader, an input and an output that are not empty.");
  }
  try {
    state_->run(spirv, in, out);
  } catch (const vk::SystemError& error) {
    throw std::runtime_error("The Vulkan device " + name() + " failed (" + error.what() + ").");
  }
}

}  // namespace brdfit
