// The correction from what a renderer holds of a baked asset: codes, halves or floats of the lobes that a
// texel keeps, in single precision by one thread. What it costs is what a run-time evaluation on a processor
// costs.
#ifndef BRDFIT_BAKE_HELD_CORRECTION_H_
#define BRDFIT_BAKE_HELD_CORRECTION_H_

#include <cstdint>
#include <span>
#include <vector>

#include "bake/reconstruct.h"
#include "brdf/realis_asset.h"

namespace brdfit::bake {

// How an amplitude is stored: as a code of 4 or 8 bits, or as an IEEE half or float.
enum class AmplitudeBits { k4 = 4, k8 = 8, kHalf = 16, kFloat = 32 };

// The nearest value that a half holds (to even of two), those beyond at its end.
float rounded_to_half(float value);
// The half's bits of a value that it holds.
std::uint16_t half_bits(float value);

// Texels as a renderer holds them. Thin properties at run time are those that were baked.
struct HeldTexels {
  AmplitudeBits bits = AmplitudeBits::k8;
  std::size_t count = 0;
  std::size_t slots = 0;             // lobes that a texel keeps, times channels
  std::vector<std::uint8_t> bytes;   // slots as planes ([slot][texel]), of 4 bits two to a byte
  std::vector<std::uint32_t> masks;  // of the lobes that are kept; empty where all are
  std::vector<float> chroma;         // [channel][texel] for kScaledChroma
  Surface surface;
};

// Packs amplitudes ([plane][texel]) that the ranges of asset.packing hold; of masks of more than its dominant
// lobes the upper are dropped. Throws std::invalid_argument where sizes disagree.
HeldTexels held_texels(const RealisAsset& asset, AmplitudeBits bits, const RunTimeTexels& texels,
                       std::span<const std::uint32_t> masks);

// As correction() of bake/reconstruct.h, to single precision: [channel][texel] into out, 3 x count.
void held_correction(const RealisAsset& asset, const HeldTexels& texels, const RealisLight& light,
                     std::span<float> out);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_HELD_CORRECTION_H_
