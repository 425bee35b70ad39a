// Compression of a block's amplitudes: fewer lobes and fewer bits per texel, each texel by its own equations.
#ifndef BRDFIT_BAKE_COMPRESS_BLOCK_H_
#define BRDFIT_BAKE_COMPRESS_BLOCK_H_

#include <cstdint>
#include <span>
#include <vector>

#include "bake/code_ranges.h"
#include "bake/solve.h"
#include "bake/texel_problem.h"

namespace brdfit::bake {

// A texel's normal equations under the system's lights.
TexelEquations texel_equations(const LobeSystem& system, const TexelProblem& problem, std::size_t texel);

struct CompressOptions {
  int bits = 8;      // of a code; 0: amplitudes are not rounded
  int dominant = 0;  // lobes kept per texel
  bool dither = true;
};

// What is left of amplitudes.
struct Compressed {
  std::vector<float> amplitudes;     // [lobe][texel]: what the codes stand for
  std::vector<int> codes;            // [lobe][texel]; empty where amplitudes are not rounded
  std::vector<std::uint32_t> masks;  // per texel, bit k: lobe k is kept; 0 for texels without amplitudes
};

// Per texel, the lobes that all problems of a block (its colour channels) keep together; 0 for texels without
// amplitudes in any. solved: of each problem.
std::vector<std::uint32_t> dominant_masks(const LobeSystem& system, std::span<const TexelProblem> problems,
                                          std::span<const SolveResult> solved, int dominant);

// Ranges of the lobes' codes from up to 512 texels of a block (4096 with 6 bits or more), spread evenly over
// those that have amplitudes; all with step 0 where none has, or amplitudes are not rounded. Throws
// std::invalid_argument where sizes disagree. masks: the lobes that texels keep (dominant_masks); empty: each
// problem its own.
std::vector<RealisRange> code_ranges(const LobeSystem& system, const TexelProblem& problem,
                                     std::span<const float> amplitudes, const CompressOptions& options,
                                     std::span<const std::uint32_t> masks = {});

// ranges: per lobe (code_ranges); not looked at where amplitudes are not rounded. texels: pixel of each, for
// the dither. width: of the picture. Texels whose amplitudes are all 0 (not selected) stay so. Parallel over
// texels; the same for any number of threads. masks: as of code_ranges. Throws std::invalid_argument where
// sizes disagree.
Compressed compress_block(const LobeSystem& system, const TexelProblem& problem,
                          std::span<const float> amplitudes, std::span<const std::uint32_t> texels, int width,
                          std::span<const RealisRange> ranges, const CompressOptions& options,
                          std::span<const std::uint32_t> masks = {});

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_COMPRESS_BLOCK_H_
