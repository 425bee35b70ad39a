// The correction in single precision, by blocks of texels that stay in a cache.
#include "bake/held_correction.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <stdexcept>

#include "brdf/kernel/realis.h"

namespace brdfit::bake {
namespace {

constexpr std::size_t kBlock = 256;
constexpr float kLargestHalf = 65504.0F;

using Sums = std::array<std::array<float, kBlock>, 3>;

// What a stored number of a plane counts: stored * scale + offset, the lobe's value under the light included.
struct PlaneFactor {
  float scale = 0.0F;
  float offset = 0.0F;
};

float half_to_float(std::uint16_t half) {
  // The half's exponent and digits as a float's, then moved by the difference of their biases.
  const std::uint32_t digits = (half & 0x7FFFU) << 13U;
  const float size = std::bit_cast<float>(digits) * 0x1p112F;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(size) | (half & 0x8000U) << 16U);
}

template <class Stored>
Stored at(const HeldTexels& texels, std::size_t slot, std::size_t texel) {
  Stored value;
  std::memcpy(&value, texels.bytes.data() + (slot * texels.count + texel) * sizeof(Stored), sizeof(Stored));
  return value;
}

// The number of a slot, as it is stored.
template <AmplitudeBits kBits>
float stored(const HeldTexels& texels, std::size_t slot, std::size_t texel) {
  if constexpr (kBits == AmplitudeBits::k4) {
    const std::uint8_t both = texels.bytes[slot / 2 * texels.count + texel];
    return static_cast<float>(slot % 2 == 0 ? both & 15 : both >> 4);
  } else if constexpr (kBits == AmplitudeBits::k8) {
    return static_cast<float>(texels.bytes[slot * texels.count + texel]);
  } else if constexpr (kBits == AmplitudeBits::kHalf) {
    return half_to_float(at<std::uint16_t>(texels, slot, texel));
  } else {
    return at<float>(texels, slot, texel);
  }
}

// Sums over the lobes of texels [first, first + count).
template <AmplitudeBits kBits>
void add_lobes(const HeldTexels& texels, std::span<const PlaneFactor> factors, std::size_t channels,
               std::size_t first, std::size_t count, Sums& sums) {
  for (std::size_t c = 0; c < channels; ++c) sums[c].fill(0.0F);
  if (texels.masks.empty()) {
    for (std::size_t plane = 0; plane < factors.size(); ++plane) {
      const PlaneFactor factor = factors[plane];
      float* const sum = sums[plane % channels].data();
      for (std::size_t k = 0; k < count; ++k) {
        sum[k] += stored<kBits>(texels, plane, first + k) * factor.scale + factor.offset;
      }
    }
    return;
  }
  for (std::size_t k = 0; k < count; ++k) {
    std::size_t slot = 0;
    for (std::uint32_t mask = texels.masks[first + k]; mask != 0; mask &= mask - 1) {
      const auto lobe = static_cast<std::size_t>(std::countr_zero(mask));
      for (std::size_t c = 0; c < channels; ++c, ++slot) {
        const PlaneFactor factor = factors[lobe * channels + c];
        sums[c][k] += stored<kBits>(texels, slot, first + k) * factor.scale + factor.offset;
      }
    }
  }
}

void add_lobes(const HeldTexels& texels, std::span<const PlaneFactor> factors, std::size_t channels,
               std::size_t first, std::size_t count, Sums& sums) {
  switch (texels.bits) {
    case AmplitudeBits::k4:
      return add_lobes<AmplitudeBits::k4>(texels, factors, channels, first, count, sums);
    case AmplitudeBits::k8:
      return add_lobes<AmplitudeBits::k8>(texels, factors, channels, first, count, sums);
    case AmplitudeBits::kHalf:
      return add_lobes<AmplitudeBits::kHalf>(texels, factors, channels, first, count, sums);
    case AmplitudeBits::kFloat:
      return add_lobes<AmplitudeBits::kFloat>(texels, factors, channels, first, count, sums);
  }
}

bool is_code(AmplitudeBits bits) {
  return bits == AmplitudeBits::k4 || bits == AmplitudeBits::k8;
}

std::vector<PlaneFactor> factors_of(const RealisAsset& asset, AmplitudeBits bits, const RealisLight& light) {
  const auto channels = static_cast<std::size_t>(asset.channels());
  std::vector<PlaneFactor> factors;
  for (std::size_t plane = 0; plane < asset.plane_count(); ++plane) {
    const double value = eval(asset.lobes[plane / channels], light.direction);
    if (!is_code(bits)) {
      factors.push_back({static_cast<float>(value), 0.0F});
      continue;
    }
    const RealisRange& range = asset.packing.ranges[plane];
    factors.push_back(
        {static_cast<float>(value * range.step), static_cast<float>(-value * range.step * range.zero)});
  }
  return factors;
}

void store(HeldTexels& held, std::size_t slot, std::size_t texel, float amplitude, const RealisRange& range) {
  const std::size_t place = slot * held.count + texel;
  if (held.bits == AmplitudeBits::kFloat) {
    std::memcpy(held.bytes.data() + place * sizeof(float), &amplitude, sizeof(float));
    return;
  }
  if (held.bits == AmplitudeBits::kHalf) {
    const std::uint16_t half = half_bits(rounded_to_half(amplitude));
    std::memcpy(held.bytes.data() + place * sizeof(half), &half, sizeof(half));
    return;
  }
  const int bits = static_cast<int>(held.bits);
  const double code = range.step > 0.0 ? static_cast<double>(amplitude) / range.step : 0.0;
  const auto whole = static_cast<std::uint8_t>(
      std::clamp(static_cast<int>(std::lround(code)) + range.zero, 0, realis_top_code(bits)));
  if (bits == 8) {
    held.bytes[place] = whole;
  } else {
    std::uint8_t& both = held.bytes[slot / 2 * held.count + texel];
    both = static_cast<std::uint8_t>(slot % 2 == 0 ? both | whole : both | whole << 4);
  }
}

}  // namespace

