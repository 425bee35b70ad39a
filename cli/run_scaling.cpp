// Workers and how they scale.
#include "cli/run_scaling.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>

#include "cli/common.h"

namespace brdfit::cli {
namespace {

double seconds_of(const std::function<void()>& work) {
  const Stopwatch watch;
  work();
  return watch.seconds();
}

}  // namespace

void plain_loop(int terms) {
  double sum = 0.0;
  for (int k = 1; k < terms; ++k) sum += 1.0 / static_cast<double>(k);
  volatile double kept = sum;
  static_cast<void>(kept);
}

void run_jobs(std::size_t count, int workers, const std::function<void(std::size_t)>& job) {
  std::atomic<std::size_t> next{0};
  tbb::parallel_for(
      tbb::blocked_range<int>(0, workers, 1),
      [&](const tbb::blocked_range<int>&) {
        for (std::size_t k = next++; k < count; k = next++) {
          // Isolated: a thread that waits within one job must not begin another, which would hold two tables.
          tbb::this_task_arena::isolate([&] { job(k); });
        }
      },
      tbb::simple_partitioner());
}

Scaling measure_scaling(std::size_t count, int workers, int repeats,
                        const std::function<void(std::size_t)>& job) {
  tbb::task_arena alone(1);
  double jobs_alone = 0.0;
  double jobs_together = 0.0;
  double loop_alone = 0.0;
  double loop_together = 0.0;
  const auto all_loops = [](std::size_t) { plain_loop(); };
  const auto loops = static_cast<std::size_t>(4 * workers);
  for (int repeat = 0; repeat < repeats; ++repeat) {
    jobs_alone += seconds_of([&] { alone.execute([&] { run_jobs(count, 1, job); }); });
    loop_alone += seconds_of([&] { alone.execute([&] { run_jobs(loops, 1, all_loops); }); });
    jobs_together += seconds_of([&] { run_jobs(count, workers, job); });
    loop_together += seconds_of([&] { run_jobs(loops, workers, all_loops); });
  }
  return {jobs_alone / jobs_together, loop_alone / loop_together};
}

}  // namespace brdfit::cli
