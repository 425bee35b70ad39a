// Temporary bytes on disk.
#include "io/spill_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

namespace brdfit::io {
namespace {

[[noreturn]] void fail(const std::string& folder, const std::string& what) {
  throw IoError(IoError::Side::kOutput, folder, what + ": " + std::generic_category().message(errno),
                "room for decoded pictures", "name another folder for temporary files");
}

}  // namespace

SpillFile::SpillFile(const std::filesystem::path& folder) : folder_(folder.string()) {
  descriptor_ = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor_ >= 0) return;
  // File systems without nameless files.
  std::string name = (folder / "brdfit-spill-XXXXXX").string();
  descriptor_ = mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail(folder_, "no temporary file can be made");
  unlink(name.c_str());
}

SpillFile::~SpillFile() {
  close(descriptor_);
}

void SpillFile::write_at(std::size_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail(folder_, "a temporary file cannot be written");
    offset += static_cast<std::size_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void SpillFile::read_at(std::size_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail(folder_, "a temporary file cannot be read");
    offset += static_cast<std::size_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

}  // namespace brdfit::io
