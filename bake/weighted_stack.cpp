// Weights multiplied into what a stack hands out.
#include "bake/weighted_stack.h"

#include <algorithm>

namespace brdfit::bake {

TexelBlock WeightedStack::weighted(TexelBlock block) const {
  for (const BlockWeights& weights : weights_) weights.weigh(block);
  return block;
}

TexelBlock WeightedStack::read_rows(int first_row, int rows) {
  return weighted(stack_.read_rows(first_row, rows));
}

TexelBlock WeightedStack::read_luminance(int first_row, int rows) {
  // Luminance of colours that are weighted first, where any weight depends on them.
  const bool needs_colours =
      std::any_of(weights_.begin(), weights_.end(), [](const BlockWeights& w) { return w.needs_colours; });
  if (needs_colours) return ImageStack::read_luminance(first_row, rows);
  return weighted(stack_.read_luminance(first_row, rows));
}

TexelBlock WeightedStack::read_texels(std::span<const std::uint32_t> texels) {
  return weighted(stack_.read_texels(texels));
}

}  // namespace brdfit::bake
