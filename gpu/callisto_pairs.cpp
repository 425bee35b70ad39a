// Packs pairs for the shader callisto_pairs.comp, which the build compiles into this file.
#include "gpu/callisto_pairs.h"

#include <array>
#include <bit>
#include <cstdint>
#include <tuple>

namespace brdfit {
namespace {

constexpr std::uint32_t kSpirv[] = {
#include "callisto_pairs.spv.inc"
};

using Packed = std::array<float, sizeof(CallistoPair) / sizeof(float)>;

}  // namespace

std::vector<float> callisto_pairs(ComputeDevice& device, std::span<const CallistoPair> pairs) {
  if (pairs.empty()) return {};
  std::vector<float> in;
  in.reserve(pairs.size() * std::tuple_size_v<Packed>);
  for (const CallistoPair& pair : pairs) {
    const Packed packed = std::bit_cast<Packed>(pair);
    in.insert(in.end(), packed.begin(), packed.end());
  }
  std::vector<float> out(pairs.size());
  device.run(kSpirv, in, out);
  return out;
}

}  // namespace brdfit
