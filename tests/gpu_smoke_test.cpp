// The kernel source as GLSL on a Vulkan device against the same source as C++ in double.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "brdf/kernel/callisto.h"
#include "gpu/callisto_pairs.h"
#include "gpu/compute.h"

// LeakSanitizer's hook: what Mesa's processor driver allocates for itself and never frees is not ours.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libvulkan_lvp.so\n";
}

namespace brdfit {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

// The device that the tests compute on. It is never closed, which keeps the driver loaded to the end:
// LeakSanitizer cannot tell whose memory it looks at once the driver is gone.
ComputeDevice* the_device = nullptr;

class OpenTheDevice : public testing::Environment {
 public:
  void SetUp() override {
    if (the_device == nullptr) the_device = new ComputeDevice(ComputeDevice::first());
  }
};

[[maybe_unused]] const testing::Environment* const kOpenTheDevice =
    testing::AddGlobalTestEnvironment(new OpenTheDevice);

constexpr int kAllEffects = BRDF_EFFECT_SPECULAR_FRESNEL_FALLOFF | BRDF_EFFECT_DIFFUSE_FRESNEL |
                            BRDF_EFFECT_RETROREFLECTION | BRDF_EFFECT_SMOOTH_TERMINATOR |
                            BRDF_EFFECT_DUAL_SPECULAR;

// f cos_i in double, of exactly the numbers that the device is given.
double reference(const CallistoPair& p) {
  const auto g = kernel::geometry_from_directions<double>(p.wi_x, p.wi_y, p.wi_z, p.wo_x, p.wo_y, p.wo_z);
  const auto shape = kernel::callisto_shape<double>(
      p.roughness, p.dual_specular_roughness_scale, p.dual_specular_opacity, p.diffuse_fresnel_falloff,
      p.diffuse_fresnel_tangent_falloff, p.retroreflection_falloff, p.retroreflection_tangent_falloff,
      p.specular_fresnel_falloff, p.smooth_terminator_length);
  const auto colour = kernel::callisto_colour<double>(p.base_color, p.metallic, p.specular, p.diffuse_fresnel,
                                                      p.retroreflection, p.smooth_terminator);
  const auto terms = kernel::callisto_terms(shape, g, kernel::geometry_logs(g), BRDF_MASKING_SEPARABLE,
                                            BRDF_DIFFUSE_LAMBERT, kAllEffects);
  return kernel::above_horizon(kernel::callisto_combine(colour, terms), g.cos_i, g.cos_o);
}

// Single precision: its rounding, and that of h seen through a lobe of width alpha.
double allowed_error(double f_cos, const CallistoPair& p) {
  const double alpha = static_cast<double>(p.roughness) * p.roughness;
  return f_cos > 1e-4 ? f_cos * (1e-5 + 4e-7 / alpha) : 1e-6;
}

CallistoPair towards(CallistoPair material, double theta_i_deg, double phi_i_deg, double theta_o_deg,
                     double phi_o_deg) {
  const auto direction = [](double theta_deg, double phi_deg, float& x, float& y, float& z) {
    const double theta = theta_deg * std::numbers::pi / 180.0;
    const double phi = phi_deg * std::numbers::pi / 180.0;
    x = static_cast<float>(std::sin(theta) * std::cos(phi));
    y = static_cast<float>(std::sin(theta) * std::sin(phi));
    z = static_cast<float>(std::cos(theta));
  };
  direction(theta_i_deg, phi_i_deg, material.wi_x, material.wi_y, material.wi_z);
  direction(theta_o_deg, phi_o_deg, material.wo_x, material.wo_y, material.wo_z);
  return material;
}

CallistoPair plastic() {
  CallistoPair p;
  p.roughness = 0.3F;
  p.dual_specular_roughness_scale = 2.5F;
  p.dual_specular_opacity = 0.4F;
  p.specular_fresnel_falloff = 0.35F;
  p.base_color = 0.05F;
  p.diffuse_fresnel = 6.0F;
  p.smooth_terminator = 0.4F;
  return p;
}

CallistoPair cloth() {
  CallistoPair p;
  p.roughness = 0.8F;
  p.dual_specular_opacity = 0.2F;
  p.base_color = 0.6F;
  p.specular = 0.2F;
  p.diffuse_fresnel = 20.0F;
  p.diffuse_fresnel_falloff = 0.4F;
  p.diffuse_fresnel_tangent_falloff = 0.6F;
  p.retroreflection = 9.0F;
  p.retroreflection_falloff = 0.9F;
  p.retroreflection_tangent_falloff = 0.3F;
  p.smooth_terminator = -0.7F;
  p.smooth_terminator_length = 1.0F;
  return p;
}

CallistoPair polished_metal() {
  CallistoPair p;
  p.roughness = 0.1F;
  p.dual_specular_roughness_scale = 8.0F;
  p.dual_specular_opacity = 0.1F;
  p.base_color = 0.9F;
  p.metallic = 1.0F;
  p.specular_fresnel_falloff = 0.8F;
  return p;
}

// Falloffs of 1 have exponent 0, where 0^0 must be 1.
CallistoPair every_parameter_at_its_end() {
  CallistoPair p;
  p.roughness = 0.01F;
  p.dual_specular_roughness_scale = 16.0F;
  p.dual_specular_opacity = 1.0F;
  p.diffuse_fresnel_falloff = 1.0F;
  p.diffuse_fresnel_tangent_falloff = 1.0F;
  p.retroreflection_falloff = 1.0F;
  p.retroreflection_tangent_falloff = 1.0F;
  p.specular_fresnel_falloff = 1.0F;
  p.smooth_terminator_length = 0.0F;
  p.base_color = 1.0F;
  p.specular = 1.0F;
  p.diffuse_fresnel = 256.0F;
  p.retroreflection = 256.0F;
  p.smooth_terminator = 1.0F;
  return p;
}

CallistoPair sharpest() {
  CallistoPair p;
  p.roughness = 0.01F;
  return p;
}

std::vector<CallistoPair> materials() {
  return {CallistoPair(), plastic(), cloth(), polished_metal(), every_parameter_at_its_end(), sharpest()};
}

std::vector<CallistoPair> pairs_above_horizon() {
  std::vector<CallistoPair> pairs;
  for (const CallistoPair& material : materials()) {
    pairs.push_back(towards(material, 0, 0, 0, 0));           // both along the normal
    pairs.push_back(towards(material, 35, 20, 35, 20));       // retroreflection
    pairs.push_back(towards(material, 80, 110, 80, 110));     // grazing retroreflection
    pairs.push_back(towards(material, 40, 10, 40, 190));      // mirror
    pairs.push_back(towards(material, 40, 10, 40.5, 190.7));  // near mirror
    pairs.push_back(towards(material, 60, 250, 57, 72));      // flank of the peak
    pairs.push_back(towards(material, 89.5, 45, 89, 225));    // grazing mirror
    pairs.push_back(towards(material, 89.9, 0, 10, 130));     // light on the horizon
    pairs.push_back(towards(material, 15, 300, 88, 60));      // view on the horizon
    pairs.push_back(towards(material, 85, 90, 50, 75));       // terminator
    pairs.push_back(towards(material, 30, 200, 65, 310));     // anywhere
  }
  return pairs;
}

TEST(GpuSmoke, DeviceAgreesWithDoubleOnTheProcessor) {
  std::cout << "Vulkan device: " << the_device->name() << "\n";
  const std::vector<CallistoPair> pairs = pairs_above_horizon();
  const std::vector<float> results = callisto_pairs(*the_device, pairs);

  ASSERT_EQ(results.size(), pairs.size());
  double worst = 0.0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double expected = reference(pairs[k]);
    ASSERT_GT(expected, 0.0) << "pair " << k;
    const double allowed = allowed_error(expected, pairs[k]);
    EXPECT_NEAR(results[k], expected, allowed) << "pair " << k;
    worst = std::max(worst, std::abs(results[k] - expected) / allowed);
  }
  std::cout << pairs.size() << " values, the largest error is " << worst << " of what is allowed\n";
}

