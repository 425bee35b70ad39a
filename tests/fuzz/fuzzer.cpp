// The entry of libFuzzer, for the harness that the build names.
#include <tbb/global_control.h>

#include "tests/fuzz/harness.h"

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  // Files this small gain nothing from threads, and one thread makes runs alike.
  static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  brdfit::fuzz::BRDFIT_HARNESS({data, size});
  return 0;
}
