// Evaluation in float: on the processor, and on a Vulkan device.
#include <algorithm>
#include <memory>

#include "cli/cost/cost_point.h"
#include "cli/cost/evaluators.h"
#include "cli/cost/paired_timing.h"
#include "gpu/float_material.h"
#include "gpu/material_pass.h"

namespace brdfit::cli {
namespace {

std::array<float, 3> rounded(const Vec3& w) {
  return {static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z)};
}

// Runs `eval` on the pairs in single precision; the conversions are not timed.
template <class Eval>
double eval_in_float(const DirectionPairs& pairs, std::span<Rgb> out, const Eval& eval) {
  std::vector<FloatPair> in(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) in[k] = {rounded(pairs.wi[k]), rounded(pairs.wo[k])};
  std::vector<FloatRgb> values(pairs.size());
  const double ns = eval(in, values);
  std::ranges::transform(values, out.begin(), [](const FloatRgb& v) { return Rgb{v[0], v[1], v[2]}; });
  return ns;
}

double eval_float(const Material& material, const DirectionPairs& pairs, std::span<Rgb> out) {
  return eval_in_float(pairs, out, [&](const auto& in, auto& values) {
    const double start = thread_cpu_seconds();
    eval_cos_float(material, in, values);
    return 1e9 * (thread_cpu_seconds() - start);
  });
}

// A device and the pass on it, which must not outlive it.
struct Vulkan {
  ComputeDevice device;
  MaterialPass pass;

  explicit Vulkan(const std::string& name) : device(ComputeDevice::open({name, nullptr})), pass(device) {}
  Vulkan(const Vulkan&) = delete;
  Vulkan& operator=(const Vulkan&) = delete;
};

}  // namespace

void add_gpu_evaluators(const std::string& device, Evaluators& evaluators) {
  evaluators.all.push_back({"float", "processor, pair by pair", eval_float});
  try {
    const auto vulkan = std::make_shared<Vulkan>(device);
    evaluators.all.push_back(
        {"float", "Vulkan: " + vulkan->device.name(),
         [vulkan](const Material& material, const DirectionPairs& pairs, std::span<Rgb> out) {
           return eval_in_float(pairs, out, [&](const auto& in, auto& values) {
             return vulkan->pass.eval_cos(material, in, values).value_or(kNotMeasured);
           });
         }});
  } catch (const GpuError& error) {
    if (!device.empty()) throw;
    std::string note = "no Vulkan device was timed: ";
    evaluators.notes.push_back(note += error.what());
  }
}

}  // namespace brdfit::cli
