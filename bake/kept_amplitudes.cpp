// Masks of channels together, codes of each by itself.
#include "bake/kept_amplitudes.h"

namespace brdfit::bake {

const std::vector<std::uint32_t>& KeptAmplitudes::masks(int dominant) {
  std::vector<std::uint32_t>& masks = masks_[dominant];
  if (static_cast<std::size_t>(dominant) < system_.lobes().size() && masks.empty()) {
    masks = dominant_masks(system_, problems_, solved_, dominant);
  }
  return masks;
}

std::vector<std::vector<RealisRange>> KeptAmplitudes::ranges(const CompressOptions& options) {
  const std::vector<std::uint32_t>& kept = masks(options.dominant);
  std::vector<std::vector<RealisRange>> out;
  for (std::size_t p = 0; p < problems_.size(); ++p) {
    out.push_back(code_ranges(system_, problems_[p], solved_[p].amplitudes, options, kept));
  }
  return out;
}

std::vector<std::vector<float>> KeptAmplitudes::amplitudes(const CompressOptions& options,
                                                           std::span<const std::vector<RealisRange>> ranges) {
  const std::vector<std::uint32_t>& kept = masks(options.dominant);
  const bool is_whole = options.bits == 0 && kept.empty();
  std::vector<std::vector<float>> out;
  for (std::size_t p = 0; p < problems_.size(); ++p) {
    if (is_whole) {
      out.push_back(solved_[p].amplitudes);
      continue;
    }
    const std::span<const RealisRange> of_problem =
        options.bits == 0 ? std::span<const RealisRange>() : std::span<const RealisRange>(ranges[p]);
    out.push_back(compress_block(system_, problems_[p], solved_[p].amplitudes, texels_, width_, of_problem,
                                 options, kept)
                      .amplitudes);
  }
  return out;
}

}  // namespace brdfit::bake
