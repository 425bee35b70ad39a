// Codes into bytes and back.
#include "bake/pack.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <stdexcept>

#include "brdf/realis.h"

namespace brdfit::bake {
namespace {

void put(const PackLayout& layout, PackedTexels& packed, std::size_t texel, int slot, int whole) {
  const int within = slot % layout.slots_per_texture();
  const int byte = layout.bits == 4 ? within / 2 : within;
  const int shift = layout.bits == 4 ? within % 2 * 4 : 0;
  const int stored = whole << shift;
  std::uint8_t& place = packed.textures[static_cast<std::size_t>(slot / layout.slots_per_texture())]
                                       [texel * 4 + static_cast<std::size_t>(byte)];
  const int kept = layout.bits == 4 ? place & (0xF0 >> shift) : 0;
  place = static_cast<std::uint8_t>(kept | stored);
}

int get(const PackLayout& layout, const PackedTexels& packed, std::size_t texel, int slot) {
  const int within = slot % layout.slots_per_texture();
  const int byte = layout.bits == 4 ? within / 2 : within;
  const int value = packed.textures[static_cast<std::size_t>(slot / layout.slots_per_texture())]
                                   [texel * 4 + static_cast<std::size_t>(byte)];
  return layout.bits == 4 ? value >> (within % 2 * 4) & 0xF : value;
}

std::uint32_t all_lobes(const PackLayout& layout) {
  return layout.lobes == 32 ? ~0U : (1U << static_cast<unsigned>(layout.lobes)) - 1U;
}

void check(const PackLayout& layout) {
  const bool good =
      layout.lobes >= 0 && layout.lobes <= 24 && (layout.channels == 1 || layout.channels == 3) &&
      (layout.bits == 4 || layout.bits == 8) && layout.dominant >= 0 && layout.dominant <= layout.lobes;
  if (!good) throw std::invalid_argument("pack: no such layout");
  if (layout.zeros.size() != static_cast<std::size_t>(layout.lobes * layout.channels))
    throw std::invalid_argument("pack: not every plane has a zero");
  for (const int zero : layout.zeros) {
    if (zero < 0 || zero > realis_top_code(layout.bits))
      throw std::invalid_argument("pack: a zero is out of range");
  }
}

}  // namespace

PackedTexels pack(const PackLayout& layout, std::span<const int> codes,
                  std::span<const std::uint32_t> masks) {
  check(layout);
  const std::size_t texels = masks.size();
  const auto planes = static_cast<std::size_t>(layout.lobes * layout.channels);
  if (codes.size() != planes * texels) throw std::invalid_argument("pack: sizes disagree");
  const auto middle = static_cast<std::uint8_t>(layout.bits == 4 ? 0x88 : 0x80);
  PackedTexels packed;
  packed.textures.assign(static_cast<std::size_t>(layout.textures()),
                         std::vector<std::uint8_t>(texels * 4, middle));
  packed.mask.resize(texels * static_cast<std::size_t>(layout.mask_channels()));
  for (std::size_t texel = 0; texel < texels; ++texel) {
    if (std::popcount(masks[texel]) > layout.dominant)
      throw std::invalid_argument("pack: a mask has too many lobes");
    const std::uint32_t kept = layout.dominant == layout.lobes ? all_lobes(layout) : masks[texel];
    int slot = 0;
    for (int lobe = 0; lobe < layout.lobes; ++lobe) {
      if ((kept >> lobe & 1U) == 0) continue;
      for (int channel = 0; channel < layout.channels; ++channel) {
        const auto plane = static_cast<std::size_t>(lobe * layout.channels + channel);
        const int whole = codes[plane * texels + texel] + layout.zeros[plane];
        if (whole < 0 || whole > realis_top_code(layout.bits))
          throw std::invalid_argument("pack: a code is out of range");
        put(layout, packed, texel, slot++, whole);
      }
    }
    for (int byte = 0; byte < layout.mask_channels(); ++byte) {
      packed.mask[texel * static_cast<std::size_t>(layout.mask_channels()) + static_cast<std::size_t>(byte)] =
          static_cast<std::uint8_t>(kept >> (8 * byte));
    }
  }
  return packed;
}

PackedTexels pack_all(const PackLayout& layout, std::span<const std::uint8_t> stored) {
  check(layout);
  const auto planes = static_cast<std::size_t>(layout.slots());
  if (layout.bits != 8 || layout.dominant != layout.lobes || planes == 0 || stored.size() % planes != 0) {
    throw std::invalid_argument("pack_all: no such layout");
  }
  const std::size_t texels = stored.size() / planes;
  PackedTexels packed;
  packed.textures.assign(static_cast<std::size_t>(layout.textures()), std::vector<std::uint8_t>(texels * 4));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, texels, 4096), [&](const auto& range) {
    for (std::size_t slot = 0; slot < 4 * packed.textures.size(); ++slot) {
      std::uint8_t* to = packed.textures[slot / 4].data() + slot % 4;
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        to[4 * k] = slot < planes ? stored[slot * texels + k] : std::uint8_t{0x80};
      }
    }
  });
  return packed;
}

std::vector<int> unpack(const PackLayout& layout, const PackedTexels& packed, std::size_t texels,
                        std::vector<std::uint32_t>* masks) {
  check(layout);
  const auto mask_channels = static_cast<std::size_t>(layout.mask_channels());
  bool fits = packed.textures.size() == static_cast<std::size_t>(layout.textures()) &&
              packed.mask.size() == texels * mask_channels;
  for (const auto& texture : packed.textures) fits = fits && texture.size() == texels * 4;
  if (!fits) throw std::invalid_argument("unpack: sizes disagree");
  std::vector<int> codes(static_cast<std::size_t>(layout.lobes * layout.channels) * texels, 0);
  if (masks != nullptr) masks->assign(texels, 0);
  for (std::size_t texel = 0; texel < texels; ++texel) {
    std::uint32_t kept = mask_channels == 0 ? all_lobes(layout) : 0;
    for (std::size_t byte = 0; byte < mask_channels; ++byte) {
      kept |= static_cast<std::uint32_t>(packed.mask[texel * mask_channels + byte]) << (8 * byte);
    }
    kept &= all_lobes(layout);
    if (masks != nullptr) (*masks)[texel] = kept;
    int slot = 0;
    for (int lobe = 0; lobe < layout.lobes && slot < layout.slots(); ++lobe) {
      if ((kept >> lobe & 1U) == 0) continue;
      for (int channel = 0; channel < layout.channels; ++channel) {
        const auto plane = static_cast<std::size_t>(lobe * layout.channels + channel);
        codes[plane * texels + texel] = get(layout, packed, texel, slot++) - layout.zeros[plane];
      }
    }
  }
  return codes;
}

}  // namespace brdfit::bake
