// Buffers, pipelines and dispatches of a ComputeDevice.
#include "gpu/compute.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "gpu/vulkan_buffer.h"
#include "gpu/vulkan_device.h"

namespace brdfit {

using gpu::SharedBuffer;

struct ComputePipeline::State {
  vk::raii::DescriptorSetLayout set_layout;
  vk::raii::PipelineLayout layout;
  vk::raii::Pipeline pipeline;
  std::size_t input_count;
  std::size_t push_bytes;
};

ComputePipeline::ComputePipeline(std::unique_ptr<State> state) : state_(std::move(state)) {}
ComputePipeline::ComputePipeline(ComputePipeline&&) noexcept = default;
ComputePipeline& ComputePipeline::operator=(ComputePipeline&&) noexcept = default;
ComputePipeline::~ComputePipeline() = default;

namespace {

vk::raii::DescriptorSetLayout create_set_layout(const vk::raii::Device& device, std::size_t buffers) {
  std::vector<vk::DescriptorSetLayoutBinding> bindings;
  for (std::uint32_t k = 0; k < buffers; ++k) {
    bindings.emplace_back(k, vk::DescriptorType::eStorageBuffer, 1, vk::ShaderStageFlagBits::eCompute);
  }
  return device.createDescriptorSetLayout(vk::DescriptorSetLayoutCreateInfo({}, bindings));
}

vk::raii::PipelineLayout create_layout(const vk::raii::Device& device,
                                       const vk::raii::DescriptorSetLayout& set_layout,
                                       std::size_t push_bytes) {
  const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0,
                                   static_cast<std::uint32_t>(push_bytes));
  vk::PipelineLayoutCreateInfo info({}, *set_layout);
  if (push_bytes > 0) info.setPushConstantRanges(push);
  return device.createPipelineLayout(info);
}

vk::raii::Pipeline create_pipeline(const vk::raii::Device& device, const PipelineRequest& request,
                                   const vk::raii::PipelineLayout& layout) {
  std::vector<std::int32_t> values = {static_cast<std::int32_t>(ComputeDevice::kGroupSize)};
  values.insert(values.end(), request.constants.begin(), request.constants.end());
  std::vector<vk::SpecializationMapEntry> entries;
  for (std::uint32_t k = 0; k < values.size(); ++k) entries.emplace_back(k, 4 * k, 4);
  const vk::SpecializationInfo constants(static_cast<std::uint32_t>(entries.size()), entries.data(),
                                         4 * values.size(), values.data());
  const vk::raii::ShaderModule shader = device.createShaderModule(
      vk::ShaderModuleCreateInfo({}, request.spirv.size_bytes(), request.spirv.data()));
  const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *shader, "main",
                                                &constants);
  return device.createComputePipeline(nullptr, vk::ComputePipelineCreateInfo({}, stage, *layout));
}

// A descriptor set, with the pool that it lives in.
struct Bindings {
  vk::raii::DescriptorPool pool;
  vk::raii::DescriptorSet set;
};

// A buffer and how much of it a job uses: shaders that ask for the length of a buffer see that.
struct Used {
  const SharedBuffer& buffer;
  std::size_t bytes;
};

Bindings bind_buffers(const vk::raii::Device& device, const vk::raii::DescriptorSetLayout& layout,
                      std::span<const Used> buffers) {
  const auto count = static_cast<std::uint32_t>(buffers.size());
  const vk::DescriptorPoolSize size(vk::DescriptorType::eStorageBuffer, count);
  vk::raii::DescriptorPool pool = device.createDescriptorPool(
      vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, size));
  vk::raii::DescriptorSets sets(device, vk::DescriptorSetAllocateInfo(*pool, *layout));
  for (std::uint32_t k = 0; k < count; ++k) {
    const vk::DescriptorBufferInfo info(buffers[k].buffer.handle(), 0, buffers[k].bytes);
    device.updateDescriptorSets(
        vk::WriteDescriptorSet(*sets[0], k, 0, vk::DescriptorType::eStorageBuffer, {}, info), {});
  }
  return {std::move(pool), std::move(sets[0])};
}

std::size_t groups_for(std::size_t invocations) {
  return (invocations + ComputeDevice::kGroupSize - 1) / ComputeDevice::kGroupSize;
}

