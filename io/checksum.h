// A fast checksum of bytes: whether what is read is what was written. No protection against anybody.
#ifndef BRDFIT_IO_CHECKSUM_H_
#define BRDFIT_IO_CHECKSUM_H_

#include <cstddef>
#include <cstdint>
#include <span>

namespace brdfit::io {

// XXH64 (Collet 2014) with this seed: some ten bytes per nanosecond, as fast as memory is read.
std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t seed = 0);

}  // namespace brdfit::io

#endif  // BRDFIT_IO_CHECKSUM_H_