float rounded_to_half(float value) {
  const float size = std::abs(value);
  if (size >= kLargestHalf) return std::copysign(kLargestHalf, value);
  int exponent = 0;
  std::frexp(size, &exponent);
  // Eleven digits; below the smallest normal half the step stays the same.
  const float step = std::ldexp(1.0F, std::max(exponent - 11, -24));
  return std::copysign(std::nearbyint(size / step) * step, value);
}

std::uint16_t half_bits(float value) {
  const std::uint32_t sign = std::bit_cast<std::uint32_t>(value) >> 16U & 0x8000U;
  const std::uint32_t size = std::bit_cast<std::uint32_t>(std::abs(value) * 0x1p-112F) >> 13U;
  return static_cast<std::uint16_t>(sign | size);
}

HeldTexels held_texels(const RealisAsset& asset, AmplitudeBits bits, const RunTimeTexels& texels,
                       std::span<const std::uint32_t> masks) {
  const std::size_t count = texels.surface.count();
  const auto channels = static_cast<std::size_t>(asset.channels());
  const bool keeps_all = static_cast<std::size_t>(asset.packing.dominant) >= asset.lobes.size();
  if (texels.amplitudes.size() != asset.plane_count() * count || (!keeps_all && masks.size() != count) ||
      (is_code(bits) && asset.packing.ranges.size() != asset.plane_count())) {
    throw std::invalid_argument("held_texels: sizes disagree");
  }
  HeldTexels held;
  held.bits = bits;
  held.count = count;
  held.slots = channels * (keeps_all ? asset.lobes.size() : static_cast<std::size_t>(asset.packing.dominant));
  held.chroma = texels.chroma;
  held.surface = texels.surface;
  const std::size_t half_bytes = (held.slots * static_cast<std::size_t>(bits) + 3) / 4;
  held.bytes.assign((half_bytes + 1) / 2 * count, 0);
  if (!keeps_all) held.masks.assign(masks.begin(), masks.end());
  for (std::size_t k = 0; k < count; ++k) {
    std::size_t slot = 0;
    for (std::size_t lobe = 0; lobe < asset.lobes.size(); ++lobe) {
      const std::uint32_t bit = 1U << lobe;
      if (!keeps_all && (held.masks[k] & bit) == 0) continue;
      if (slot >= held.slots) {
        held.masks[k] &= ~bit;
        continue;
      }
      for (std::size_t c = 0; c < channels; ++c, ++slot) {
        const std::size_t plane = lobe * channels + c;
        store(held, slot, k, texels.amplitudes[plane * count + k],
              is_code(bits) ? asset.packing.ranges[plane] : RealisRange{});
      }
    }
  }
  return held;
}

void held_correction(const RealisAsset& asset, const HeldTexels& texels, const RealisLight& light,
                     std::span<float> out) {
  const std::size_t count = texels.count;
  if (out.size() != 3 * count) throw std::invalid_argument("held_correction: sizes disagree");
  const std::vector<PlaneFactor> factors = factors_of(asset, texels.bits, light);
  const auto channels = static_cast<std::size_t>(asset.channels());
  const float* const normals = texels.surface.normals.data();
  const float* const albedo = texels.surface.albedo.data();
  const float lx = static_cast<float>(light.direction.x);
  const float ly = static_cast<float>(light.direction.y);
  const float lz = static_cast<float>(light.direction.z);
  const auto albedo_range = static_cast<float>(asset.fade.albedo_range);
  const auto cos_range = static_cast<float>(std::cos(asset.fade.normal_range_deg * std::numbers::pi / 180.0));
  Sums sums;
  std::array<float, kBlock> shade;
  for (std::size_t first = 0; first < count; first += kBlock) {
    const std::size_t size = std::min(kBlock, count - first);
    add_lobes(texels, factors, channels, first, size, sums);
    for (std::size_t k = 0; k < size; ++k) {
      const std::size_t t = first + k;
      const float nx = normals[t];
      const float ny = normals[count + t];
      const float nz = normals[2 * count + t];
      const float cos_i = std::max(lx * nx + ly * ny + lz * nz, 0.0F);
      // The run-time surface is the baked one here; a renderer has both, and the work is the same.
      const float cos_normals = nx * nx + ny * ny + nz * nz;
      shade[k] = cos_i * kernel::realis_fade(0.0F, cos_normals, albedo_range, cos_range);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const float* const sum = sums[channels == 3 ? c : 0].data();
      const float* const chroma = texels.chroma.empty() ? nullptr : texels.chroma.data() + c * count + first;
      const float* const tint = asset.albedo_in_modulation ? albedo + c * count + first : nullptr;
      const auto intensity = static_cast<float>(light.intensity[c]);
      float* const to = out.data() + c * count + first;
      for (std::size_t k = 0; k < size; ++k) to[k] = intensity * shade[k] * sum[k];
      for (std::size_t k = 0; chroma != nullptr && k < size; ++k) to[k] *= chroma[k];
      for (std::size_t k = 0; tint != nullptr && k < size; ++k) to[k] *= tint[k];
    }
  }
}

}  // namespace brdfit::bake
