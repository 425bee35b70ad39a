// Blocks of texels cut into chunks for vector code: lights as they reach each, values padded to full chunks.
#ifndef BRDFIT_BAKE_CHUNK_H_
#define BRDFIT_BAKE_CHUNK_H_

#include <cstdint>
#include <span>
#include <vector>

#include "bake/chunk_jobs.h"
#include "measured/image_stack.h"

namespace brdfit::bake {

// Indices of a stack's lights, ascending: those that a stage may look at.
using LightChoice = std::vector<std::uint32_t>;
LightChoice all_lights(const StackInfo& info);
// The others.
LightChoice without(const StackInfo& info, std::span<const std::uint32_t> held_out);

// Chosen lights over chunks of texels, in single or double precision. Directional ones are the same for all
// chunks.
template <class S>
class ChunkLightsOf {
 public:
  ChunkLightsOf(const StackInfo& info, std::span<const std::uint32_t> lights);

  // Where near lights differ between texels, `at_texels` is filled and referred to.
  LightColumnsOf<S> columns(std::span<const std::uint32_t> texels, std::vector<S>& at_texels) const;

 private:
  const StackInfo& info_;
  LightChoice lights_;
  bool near_;
  std::vector<S> direction_;
  std::vector<S> falloff_;
  std::vector<S> intensity_;
};
using ChunkLights = ChunkLightsOf<float>;

// The values of texels [first, first + kChunk) of a block; `padded` is filled and referred to where the block
// ends earlier, with weights 0 for what is not there.
ValueColumns chunk_values(const TexelBlock& block, std::span<const std::uint32_t> lights, std::size_t first,
                          std::vector<float>& padded);

// Columns [first, first + kChunk) of a matrix of 3 rows, the last one repeated where it ends earlier.
template <class S>
void copy_chunk(std::span<const float> matrix, std::size_t columns, std::size_t first, S* to);
// The other way, what is beyond the end left out.
void store_chunk(const float* from, std::size_t rows, std::size_t columns, std::size_t first,
                 std::span<float> matrix);

inline std::size_t chunk_count(std::size_t texels) {
  return (texels + kChunk - 1) / kChunk;
}

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_CHUNK_H_
