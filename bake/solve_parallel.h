// Solve jobs of whole blocks: what a system says of them, and texels spread over threads.
#ifndef BRDFIT_BAKE_SOLVE_PARALLEL_H_
#define BRDFIT_BAKE_SOLVE_PARALLEL_H_

#include <cstddef>
#include <functional>
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

// Fills in the noise of the dither of texels [first, first + count): [lobe][texel].
using NoiseOf = std::function<void(std::size_t first, std::size_t count, std::vector<float>& noise)>;

// Runs the job on texels [0, stride). noise_of: called from several threads at once where the job asks for
// codes; empty: no dither. Identical for any number of threads.
void solve_parallel(const SolveJob& job, simd::Isa isa, const NoiseOf& noise_of = {});

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_SOLVE_PARALLEL_H_