ComputeLimits limits_of(const vk::raii::PhysicalDevice& device) {
  const vk::PhysicalDeviceLimits limits = device.getProperties().limits;
  return {limits.maxStorageBufferRange,
          std::size_t{limits.maxComputeWorkGroupCount[0]} * ComputeDevice::kGroupSize,
          limits.maxPushConstantsSize};
}

// The device's clock: two readings around a dispatch.
class Clock {
 public:
  Clock(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device, std::uint32_t queue_family)
      : bits_(physical.getQueueFamilyProperties()[queue_family].timestampValidBits),
        ns_per_tick_(static_cast<double>(physical.getProperties().limits.timestampPeriod)),
        pool_(nullptr) {
    if (bits_ == 0) return;
    pool_ = device.createQueryPool(vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, 2));
  }

  void reset(const vk::raii::CommandBuffer& commands) const {
    if (bits_ > 0) commands.resetQueryPool(*pool_, 0, 2);
  }
  void read(const vk::raii::CommandBuffer& commands, vk::PipelineStageFlagBits stage,
            std::uint32_t query) const {
    if (bits_ > 0) commands.writeTimestamp(stage, *pool_, query);
  }

  std::optional<double> elapsed_ns() const {
    if (bits_ == 0) return std::nullopt;
    const auto [result, ticks] =
        pool_.getResults<std::uint64_t>(0, 2, 2 * sizeof(std::uint64_t), sizeof(std::uint64_t),
                                        vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
    if (result != vk::Result::eSuccess) return std::nullopt;
    const std::uint64_t mask = bits_ >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits_) - 1;
    return static_cast<double>((ticks[1] - ticks[0]) & mask) * ns_per_tick_;
  }

 private:
  std::uint32_t bits_;
  double ns_per_tick_;
  vk::raii::QueryPool pool_;
};

}  // namespace

struct ComputeDevice::State {
  gpu::VulkanInstance instance;
  vk::raii::PhysicalDevice physical;
  std::string name;
  ComputeLimits limits;
  std::uint32_t queue_family;
  vk::raii::Device device;
  vk::raii::Queue queue;
  vk::raii::CommandPool commands;
  Clock clock;
  // Kept from run to run; they grow.
  std::vector<SharedBuffer> inputs;
  SharedBuffer output;

  explicit State(const DeviceRequest& request)
      : instance(request.on_validation_message),
        physical(gpu::choose_device(instance.devices(), request.device)),
        name(gpu::name_of(physical)),
        limits(limits_of(physical)),
        queue_family(gpu::compute_queue_family(physical)),
        device(gpu::open_device(physical, queue_family)),
        queue(device.getQueue(queue_family, 0)),
        commands(device.createCommandPool(
            vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eTransient, queue_family))),
        clock(physical, device, queue_family) {}

  void upload(const ComputeJob& job) {
    inputs.resize(std::max(inputs.size(), job.inputs.size()));
    for (std::size_t k = 0; k < job.inputs.size(); ++k) {
      inputs[k].reserve(physical, device, job.inputs[k].size_bytes());
      std::ranges::copy(job.inputs[k], inputs[k].bytes().begin());
    }
  }

  // Records one dispatch, after which the processor may read what the shader wrote.
  void record(const vk::raii::CommandBuffer& to, const ComputePipeline::State& pipeline,
              const Bindings& bindings, const ComputeJob& job) const {
    to.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
    clock.reset(to);
    to.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline.pipeline);
    to.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *pipeline.layout, 0, {*bindings.set}, {});
    if (!job.push.empty()) {
      to.pushConstants<std::byte>(*pipeline.layout, vk::ShaderStageFlagBits::eCompute, 0, job.push);
    }
    clock.read(to, vk::PipelineStageFlagBits::eTopOfPipe, 0);
    to.dispatch(static_cast<std::uint32_t>(groups_for(job.invocations)), 1, 1);
    clock.read(to, vk::PipelineStageFlagBits::eBottomOfPipe, 1);
    const vk::MemoryBarrier shader_to_host(vk::AccessFlagBits::eShaderWrite, vk::AccessFlagBits::eHostRead);
    to.pipelineBarrier(vk::PipelineStageFlagBits::eComputeShader, vk::PipelineStageFlagBits::eHost, {},
                       shader_to_host, {}, {});
    to.end();
  }

  std::optional<double> run(const ComputePipeline::State& pipeline, const ComputeJob& job,
                            std::span<std::byte> out) {
    upload(job);
    output.reserve(physical, device, out.size_bytes());
    std::vector<Used> buffers;
    for (std::size_t k = 0; k < job.inputs.size(); ++k) {
      buffers.push_back({inputs[k], job.inputs[k].size_bytes()});
    }
    buffers.push_back({output, out.size_bytes()});
    const Bindings bindings = bind_buffers(device, pipeline.set_layout, buffers);
    const vk::raii::CommandBuffers recorded(
        device, vk::CommandBufferAllocateInfo(*commands, vk::CommandBufferLevel::ePrimary, 1));
    record(recorded[0], pipeline, bindings, job);
    queue.submit(vk::SubmitInfo({}, {}, *recorded[0]));
    queue.waitIdle();
    std::ranges::copy(output.bytes().first(out.size()), out.begin());
    return clock.elapsed_ns();
  }

  void check(const ComputePipeline::State& pipeline, const ComputeJob& job,
             std::span<const std::byte> out) const {
    bool sound = job.inputs.size() == pipeline.input_count && job.push.size() == pipeline.push_bytes &&
                 !out.empty() && out.size() <= limits.buffer_bytes && job.invocations > 0 &&
                 job.invocations <= limits.invocations;
    for (const std::span<const std::byte> input : job.inputs) {
      sound = sound && !input.empty() && input.size() <= limits.buffer_bytes;
    }
    if (!sound) {
      throw std::invalid_argument(
          "ComputeDevice::run: a span is empty, does not fit the pipeline, or is beyond the device's limits");
    }
  }
};

