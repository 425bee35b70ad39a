// Opening and reading input files, with the errors that name what is in the way.
#include "io/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace brdfit::io {
namespace {

using Side = IoError::Side;

[[noreturn]] void fail_to_open(const std::string& name, int error, std::string_view expected) {
  if (error == ENOENT || error == ENOTDIR) {
    throw IoError(Side::kInput, name, "no such file", std::string(expected), "check the name");
  }
  const std::string reason = "cannot be opened: " + std::generic_category().message(error);
  const std::string advice = error == EACCES ? "check its permissions" : "";
  throw IoError(Side::kInput, name, reason, "a file that can be read", advice);
}

}  // namespace

InputFile::InputFile(const std::filesystem::path& file, std::string_view expected) : name_(file.string()) {
  // Without O_NONBLOCK, a named pipe would keep us waiting before we can see that it is one.
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) fail_to_open(name_, errno, expected);
  struct stat status = {};
  const bool is_known = fstat(descriptor, &status) == 0;
  if (!is_known || !S_ISREG(status.st_mode)) {
    close(descriptor);
    const bool is_directory = is_known && S_ISDIR(status.st_mode);
    throw IoError(Side::kInput, name_, is_directory ? "is a directory" : "is not a regular file",
                  std::string(expected), is_directory ? "name a file in it" : "copy it to a file first");
  }
  size_ = static_cast<std::size_t>(status.st_size);
  descriptor_ = descriptor;
}

InputFile::~InputFile() {
  close(descriptor_);
}

void InputFile::read_at(std::size_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      throw IoError(Side::kInput, name_, "cannot be read: " + std::generic_category().message(errno),
                    "a file that can be read");
    }
    if (count == 0) {
      throw IoError(Side::kInput, name_, "became shorter while it was read", std::to_string(size_) + " bytes",
                    "try again when nothing writes to it");
    }
    offset += static_cast<std::size_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

}  // namespace brdfit::io
