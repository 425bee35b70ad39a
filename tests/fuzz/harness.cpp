// Promises that all readers make.
#include "tests/fuzz/harness.h"

#include <algorithm>
#include <cmath>

namespace brdfit::fuzz {

bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_unit(const Vec3& v) {
  return std::abs(std::hypot(v.x, v.y, v.z) - 1.0) < 1e-12;
}

void require_plain(const io::IoError& error) {
  constexpr std::size_t kLongest = 1000;
  const std::string what = error.what();
  require(error.side() == io::IoError::Side::kInput, "an input's error is of the input's side: " + what);
  require(std::none_of(what.begin(), what.end(),
                       [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }),
          "an error is one line without control characters: " + what);
  require(error.found().size() <= kLongest && error.expected().size() <= kLongest, "an error is short");
}

void write_input(const std::filesystem::path& file, Bytes input) {
  tests::write_text(file, {reinterpret_cast<const char*>(input.data()), input.size()});
}

}  // namespace brdfit::fuzz