std::vector<std::string> compute_device_names() {
  const gpu::VulkanInstance instance(nullptr);
  std::vector<std::string> names;
  for (const vk::raii::PhysicalDevice& device : instance.devices()) names.push_back(gpu::name_of(device));
  return names;
}

ComputeDevice::ComputeDevice(std::unique_ptr<State> state) : state_(std::move(state)) {}
ComputeDevice::ComputeDevice(ComputeDevice&&) noexcept = default;
ComputeDevice& ComputeDevice::operator=(ComputeDevice&&) noexcept = default;
ComputeDevice::~ComputeDevice() = default;

ComputeDevice ComputeDevice::open(const DeviceRequest& request) {
  return ComputeDevice(std::make_unique<State>(request));
}

const std::string& ComputeDevice::name() const {
  return state_->name;
}

bool ComputeDevice::is_processor() const {
  return state_->physical.getProperties().deviceType == vk::PhysicalDeviceType::eCpu;
}

const ComputeLimits& ComputeDevice::limits() const {
  return state_->limits;
}

ComputePipeline ComputeDevice::compile(const PipelineRequest& request) const {
  if (request.spirv.empty()) throw std::invalid_argument("ComputeDevice::compile: the shader is empty");
  try {
    const vk::raii::Device& device = state_->device;
    vk::raii::DescriptorSetLayout set_layout = create_set_layout(device, request.input_count + 1);
    vk::raii::PipelineLayout layout = create_layout(device, set_layout, request.push_bytes);
    vk::raii::Pipeline pipeline = create_pipeline(device, request, layout);
    return ComputePipeline(std::make_unique<ComputePipeline::State>(
        ComputePipeline::State{std::move(set_layout), std::move(layout), std::move(pipeline),
                               request.input_count, request.push_bytes}));
  } catch (const vk::SystemError& error) {
    throw gpu::gpu_error_of(error, name());
  }
}

std::optional<double> ComputeDevice::run(const ComputePipeline& pipeline, const ComputeJob& job,
                                         std::span<std::byte> out) {
  state_->check(*pipeline.state_, job, out);
  try {
    return state_->run(*pipeline.state_, job, out);
  } catch (const vk::SystemError& error) {
    throw gpu::gpu_error_of(error, name());
  }
}

void run_shader(ComputeDevice& device, std::span<const std::uint32_t> spirv, std::span<const float> in,
                std::span<float> out) {
  const ComputePipeline pipeline = device.compile({spirv, {}, 1, 0});
  const std::array input = {std::as_bytes(in)};
  device.run(pipeline, {input, {}, out.size()}, std::as_writable_bytes(out));
}

}  // namespace brdfit
