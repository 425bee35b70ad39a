// What more workers bring, beside what they bring to a plain loop on the same machine at the same time.
#ifndef BRDFIT_CLI_RUN_SCALING_H_
#define BRDFIT_CLI_RUN_SCALING_H_

#include <cstddef>
#include <functional>

namespace brdfit::cli {

struct Scaling {
  double jobs = 1.0;  // speed of all workers over that of one
  double loop = 1.0;  // the same of a loop that computes in registers
};

// Adds the first terms of the harmonic series: quotients that wait for each other, in registers. The default
// takes some 50 ms.
void plain_loop(int terms = 40'000'000);

// Calls job(k) for k below count on `workers` threads, each taking the next when it is done; what a job does
// in parallel stays its own until there are no more jobs.
void run_jobs(std::size_t count, int workers, const std::function<void(std::size_t)>& job);

// Runs the jobs by one thread and by all workers, and the loop likewise in between, `repeats` times.
Scaling measure_scaling(std::size_t count, int workers, int repeats,
                        const std::function<void(std::size_t)>& job);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_RUN_SCALING_H_
