// Work in parts that a device can take.
#ifndef BRDFIT_GPU_BATCHES_H_
#define BRDFIT_GPU_BATCHES_H_

#include <algorithm>
#include <cstddef>

#include "gpu/error.h"

namespace brdfit {

// Below this a batch is not halved: a device without room for it has no room at all.
inline constexpr std::size_t kSmallestBatch = 4096;

// Calls run(first, count) for parts of 0 ... total - 1, in order, none larger than `largest` (> 0). A part
// for which run throws GpuError (kOutOfMemory) is tried again in halves, down to kSmallestBatch, and later
// parts are no larger than what went through. Any other error ends it.
template <class Run>
void run_in_batches(std::size_t total, std::size_t largest, const Run& run) {
  for (std::size_t first = 0; first < total;) {
    const std::size_t count = std::min(largest, total - first);
    try {
      run(first, count);
    } catch (const GpuError& error) {
      if (error.kind() != GpuError::Kind::kOutOfMemory || count / 2 < kSmallestBatch) throw;
      largest = count / 2;
      continue;
    }
    first += count;
  }
}

}  // namespace brdfit

#endif  // BRDFIT_GPU_BATCHES_H_
