// The material pass and the Realis pass, one after the other.
#include <cmath>

#include "cli/cost/cost_point.h"
#include "cli/cost/stack_device.h"
#include "gpu/material_pass.h"
#include "gpu/realis_pass.h"

namespace brdfit::cli {
namespace {

// The four bytes of a texel of each texture in one word, red lowest.
std::vector<std::uint32_t> words_of(const bake::HeldTexels& held) {
  const std::size_t planes = held.bytes.size() / held.count;
  std::vector<std::uint32_t> words((planes + 3) / 4 * held.count, 0);
  for (std::size_t plane = 0; plane < planes; ++plane) {
    for (std::size_t k = 0; k < held.count; ++k) {
      words[plane / 4 * held.count + k] |= static_cast<std::uint32_t>(held.bytes[plane * held.count + k])
                                           << (8 * (plane % 4));
    }
  }
  return words;
}

// Unit tangents of a unit normal (Duff et al. 2017), and directions in their frame.
std::array<float, 3> local(const Vec3& n, const Vec3& w) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1.0 / (sign + n.z);
  const double b = n.x * n.y * a;
  const auto along = [&w](double x, double y, double z) {
    return static_cast<float>(w.x * x + w.y * y + w.z * z);
  };
  return {along(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), along(b, sign + n.y * n.y * a, -n.y),
          along(n.x, n.y, n.z)};
}

std::vector<FloatPair> pairs_of(const RealisAsset& asset, const bake::Surface& surface,
                                const RealisLight& light) {
  const std::size_t count = surface.count();
  std::vector<FloatPair> pairs(count);
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 normal = {static_cast<double>(surface.normals[k]),
                         static_cast<double>(surface.normals[count + k]),
                         static_cast<double>(surface.normals[2 * count + k])};
    pairs[k] = {local(normal, light.direction), local(normal, asset.view)};
  }
  return pairs;
}

class VulkanStackDevice : public StackDevice {
 public:
  explicit VulkanStackDevice(const std::string& device)
      : device_(ComputeDevice::open({device, nullptr})), material_(device_), realis_(device_) {}

  std::string name() const override { return device_.name(); }

  double nanoseconds(const RealisAsset& asset, const bake::HeldTexels& texels,
                     const std::vector<RealisLight>& lights, std::vector<float>& correction) override {
    const std::vector<std::uint32_t> codes = words_of(texels);
    const bake::Surface& surface = texels.surface;
    const RealisTexels view = {texels.count,   codes,           texels.masks,   surface.normals,
                               surface.albedo, surface.normals, surface.albedo, texels.chroma};
    correction.resize(3 * texels.count);
    double ns = 0.0;
    for (const RealisLight& light : lights) {
      ns += realis_.correction(asset, view, light, correction).value_or(kNotMeasured);
      if (!asset.base) continue;
      std::vector<FloatRgb> render(texels.count);
      ns += material_.eval_cos(*asset.base, pairs_of(asset, surface, light), render).value_or(kNotMeasured);
    }
    return ns / static_cast<double>(texels.count * lights.size());
  }

 private:
  ComputeDevice device_;
  MaterialPass material_;
  RealisPass realis_;
};

}  // namespace

std::unique_ptr<StackDevice> open_stack_device(const std::string& device, std::string& why) {
  try {
    return std::make_unique<VulkanStackDevice>(device);
  } catch (const GpuError& error) {
    if (!device.empty()) throw;
    why = error.what();
    return nullptr;
  }
}

}  // namespace brdfit::cli
