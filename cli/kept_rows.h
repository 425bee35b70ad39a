// Finished strips of a bake, kept in a file until the asset is complete.
#ifndef BRDFIT_CLI_KEPT_ROWS_H_
#define BRDFIT_CLI_KEPT_ROWS_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/asset_files.h"
#include "io/image_stack_file.h"

namespace brdfit::cli {

// A strip as it goes to the asset's files, with what it adds to the counts of the bake.
struct KeptStrip {
  AssetRows rows;  // without Surface::state, which no file holds
  io::PixelCounts pixels;
  std::size_t cut_codes = 0;
};

// A file to which strips are appended, each with its checksums; nothing is flushed to the disk. What follows
// the last strip that is whole is cut off when the file is opened again.
class KeptRows {
 public:
  // key: what the strips are of; those of another key are thrown away. Throws io::IoError (kOutput).
  KeptRows(const std::filesystem::path& file, const std::string& key);
  KeptRows(const KeptRows&) = delete;
  KeptRows& operator=(const KeptRows&) = delete;
  ~KeptRows();

  // Rows of all strips that are kept.
  int total() const { return total_; }
  // Rows of the strip that begins at this one; 0 where none does.
  int rows_at(int first_row) const;
  // The first row at or after this one that begins a strip; `end` where none does.
  int next(int row, int end) const;

  // The strip that begins there. Throws io::IoError (kOutput) when it cannot be read.
  KeptStrip read(int first_row) const;
  // Throws io::IoError (kOutput): no space, and the like; std::invalid_argument for a strip that is there.
  void append(int first_row, int rows, const KeptStrip& strip);
  // What append() would write for the strip, about.
  static std::size_t bytes_of(const KeptStrip& strip);

 private:
  struct Place {
    int rows = 0;
    std::size_t offset = 0;  // of its head
  };
  struct Head;

  void scan();
  bool read_head(std::size_t offset, Head& head) const;
  void read_at(std::size_t offset, std::span<std::byte> bytes) const;
  void write_at(std::size_t offset, std::span<const std::byte> bytes);
  [[noreturn]] void fail(const char* what) const;

  std::string name_;
  int descriptor_ = -1;
  std::size_t size_ = 0;  // of the file
  std::size_t end_ = 0;   // of the last whole strip
  int total_ = 0;
  std::map<int, Place> places_;
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_KEPT_ROWS_H_
