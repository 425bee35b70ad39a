// Devices: how they are chosen, and what is said where they fail.
#include <gmock/gmock.h>

#include <cstdlib>
#include <numeric>
#include <optional>

#include "gpu/batches.h"
#include "gpu/vulkan_device.h"
#include "tests/gpu_device.h"

namespace brdfit {
namespace {

using testing::HasSubstr;
using Kind = GpuError::Kind;

// The error that f throws.
template <class F>
GpuError error_of(const F& f) {
  try {
    f();
  } catch (const GpuError& error) {
    return error;
  }
  ADD_FAILURE() << "no GpuError was thrown";
  return {Kind::kFailed, ""};
}

TEST(GpuDevices, AreFoundByIndexAndByPartOfTheirName) {
  const std::vector<std::string> names = compute_device_names();
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(ComputeDevice::open({"", nullptr}).name(), names[0]);
  EXPECT_EQ(ComputeDevice::open({"0", nullptr}).name(), names[0]);
  EXPECT_EQ(ComputeDevice::open({names[0].substr(1), nullptr}).name(), names[0]);
}

TEST(GpuDevices, AMissingDeviceIsAnErrorThatListsThoseThereAre) {
  const std::vector<std::string> names = compute_device_names();
  ASSERT_FALSE(names.empty());
  for (const char* missing : {"1000", "99999999999999999999", "no such device"}) {
    const GpuError error = error_of([&] { ComputeDevice::open({missing, nullptr}); });
    EXPECT_EQ(error.kind(), Kind::kNoSuchDevice);
    EXPECT_THAT(error.what(), HasSubstr(names[0]));
  }
}

TEST(GpuDevices, AreOpenedAndClosedWithoutAMessageFromValidation) {
  for (int k = 0; k < 3; ++k) {
    ComputeDevice device = ComputeDevice::open(tests::watched_request("0"));
    const ComputeDevice moved = std::move(device);
    EXPECT_FALSE(moved.name().empty());
  }
  EXPECT_THAT(tests::validation_messages(), testing::IsEmpty());
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
  const GpuError error = error_of([] { ComputeDevice::open(); });
  EXPECT_EQ(error.kind(), Kind::kNoDriver);
  EXPECT_THAT(error.what(), HasSubstr("mesa-vulkan-drivers"));
}

TEST(GpuErrors, OfADriverSayWhatHappenedAndWhatToDo) {
  const GpuError lost = gpu::gpu_error_of(vk::DeviceLostError("x"), "Card 9");
  EXPECT_EQ(lost.kind(), Kind::kDeviceLost);
  EXPECT_THAT(lost.what(), testing::AllOf(HasSubstr("Card 9"), HasSubstr("was lost")));
  for (const GpuError& memory : {gpu::gpu_error_of(vk::OutOfDeviceMemoryError("x"), "Card 9"),
                                 gpu::gpu_error_of(vk::OutOfHostMemoryError("x"), "Card 9")}) {
    EXPECT_EQ(memory.kind(), Kind::kOutOfMemory);
    EXPECT_THAT(memory.what(), testing::AllOf(HasSubstr("Card 9"), HasSubstr("memory")));
  }
  EXPECT_EQ(gpu::gpu_error_of(vk::FeatureNotPresentError("x"), "Card 9").kind(), Kind::kFailed);
}

TEST(GpuRun, RefusesEmptySpansAndJobsBeyondTheLimits) {
  const std::vector<std::uint32_t> no_shader;
  EXPECT_THROW(tests::test_device().compile({no_shader, {}, 1, 0}), std::invalid_argument);
  const ComputeLimits& limits = tests::test_device().limits();
  EXPECT_GE(limits.buffer_bytes, std::size_t{1} << 27);  // what Vulkan 1.1 promises
  EXPECT_GE(limits.push_bytes, 128U);
}

// The parts of a run, where batches above `room` find no memory.
std::vector<std::size_t> parts_with_room_for(std::size_t room, std::size_t total, std::size_t largest) {
  std::vector<std::size_t> parts;
  run_in_batches(total, largest, [&](std::size_t first, std::size_t count) {
    EXPECT_EQ(first, std::accumulate(parts.begin(), parts.end(), std::size_t{0}));
    if (count > room) throw GpuError(Kind::kOutOfMemory, "full");
    parts.push_back(count);
  });
  return parts;
}

TEST(Batches, CoverEverythingInPartsThatAreNotTooLarge) {
  EXPECT_THAT(parts_with_room_for(100, 250, 100), testing::ElementsAre(100, 100, 50));
  EXPECT_THAT(parts_with_room_for(100, 100, 100), testing::ElementsAre(100));
  EXPECT_THAT(parts_with_room_for(100, 0, 100), testing::IsEmpty());
}

TEST(Batches, AreHalvedWhereMemoryRunsOut) {
  EXPECT_THAT(parts_with_room_for(30000, 100000, 100000), testing::ElementsAre(25000, 25000, 25000, 25000));
}

TEST(Batches, EndWhereNotEvenTheSmallestFits) {
  EXPECT_EQ(error_of([] { parts_with_room_for(10, 100000, 100000); }).kind(), Kind::kOutOfMemory);
  const auto lose = [](std::size_t, std::size_t) { throw GpuError(Kind::kDeviceLost, "gone"); };
  EXPECT_EQ(error_of([&] { run_in_batches(100000, 100000, lose); }).kind(), Kind::kDeviceLost);
}

}  // namespace
}  // namespace brdfit
