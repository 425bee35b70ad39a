// XXH64, by the library of its author.
#include "io/checksum.h"

#include <xxhash.h>

namespace brdfit::io {

std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t seed) {
  return XXH64(bytes.data(), bytes.size(), seed);
}

}  // namespace brdfit::io
