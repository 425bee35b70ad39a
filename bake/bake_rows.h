// The short way from a block to its codes: for luminance in 8 bits with all lobes kept, the usual case, no
// problem is written to memory and codes come out of the same vector code as amplitudes.
#ifndef BRDFIT_BAKE_BAKE_ROWS_H_
#define BRDFIT_BAKE_BAKE_ROWS_H_

#include <cstdint>
#include <vector>

#include "bake/plan.h"

namespace brdfit::bake {

// Whether there is such a way: luminance, 8 bits, all lobes kept, no light left out, and a range for every
// lobe.
bool has_short_way(const StackInfo& info, const BakePlan& plan, const BakeSettings& settings,
                   const RealisPacking& packing);

// Whether it needs no more of the pictures than their luminance (ImageStack::read_luminance): Lambert with
// normals and albedo given, lights directional.
bool needs_luminance_alone(const StackInfo& info, const BakePlan& plan);

struct BakedRows {
  Surface surface;
  SolveResult solved;                // empty where the plan has no lobes
  std::vector<std::uint8_t> stored;  // [lobe][texel]: codes with their zeros added
};

// How many codes of an asset's rows are at an end of their range.
std::size_t cut_codes(const BakedRows& rows);

// As bake_block and compress_block together, to single precision. block: of colours, or of luminance where
// that is enough. dither: whether rounding is dithered. room: memory to work in, for the next call to find as
// it was left. Identical for any number of threads and however the
// asset is cut into blocks. Throws std::invalid_argument where sizes disagree.
BakedRows bake_rows(const StackInfo& info, const TexelBlock& block, const BakePlan& plan,
                    const BakeSettings& settings, const RealisPacking& packing, bool dither,
                    std::vector<float>* room = nullptr);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_BAKE_ROWS_H_
