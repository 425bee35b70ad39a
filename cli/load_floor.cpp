// Timing of a bare read and conversion.
#include "cli/load_floor.h"

#include <fstream>
#include <vector>

#include "cli/common.h"
#include "io/error.h"

namespace brdfit::cli {

double load_floor_seconds(const std::filesystem::path& file) {
  const Stopwatch watch;
  std::ifstream in(file, std::ios::binary);
  constexpr std::size_t kHeaderBytes = 12;
  const std::size_t values = (std::filesystem::file_size(file) - kHeaderBytes) / sizeof(double);
  std::vector<double> stored(values);
  in.seekg(kHeaderBytes);
  in.read(reinterpret_cast<char*>(stored.data()), static_cast<std::streamsize>(values * sizeof(double)));
  if (!in) {
    throw io::IoError(io::IoError::Side::kInput, file.string(), "cannot be read to its end",
                      "a MERL .binary file");
  }
  const std::vector<float> converted(stored.begin(), stored.end());
  // The converted values must exist for the time to count.
  volatile float last = converted.empty() ? 0.0F : converted.back();
  static_cast<void>(last);
  return watch.seconds();
}

}  // namespace brdfit::cli
