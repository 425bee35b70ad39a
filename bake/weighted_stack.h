// A stack whose values count as much as somebody says: the hook for sensor noise, shadow contours, and what a
// projection knows.
#ifndef BRDFIT_BAKE_WEIGHTED_STACK_H_
#define BRDFIT_BAKE_WEIGHTED_STACK_H_

#include <functional>
#include <utility>
#include <vector>

#include "measured/image_stack.h"

namespace brdfit::bake {

// Multiplies the weights of a block by what it knows of the block's texels and lights. What it does to a
// value may depend on that value and its place alone, never on what else the block holds: texels are read in
// strips and in samples, and must weigh the same in both.
struct BlockWeights {
  std::function<void(TexelBlock&)> weigh;
  bool needs_colours = false;  // is never handed a block of luminances
};

// Hands out the blocks of another stack, which must outlive it, with weights multiplied in their order. With
// none, blocks are the other stack's to the bit.
class WeightedStack : public ImageStack {
 public:
  explicit WeightedStack(ImageStack& stack) : stack_(stack) {}
  void add(BlockWeights weights) { weights_.push_back(std::move(weights)); }

  const StackInfo& info() const override { return stack_.info(); }
  TexelBlock read_rows(int first_row, int rows) override;
  TexelBlock read_luminance(int first_row, int rows) override;
  TexelBlock read_texels(std::span<const std::uint32_t> texels) override;
  void give_back(TexelBlock block) override { stack_.give_back(std::move(block)); }

 private:
  TexelBlock weighted(TexelBlock block) const;

  ImageStack& stack_;
  std::vector<BlockWeights> weights_;
};

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_WEIGHTED_STACK_H_
