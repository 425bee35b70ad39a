// Runs compute shaders on a Vulkan 1.1 device, without a window.
#ifndef BRDFIT_GPU_COMPUTE_H_
#define BRDFIT_GPU_COMPUTE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gpu/error.h"

namespace brdfit {

// The names of the devices of this machine, in the order of their indices; none is an empty list. Throws
// GpuError if there is no Vulkan loader or no driver.
std::vector<std::string> compute_device_names();

// Which device, and how closely it is watched.
struct DeviceRequest {
  // Empty: the first one. Digits: its index. Anything else: the first whose name contains it.
  std::string device;
  // Set: the validation layers are on, and each of their warnings and errors comes here, until the device is
  // destroyed. Null: they are off.
  std::function<void(const std::string& message)> on_validation_message;
};

// What a dispatch may be given at most.
struct ComputeLimits {
  std::size_t buffer_bytes = 0;
  std::size_t invocations = 0;
  std::size_t push_bytes = 0;
};

// A shader as the device runs it, with its specialisation constants set. Must not outlive its device.
class ComputePipeline {
 public:
  ComputePipeline(ComputePipeline&&) noexcept;
  ComputePipeline& operator=(ComputePipeline&&) noexcept;
  ~ComputePipeline();

 private:
  friend class ComputeDevice;
  struct State;
  explicit ComputePipeline(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// What a pipeline is made of. Set 0 has the storage buffers: the inputs at bindings 0, 1, ..., the output
// behind them.
struct PipelineRequest {
  std::span<const std::uint32_t> spirv;     // entry point `main`, SPIR-V 1.3
  std::span<const std::int32_t> constants;  // specialisation constants 1, 2, ...; 0 is the group size
  std::size_t input_count = 1;              // storage buffers to read
  std::size_t push_bytes = 0;               // size of the push constants, a multiple of 4
};

// One dispatch.
struct ComputeJob {
  std::span<const std::span<const std::byte>> inputs;  // as many as the pipeline has, none empty
  std::span<const std::byte> push;                     // of the pipeline's push_bytes
  std::size_t invocations = 0;  // the last workgroup may be larger than what is left: the shader checks
};

// A device that is ready to compute. Every function throws GpuError where the driver fails.
class ComputeDevice {
 public:
  // Invocations in a workgroup. A shader takes it as specialisation constant 0 (`local_size_x_id = 0`).
  static constexpr std::uint32_t kGroupSize = 64;

  // Throws GpuError, with a sentence that says what to do, where there is no Vulkan loader, no driver, no
  // such device, or where the device lacks Vulkan 1.1 or a compute queue.
  static ComputeDevice open(const DeviceRequest& request = {});

  ComputeDevice(ComputeDevice&&) noexcept;
  ComputeDevice& operator=(ComputeDevice&&) noexcept;
  ~ComputeDevice();

  // As the driver reports it.
  const std::string& name() const;

  // Whether the "device" is the processor itself (lavapipe).
  bool is_processor() const;

  const ComputeLimits& limits() const;

  // Compiles a shader. Throws std::invalid_argument for an empty shader.
  ComputePipeline compile(const PipelineRequest& request) const;

  // Runs a pipeline; `out` is what the shader wrote to the output buffer. Returns when the device is done,
  // with the nanoseconds that it took by its own clock (null where it has none). Throws std::invalid_argument
  // for empty spans, and for jobs beyond limits(); `out` is unchanged then.
  std::optional<double> run(const ComputePipeline& pipeline, const ComputeJob& job, std::span<std::byte> out);

 private:
  struct State;
  explicit ComputeDevice(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// Compiles and runs a shader once for each element of `out`: storage buffer 0 holds `in`, storage buffer 1
// becomes `out`. Throws as ComputeDevice does.
void run_shader(ComputeDevice& device, std::span<const std::uint32_t> spirv, std::span<const float> in,
                std::span<float> out);

}  // namespace brdfit

#endif  // BRDFIT_GPU_COMPUTE_H_
