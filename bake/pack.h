// Codes of amplitudes as the bytes of run-time textures, and back.
//
// A texel keeps `dominant` lobes; slot s holds the s-th lobe of its mask, in the order of lobes (for RGB
// three slots, red first). With 8 bits four slots make one RGBA texture; with 4 bits eight do, the first of
// two in the low half of a byte. A code is stored with its plane's zero added, so that it is not negative;
// slots that no lobe uses hold the middle of the range.
#ifndef BRDFIT_BAKE_PACK_H_
#define BRDFIT_BAKE_PACK_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "brdf/realis.h"

namespace brdfit::bake {

// How many of what an asset's textures hold.
struct PackLayout {
  int lobes = 8;
  int channels = 1;  // of an amplitude: 3 for RGB
  int bits = 8;      // 4 or 8
  int dominant = 8;  // lobes kept per texel
  // Per plane ([lobe][channel]): how the code 0 is stored, in [0, 2^bits - 1].
  std::vector<int> zeros;

  int slots() const { return dominant * channels; }
  int slots_per_texture() const { return realis_slots_per_texture(bits); }
  int textures() const { return realis_textures(slots(), bits); }
  // Bytes per texel of the mask's picture: 1, 3 (up to 24 lobes; the third is 0 up to 16); 0 where all lobes
  // are kept.
  int mask_channels() const { return dominant == lobes ? 0 : lobes <= 8 ? 1 : 3; }
};

// Of any run of texels.
struct PackedTexels {
  std::vector<std::vector<std::uint8_t>> textures;  // [texture][texel * 4]
  std::vector<std::uint8_t> mask;                   // [texel * mask_channels()]
};

// codes: [lobe][channel][texel], each plane's from -zero to 2^bits - 1 - zero; masks: per texel, bit k for
// lobe k, as many bits as layout.dominant or fewer. Throws std::invalid_argument where sizes disagree, a code
// is out of range or a mask has too many bits.
PackedTexels pack(const PackLayout& layout, std::span<const int> codes, std::span<const std::uint32_t> masks);

// The same for 8 bits with all lobes kept, in parallel over texels. stored: [lobe][channel][texel], codes
// with their zeros added.
PackedTexels pack_all(const PackLayout& layout, std::span<const std::uint8_t> stored);

// The inverse: codes as given to pack, 0 for lobes that were not kept. masks: filled in.
std::vector<int> unpack(const PackLayout& layout, const PackedTexels& packed, std::size_t texels,
                        std::vector<std::uint32_t>* masks = nullptr);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_PACK_H_
