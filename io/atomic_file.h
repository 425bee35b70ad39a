// Writing files so that a reader never sees half of one.
#ifndef BRDFIT_IO_ATOMIC_FILE_H_
#define BRDFIT_IO_ATOMIC_FILE_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace brdfit::io {

// A file that appears under its name only when commit() succeeds: bytes go to a temporary beside it, which is
// renamed at the end and removed if the object dies first. Missing parent folders are not made.
class AtomicFile {
 public:
  // Throws IoError (kOutput) when the temporary cannot be made.
  explicit AtomicFile(std::filesystem::path file);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  // Throws IoError (kOutput): no space, and the like.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  // At an offset from the file's beginning, for formats that fill in a table when they end.
  void write_at(std::uint64_t offset_bytes, std::span<const std::byte> bytes);

  // Lets the system begin to write what it has been given, so that commit() finds less to wait for. A hint:
  // never an error.
  void begin_flush();

  // Flushes to the disk and renames. Throws IoError (kOutput).
  void commit();

 private:
  std::filesystem::path file_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
};

}  // namespace brdfit::io

#endif  // BRDFIT_IO_ATOMIC_FILE_H_
