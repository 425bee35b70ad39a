// Pairs of directions on which a device is compared with the processor: random ones, and those at which
// formulas in single precision break.
#ifndef BRDFIT_GPU_PARITY_PAIRS_H_
#define BRDFIT_GPU_PARITY_PAIRS_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "gpu/float_material.h"

namespace brdfit {

// Where a pair lies. Small distances are drawn evenly in their logarithm, down to the smallest floats.
enum class PairKind {
  kAnywhere,  // both directions anywhere above the horizon
  kGrazing,   // one or both with a small cosine
  kMirror,    // close to each other's mirror image, or exactly so
  kPole,      // half vector at or next to the normal, both directions next to it too
  kRetro,     // close to each other, or equal
  kOpposite,  // close to opposite each other along the horizon
  kRight,     // at right angles or nearly so
  kDenormal,  // cosines smaller than the smallest normal float
  kBelow,     // one or both at or below the horizon
};

std::span<const PairKind> all_pair_kinds();

// "anywhere", "grazing", ...
std::string_view name_of(PairKind kind);

// Pairs first ... first + out.size() - 1 of the endless sequence that a seed names; it goes through the kinds
// in turn. The same numbers on every machine.
void fill_parity_pairs(std::uint64_t seed, std::uint64_t first, std::span<FloatPair> out);

// The kind of the pair at that place of a sequence.
PairKind kind_of_parity_pair(std::uint64_t index);

}  // namespace brdfit

#endif  // BRDFIT_GPU_PARITY_PAIRS_H_
