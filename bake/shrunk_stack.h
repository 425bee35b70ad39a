// A stack as if its camera had fewer pixels: squares of texels become one.
#ifndef BRDFIT_BAKE_SHRUNK_STACK_H_
#define BRDFIT_BAKE_SHRUNK_STACK_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "measured/image_stack.h"

namespace brdfit::bake {

inline constexpr int kMostShrink = 64;

// Means over squares of shrink x shrink texels; those at the right and lower edge may be cut. Values count by
// their weights, and a square's weight is the mean of its texels' weights.
class ShrunkStack : public ImageStack {
 public:
  // whole must outlive it. memory_bytes: for the strips of it that are read at a time. Throws
  // std::invalid_argument where shrink is not in [1, kMostShrink].
  ShrunkStack(ImageStack& whole, int shrink, std::size_t memory_bytes = std::size_t{64} << 20);

  const StackInfo& info() const override { return info_; }
  TexelBlock read_rows(int first_row, int rows) override;
  // In one pass over the pictures.
  TexelBlock read_texels(std::span<const std::uint32_t> texels) override;
  void give_back(TexelBlock block) override { given_back_ = std::move(block); }

 private:
  TexelBlock strip(int first_row, int rows);
  int strip_rows() const;

  ImageStack& whole_;
  int shrink_;
  std::size_t memory_bytes_;
  StackInfo info_;
  TexelBlock given_back_;
};

// Where a texel of the whole picture lies among those of the shrunk one: the four around it and their shares,
// which sum to 1, as a texture is filtered. Beyond the outermost centres the nearest are repeated.
struct ShrunkPlace {
  std::array<std::uint32_t, 4> texels{};
  std::array<double, 4> shares{};
};
ShrunkPlace shrunk_place(const StackInfo& whole, int shrink, std::uint32_t texel);

// Planes ([plane][shrunk texel]) at texels of the whole picture: [plane][texel]. shrunk_texels: the columns
// of the planes, ascending. Throws std::invalid_argument where one that is needed is not among them.
std::vector<float> magnified(const StackInfo& whole, int shrink, std::span<const float> planes,
                             std::span<const std::uint32_t> shrunk_texels,
                             std::span<const std::uint32_t> texels);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_SHRUNK_STACK_H_
