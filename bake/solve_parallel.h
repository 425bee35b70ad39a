// Solve jobs of whole blocks: what a system says of them, and texels spread over threads.
#ifndef BRDFIT_BAKE_SOLVE_PARALLEL_H_
#define BRDFIT_BAKE_SOLVE_PARALLEL_H_

#include <cstddef>
#include <vector>

#include "bake/solve.h"
#include "bake/solve_job.h"

namespace brdfit::bake {

// A job over all texels of a block, without its residuals and modulations. result: sized, filled with 0 and
// referred to, as is the system.
SolveJob solve_job(const LobeSystem& system, std::size_t lights, std::size_t texels,
                   const SolveOptions& options, SolveResult& result);

// Lobes as NearLights takes them.
std::vector<double> lobe_numbers(const LobeSet& lobes);

// Runs the job on texels [0, stride). Identical for any number of threads.
void solve_parallel(const SolveJob& job, simd::Isa isa);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_SOLVE_PARALLEL_H_
