// The hard cases on a Vulkan device: lavapipe, on the processor, where there is no GPU.
#include "tests/stability_device.h"

#include <gtest/gtest.h>

#include "gpu/material_pass.h"
#include "gpu/parity.h"
#include "gpu/realis_pass.h"
#include "tests/stability_data.h"
#include "tests/stability_realis.h"
#include "tests/stability_walk.h"

namespace brdfit::stability {

std::vector<std::string>& validation_messages() {
  static std::vector<std::string> messages;
  return messages;
}

ComputeDevice* device(std::string* why_not) {
  // Never closed: a driver that is unloaded leaves what it holds without an owner.
  static ComputeDevice* opened = nullptr;
  DeviceRequest request;
  request.on_validation_message = [](const std::string& text) { validation_messages().push_back(text); };
  for (const bool watched : {true, false}) {
    if (opened != nullptr) break;
    if (!watched) request.on_validation_message = nullptr;
    try {
      opened = new ComputeDevice(ComputeDevice::open(request));
    } catch (const GpuError& error) {
      if (error.kind() == GpuError::Kind::kNoValidation) continue;
      if (error.kind() != GpuError::Kind::kNoDriver) throw;
      *why_not = error.what();
      break;
    }
  }
  return opened;
}

namespace {

using testing_support::Pair;

FloatPair in_float(const Pair& pair) {
  const auto of = [](const Vec3& w) {
    return std::array{static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z)};
  };
  return {of(pair.wi), of(pair.wo)};
}

Walker device_walker(MaterialPass& pass, const std::string& name) {
  Walker walker;
  walker.name = name;
  walker.is_single = true;
  walker.evaluate = [&pass](const Material& material, std::span<const Pair> pairs, std::span<Rgb> out) {
    std::vector<FloatPair> in;
    for (const Pair& pair : pairs) in.push_back(in_float(pair));
    std::vector<FloatRgb> found(pairs.size());
    pass.eval_cos(material, in, found);
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = {found[k][0], found[k][1], found[k][2]};
  };
  walker.allowed = [](const Material& material, double reference, double) {
    return parity_threshold(material).allowed(std::abs(reference));
  };
  return walker;
}

void walk_on_device(void (*walk)(const Walker&)) {
  std::string why_not;
  ComputeDevice* const on = device(&why_not);
  if (on == nullptr) GTEST_SKIP() << why_not;
  MaterialPass pass(*on);
  walk(device_walker(pass, on->name()));
  for (const std::string& message : validation_messages()) ADD_FAILURE() << "validation: " << message;
}

TEST(Stability, KernelsOnTheDevice) {
  walk_on_device(walk_kernel_cases);
}

TEST(Stability, BranchesOnTheDevice) {
  walk_on_device(walk_branches);
}

// Codes of cancelling_texels(): one texture, k and -k steps from the code of 0.
std::vector<std::uint32_t> cancelling_codes(std::size_t count) {
  std::vector<std::uint32_t> codes;
  for (std::uint32_t k = 0; k < count; ++k) codes.push_back((128U + k) | (128U - k) << 8U);
  return codes;
}

// The asset's texels under lights everywhere, and next to its first axis, where sharp lobes are.
void expect_realis_parity(RealisPass& pass, const RealisAsset& asset) {
  const bake::RunTimeTexels texels = cancelling_texels(asset);
  const std::vector<std::uint32_t> codes = cancelling_codes(asset.texel_count());
  const RealisTexels view = {
      asset.texel_count(), codes, {}, texels.surface.normals, texels.surface.albedo, texels.baked.normals,
      texels.baked.albedo, {}};
  for (const double angle : {0.0, 1e-4, 1e-3, 2e-3, 0.3, 1.2, 1.5}) {
    for (const double phi : {0.0, 2.0, 4.0}) {
      // Of floats, as the device has them.
      const Vec3 exact = testing_support::direction(angle, phi);
      const FloatPair single = in_float({exact, exact});
      const RealisLight light = {{single.wi[0], single.wi[1], single.wi[2]}, {1.0, 1.0, 1.0}};
      const std::vector<double> expected = bake::correction(asset, texels, light);
      std::vector<float> found(expected.size());
      pass.correction(asset, view, light, found);
      for (std::size_t k = 0; k < expected.size(); ++k) {
        // Relative to the amplitudes, of which the sum is a small part.
        const double largest = std::abs(texels.amplitudes[k % asset.texel_count()]);
        ASSERT_NEAR(found[k], expected[k], 4e-6 * (1.0 + largest)) << "angle " << angle;
      }
    }
  }
}

TEST(Stability, RealisOnTheDevice) {
  std::string why_not;
  ComputeDevice* const on = device(&why_not);
  if (on == nullptr) GTEST_SKIP() << why_not;
  RealisPass pass(*on);
  RealisAsset asset = cancelling_asset();
  expect_realis_parity(pass, asset);  // amplitudes cancel
  asset.lobes[1] = asset.lobes[0];
  expect_realis_parity(pass, asset);  // lobes coincide
  for (const double sharpness : {0.0, 1e6}) {
    for (Lobe& lobe : asset.lobes) lobe.sharpness = sharpness;
    asset.lobes[1].sharpness *= 0.5;
    expect_realis_parity(pass, asset);
  }
  print_walked(on->name(), realis_cases().size(), "Realis", 4 * 21 * 3 * asset.texel_count());
}

}  // namespace
}  // namespace brdfit::stability
