// Times of phases that go on beside each other: each gets its own, and none is counted twice.
#include "cli/bake_timings.h"

#include <gtest/gtest.h>

#include <ctime>
#include <map>
#include <thread>

namespace brdfit::cli {
namespace {

constexpr double kWork = 0.02;  // seconds of CPU

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void work() {
  const double begin = thread_seconds();
  while (thread_seconds() - begin < kWork) {
  }
}

std::map<std::string, TimeTaken> times_of(const BakeTimings& timings) {
  const auto phases = timings.phases();
  return {phases.begin(), phases.end()};
}

TEST(BakeTimings, WorkBesideAPhaseIsNotOfIt) {
  BakeTimings timings;
  CpuMeter& writing = timings.beside("write");
  const BothClocks all;
  timings.timed("read", [&] {
    std::thread other([&] { writing.measure(work); });
    other.join();
  });
  const double whole = all.taken().cpu_seconds;
  const auto times = times_of(timings);
  EXPECT_GE(times.at("write").cpu_seconds, kWork);
  EXPECT_LT(times.at("read").cpu_seconds, 0.5 * kWork);
  EXPECT_LE(times.at("read").cpu_seconds + times.at("write").cpu_seconds, whole + 1e-6);
  EXPECT_EQ(times.at("write").wall_seconds, 0.0);
}

TEST(BakeTimings, WhatAPhaseTakesBesideOthersAndByItselfIsAdded) {
  BakeTimings timings;
  CpuMeter& writing = timings.beside("write");
  timings.timed("read", [&] { writing.measure(work); });
  timings.timed("write", work);
  timings.timed("write", work);
  const auto times = times_of(timings);
  ASSERT_EQ(times.size(), 2U);
  EXPECT_GE(times.at("write").cpu_seconds, 3.0 * kWork);
  EXPECT_GE(times.at("write").wall_seconds, 2.0 * kWork);
  EXPECT_LT(times.at("read").cpu_seconds, 0.5 * kWork);
}

TEST(CpuMeter, KnowsShortWork) {
  CpuMeter meter;
  for (int k = 0; k < 2000; ++k) {
    meter.measure([] {
      const double begin = thread_seconds();
      while (thread_seconds() - begin < 1e-5) {
      }
    });
  }
  EXPECT_GE(meter.seconds(), 2000 * 1e-5);
}

}  // namespace
}  // namespace brdfit::cli
