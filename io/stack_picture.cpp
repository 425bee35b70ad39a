// Checks that are the same for manifests and light files.
#include "io/stack_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/error.h"

namespace brdfit::io {
namespace {

namespace fs = std::filesystem;
using Side = IoError::Side;

// A file by one name, however it was spelt.
fs::path identity_of(const fs::path& file) {
  std::error_code error;
  const fs::path canonical = fs::canonical(file, error);
  return error ? file.lexically_normal() : canonical;
}

}  // namespace

Vec3 light_direction(const Vec3& direction, const std::string& file, const std::string& where) {
  const double length = std::hypot(direction.x, direction.y, direction.z);
  const auto text = [&] { return fmt::format("({}, {}, {})", direction.x, direction.y, direction.z); };
  if (!std::isfinite(length) || length < 1e-9) {
    throw IoError(Side::kInput, file, fmt::format("{} is {}", where, text()),
                  "a direction towards the light");
  }
  if (direction.z < 0.0) {
    throw IoError(Side::kInput, file, fmt::format("{} is {}, below the surface plane", where, text()),
                  "z of 0 or more, towards the camera", "are the directions meant from the light?");
  }
  return {direction.x / length, direction.y / length, direction.z / length};
}

void settle_pictures(std::vector<StackPicture>& pictures, const std::string& file) {
  std::sort(pictures.begin(), pictures.end(),
            [](const StackPicture& a, const StackPicture& b) { return a.file < b.file; });
  std::vector<fs::path> identities;
  for (StackPicture& picture : pictures) {
    picture.light.name = picture.file.filename().string();
    identities.push_back(identity_of(picture.file));
  }
  std::sort(identities.begin(), identities.end());
  const auto twice = std::adjacent_find(identities.begin(), identities.end());
  if (twice == identities.end()) return;
  throw IoError(Side::kInput, file, fmt::format("the picture {} is listed twice", twice->filename().string()),
                "every picture once, with its light", "remove one of the two");
}

bool is_file(const fs::path& wanted) {
  // The system would look for the part before a zero byte.
  std::error_code error;
  return wanted.native().find('\0') == std::string::npos && fs::is_regular_file(wanted, error);
}

void require_file(const fs::path& wanted, const std::string& file, const std::string& where,
                  const std::string& what) {
  if (is_file(wanted)) return;
  throw IoError(Side::kInput, file, fmt::format("{}: {} {} is not there", where, what, wanted.string()),
                "paths relative to this file");
}

StackSource read_stack_source(const fs::path& file) {
  return file.extension() == ".lp" ? read_light_positions(file) : read_olat(file);
}

}  // namespace brdfit::io
