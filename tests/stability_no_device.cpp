// In place of stability_device.cpp where the build has no Vulkan.
#include <gtest/gtest.h>

namespace brdfit::stability {
namespace {

TEST(Stability, KernelsOnTheDevice) {
  GTEST_SKIP() << "built without Vulkan headers";
}

TEST(Stability, BranchesOnTheDevice) {
  GTEST_SKIP() << "built without Vulkan headers";
}

TEST(Stability, RealisOnTheDevice) {
  GTEST_SKIP() << "built without Vulkan headers";
}

}  // namespace
}  // namespace brdfit::stability