TEST(GpuSmoke, BelowTheHorizonIsZero) {
  std::vector<CallistoPair> pairs;
  for (const CallistoPair& material : materials()) {
    pairs.push_back(towards(material, 95, 0, 30, 180));
    pairs.push_back(towards(material, 30, 0, 95, 180));
    pairs.push_back(towards(material, 120, 0, 150, 60));
    pairs.push_back(towards(material, 30, 0, 150, 180));  // wi + wo = 0
  }
  EXPECT_THAT(callisto_pairs(*the_device, pairs), testing::Each(0.0F));
}

TEST(GpuSmoke, EveryPairOfManyWorkgroupsGetsItsOwnResult) {
  std::vector<CallistoPair> pairs(3 * ComputeDevice::kGroupSize + 7);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    pairs[k].base_color = static_cast<float>(k) / static_cast<float>(pairs.size());
  }
  const std::vector<float> results = callisto_pairs(*the_device, pairs);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double expected = reference(pairs[k]);
    EXPECT_NEAR(results[k], expected, allowed_error(expected, pairs[k])) << "pair " << k;
  }
  EXPECT_THAT(callisto_pairs(*the_device, {}), testing::IsEmpty());
}

TEST(GpuDevices, AreFoundByIndexAndByPartOfTheirName) {
  const std::vector<std::string> names = compute_device_names();
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(ComputeDevice::by_index(0).name(), names[0]);
  EXPECT_EQ(ComputeDevice::by_name(names[0].substr(1)).name(), names[0]);
}

TEST(GpuDevices, AMissingDeviceIsAnErrorThatListsThoseThereAre) {
  const std::vector<std::string> names = compute_device_names();
  ASSERT_FALSE(names.empty());
  EXPECT_THAT([] { ComputeDevice::by_index(1000); }, ThrowsMessage<std::runtime_error>(HasSubstr(names[0])));
  EXPECT_THAT([] { ComputeDevice::by_name("no such device"); },
              ThrowsMessage<std::runtime_error>(HasSubstr(names[0])));
}

// Hides the machine's drivers from the loader as long as it lives.
class WithoutDrivers {
 public:
  WithoutDrivers() {
    if (const char* value = std::getenv(kVariable)) old_ = value;
    setenv(kVariable, "/nonexistent/driver.json", 1);
  }
  WithoutDrivers(const WithoutDrivers&) = delete;
  WithoutDrivers& operator=(const WithoutDrivers&) = delete;
  ~WithoutDrivers() {
    if (old_) {
      setenv(kVariable, old_->c_str(), 1);
    } else {
      unsetenv(kVariable);
    }
  }

 private:
  static constexpr const char* kVariable = "VK_DRIVER_FILES";
  std::optional<std::string> old_;
};

TEST(GpuDevices, WithoutADriverTheErrorSaysWhatToInstall) {
  const WithoutDrivers hidden;
  EXPECT_THAT([] { ComputeDevice::first(); },
              ThrowsMessage<std::runtime_error>(HasSubstr("mesa-vulkan-drivers")));
}

TEST(GpuDevices, AnEmptyBufferIsRefused) {
  const std::vector<std::uint32_t> spirv = {0x07230203};
  const std::vector<float> in;
  std::vector<float> out(1);
  EXPECT_THROW(the_device->run(spirv, in, out), std::invalid_argument);
}

}  // namespace
}  // namespace brdfit
