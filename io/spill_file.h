// A nameless temporary file for bytes that would not fit into memory.
#ifndef BRDFIT_IO_SPILL_FILE_H_
#define BRDFIT_IO_SPILL_FILE_H_

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <span>

#include "io/error.h"

namespace brdfit::io {

// Gone when the object or the process dies. Places may be written and read from several threads at once.
class SpillFile {
 public:
  // folder: where there is room. Throws IoError (kOutput) when no file can be made there.
  explicit SpillFile(const std::filesystem::path& folder);
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;
  ~SpillFile();

  // The place of so many bytes that nobody else has.
  std::size_t reserve(std::size_t bytes) { return size_.fetch_add(bytes); }

  // Throw IoError (kOutput): no space, and the like.
  void write_at(std::size_t offset, std::span<const std::byte> bytes);
  void read_at(std::size_t offset, std::span<std::byte> bytes) const;

 private:
  std::string folder_;
  int descriptor_ = -1;
  std::atomic<std::size_t> size_{0};
};

}  // namespace brdfit::io

#endif  // BRDFIT_IO_SPILL_FILE_H_
