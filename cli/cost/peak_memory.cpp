// The kernel's own figures.
#include "cli/cost/peak_memory.h"

#include <malloc.h>

#include <fstream>
#include <string>

#include "cli/cost/cost_point.h"

namespace brdfit::cli {

bool reset_peak_memory() {
  malloc_trim(0);
  std::ofstream file("/proc/self/clear_refs");
  file << "5" << std::flush;
  return file.good();
}

double peak_memory_mib() {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;) {
    double kib = 0.0;
    if (word == "VmHWM:" && file >> kib) return kib / 1024.0;
  }
  return kNotMeasured;
}

}  // namespace brdfit::cli
