// Runs compute shaders on a Vulkan 1.1 device, without a window.
#ifndef BRDFIT_GPU_COMPUTE_H_
#define BRDFIT_GPU_COMPUTE_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace brdfit {

// The names of the devices of this machine, in the order of their indices; none is an empty list. Throws
// std::runtime_error if there is no Vulkan loader or no driver.
std::vector<std::string> compute_device_names();

// A device that is ready to compute.
class ComputeDevice {
 public:
  // Invocations in a workgroup. A shader takes it as specialisation constant 0 (`local_size_x_id = 0`).
  static constexpr std::uint32_t kGroupSize = 64;

  // Each throws std::runtime_error, with a sentence that says what to do, where there is no Vulkan loader, no
  // driver, no such device, or where the device lacks Vulkan 1.1 or a compute queue.
  static ComputeDevice first();
  static ComputeDevice by_index(std::size_t index);
  // The first device whose name contains the text.
  static ComputeDevice by_name(std::string_view text);

  ComputeDevice(ComputeDevice&&) noexcept;
  ComputeDevice& operator=(ComputeDevice&&) noexcept;
  ~ComputeDevice();

  // As the driver reports it.
  const std::string& name() const;

  // Runs the entry point `main` of a SPIR-V 1.3 module once for each element of `out`: storage buffer 0 (set
  // 0) holds `in`, storage buffer 1 becomes `out`. The last workgroup may be larger than what is left of
  // `out`: the shader checks its index. Returns when the device is done. Throws std::invalid_argument if a
  // span is empty, std::runtime_error if the spans exceed the device's limits or the device fails; `out` is
  // unchanged then.
  void run(std::span<const std::uint32_t> spirv, std::span<const float> in, std::span<float> out);

 private:
  struct State;
  explicit ComputeDevice(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace brdfit

#endif  // BRDFIT_GPU_COMPUTE_H_
