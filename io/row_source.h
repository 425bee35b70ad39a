// The rows of one picture of a stack, decoded once where that can be.
#ifndef BRDFIT_IO_ROW_SOURCE_H_
#define BRDFIT_IO_ROW_SOURCE_H_

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>

#include "io/image_reader.h"
#include "io/spill_file.h"

namespace brdfit::io {

// Rows as the file stores them. Where there is a spill file, rows are copied there as they are decoded and
// come from there the next time, so that no order of reading decodes a picture twice.
class RowSource {
 public:
  // Throws as ImageReader.
  explicit RowSource(const std::filesystem::path& file);

  const ImageHeader& header() const { return header_; }
  const std::string& name() const { return name_; }

  // A decoder of such a file holds the whole image before it has one row, so that many of them open at once
  // take more memory than a strip.
  bool needs_whole_image() const { return needs_whole_image_; }

  // spill must outlive this.
  void use_spill(SpillFile& spill);

  // As ImageReader::read_native. One thread at a time.
  void read(int first, int rows, std::span<std::byte> out);

 private:
  void decode_until(int row);

  std::string name_;
  ImageHeader header_;
  bool needs_whole_image_;
  std::optional<ImageReader> reader_;
  SpillFile* spill_ = nullptr;
  std::size_t place_ = 0;  // in the spill file
  int spilled_rows_ = 0;
};

}  // namespace brdfit::io

#endif  // BRDFIT_IO_ROW_SOURCE_H_
