// Time on the wall and of processors.
#ifndef BRDFIT_CLI_CLOCKS_H_
#define BRDFIT_CLI_CLOCKS_H_

#include <atomic>
#include <chrono>
#include <cstdint>

namespace brdfit::cli {

// Of the clock on the wall, and of all processors together: on a machine that others use the second says
// more.
struct TimeTaken {
  double wall_seconds = 0.0;
  double cpu_seconds = 0.0;
};

inline TimeTaken operator+(const TimeTaken& a, const TimeTaken& b) {
  return {a.wall_seconds + b.wall_seconds, a.cpu_seconds + b.cpu_seconds};
}

enum class CpuOf { kProcess, kThread };  // the thread that asks

// Starts when it is made.
class BothClocks {
 public:
  explicit BothClocks(CpuOf whose = CpuOf::kProcess);
  TimeTaken taken() const;

 private:
  CpuOf whose_;
  std::chrono::steady_clock::time_point start_;
  double cpu_start_;
};

// CPU time of work that goes on beside other work. Several threads may add to it, each what it took itself.
class CpuMeter {
 public:
  // work: of this thread alone.
  template <class Work>
  void measure(const Work& work) {
    const BothClocks clocks(CpuOf::kThread);
    work();
    nanoseconds_ += static_cast<std::int64_t>(1e9 * clocks.taken().cpu_seconds);
  }
  double seconds() const { return 1e-9 * static_cast<double>(nanoseconds_.load()); }

 private:
  std::atomic<std::int64_t> nanoseconds_{0};
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_CLOCKS_H_
