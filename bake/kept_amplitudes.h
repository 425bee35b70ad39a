// What sizes of Realis keep of a block that is solved: fewer lobes per texel, amplitudes of fewer bits.
#ifndef BRDFIT_BAKE_KEPT_AMPLITUDES_H_
#define BRDFIT_BAKE_KEPT_AMPLITUDES_H_

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "bake/compress_block.h"

namespace brdfit::bake {

class KeptAmplitudes {
 public:
  // One problem, of luminance, or three, of channels, and what each was solved to. texels, width: as of
  // compress_block. All must outlive it.
  KeptAmplitudes(const LobeSystem& system, std::span<const TexelProblem> problems,
                 std::span<const SolveResult> solved, std::span<const std::uint32_t> texels, int width)
      : system_(system), problems_(problems), solved_(solved), texels_(texels), width_(width) {}

  // Per texel, the lobes that its channels keep together, as in the asset; empty where all are kept. Found
  // once for all sizes that keep as many.
  const std::vector<std::uint32_t>& masks(int dominant);

  // Of the codes of each problem's lobes (code_ranges), from these texels.
  std::vector<std::vector<RealisRange>> ranges(const CompressOptions& options);

  // Of each problem, [lobe][texel]: those that were solved for, or what is left of them. ranges: of each
  // problem; not looked at where amplitudes are not rounded.
  std::vector<std::vector<float>> amplitudes(const CompressOptions& options,
                                             std::span<const std::vector<RealisRange>> ranges);

 private:
  const LobeSystem& system_;
  std::span<const TexelProblem> problems_;
  std::span<const SolveResult> solved_;
  std::span<const std::uint32_t> texels_;
  int width_;
  std::map<int, std::vector<std::uint32_t>> masks_;
};

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_KEPT_AMPLITUDES_H_
