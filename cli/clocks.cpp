// Clocks of the system.
#include "cli/clocks.h"

#include <ctime>

namespace brdfit::cli {
namespace {

// The clocks and not getrusage, which knows no more than the last tick of the scheduler.
double cpu_seconds(CpuOf whose) {
  timespec now{};
  clock_gettime(whose == CpuOf::kThread ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

BothClocks::BothClocks(CpuOf whose)
    : whose_(whose), start_(std::chrono::steady_clock::now()), cpu_start_(cpu_seconds(whose)) {}

TimeTaken BothClocks::taken() const {
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start_;
  return {wall.count(), cpu_seconds(whose_) - cpu_start_};
}

}  // namespace brdfit::cli
