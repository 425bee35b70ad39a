// PNG files of data (codes, masks), written by runs of rows. Not for pictures: nothing is said of colour
// spaces.
#ifndef BRDFIT_IO_PNG_ROWS_H_
#define BRDFIT_IO_PNG_ROWS_H_

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "io/error.h"

namespace brdfit::io {

// kQuick: differences to the row above in Huffman codes; a longer search finds little more in data.
enum class PngCompression { kQuick, kNone };

// Writes 8-bit samples from top to bottom through a temporary that commit() renames.
class PngRowWriter {
 public:
  // channels: 1, 3 or 4. Throws IoError (kOutput), std::invalid_argument for sizes that cannot be.
  PngRowWriter(const std::filesystem::path& file, int width, int height, int channels,
               PngCompression compression = PngCompression::kQuick);
  ~PngRowWriter();

  // The next rows, interleaved. Throws IoError (kOutput), std::invalid_argument for too many rows.
  void write(std::span<const std::uint8_t> samples, int rows);
  // After the last row. Throws IoError (kOutput); std::invalid_argument when rows are missing.
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace brdfit::io

#endif  // BRDFIT_IO_PNG_ROWS_H_
