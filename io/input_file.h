// A file opened for reading, checked to be one that can be read.
#ifndef BRDFIT_IO_INPUT_FILE_H_
#define BRDFIT_IO_INPUT_FILE_H_

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "io/error.h"

namespace brdfit::io {

// A regular file, open until the object dies.
class InputFile {
 public:
  // expected: what kind of file, for messages ("a MERL .binary file"). Throws IoError (kInput): no such file,
  // no permission, a directory, a pipe or device.
  InputFile(const std::filesystem::path& file, std::string_view expected);
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();

  const std::string& name() const { return name_; }
  std::size_t size() const { return size_; }

  // Fills bytes from a place in the file; may be called from several threads at once. Throws IoError (kInput)
  // when reading fails or the file has become shorter than size().
  void read_at(std::size_t offset, std::span<std::byte> bytes) const;

 private:
  std::string name_;
  std::size_t size_ = 0;
  int descriptor_ = -1;
};

}  // namespace brdfit::io

#endif  // BRDFIT_IO_INPUT_FILE_H_
