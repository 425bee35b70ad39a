// Temporary, flush, rename.
#include "io/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "io/error.h"

namespace brdfit::io {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, std::string_view action, int error) {
  const std::string reason = fmt::format("cannot be {}: {}", action, std::generic_category().message(error));
  std::string advice;
  if (error == ENOENT || error == ENOTDIR) advice = "make the folder first";
  if (error == EACCES || error == EROFS) advice = "check the permissions of the folder";
  if (error == ENOSPC || error == EDQUOT) advice = "free some space";
  throw IoError(IoError::Side::kOutput, file.string(), reason, "a place that can be written to", advice);
}

// Renaming onto a device or a folder would destroy it or fail at the very end.
void require_replaceable(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return;
  const bool is_directory = std::filesystem::is_directory(status);
  throw IoError(IoError::Side::kOutput, file.string(),
                is_directory ? "is a directory" : "is not a regular file", "a file name",
                is_directory ? "name a file in it" : "write to a file instead");
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path file) : file_(std::move(file)) {
  require_replaceable(file_);
  // A name of our own, made with the permissions that the umask leaves (mkstemp's would be the owner's
  // alone).
  for (int attempt = 0; descriptor_ < 0; ++attempt) {
    temporary_ = file_.parent_path() / fmt::format(".brdfit-{}-{}.tmp", getpid(), attempt);
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST && errno != EINTR) fail(file_, "written", errno);
  }
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(file_, "written", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void AtomicFile::write(std::string_view text) {
  write(std::as_bytes(std::span(text.data(), text.size())));
}

void AtomicFile::write_at(std::uint64_t offset_bytes, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset_bytes));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(file_, "written", errno);
    offset_bytes += static_cast<std::uint64_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void AtomicFile::begin_flush() {
  static_cast<void>(sync_file_range(descriptor_, 0, 0, SYNC_FILE_RANGE_WRITE));
}

void AtomicFile::commit() {
  if (fsync(descriptor_) != 0) fail(file_, "flushed", errno);
  if (close(std::exchange(descriptor_, -1)) != 0) fail(file_, "closed", errno);
  if (rename(temporary_.c_str(), file_.c_str()) != 0) fail(file_, "put in place", errno);
  temporary_.clear();
}

}  // namespace brdfit::io
