// EXR files of named planes, written and read by runs of rows, for pictures that do not fit into memory.
#ifndef BRDFIT_IO_EXR_ROWS_H_
#define BRDFIT_IO_EXR_ROWS_H_

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/error.h"
#include "io/image_file.h"

namespace brdfit::io {

enum class ExrDepth { kHalf, kFloat };
// ZIP takes a hundred times as long as writing the bytes, and of measured floats it saves a few percent.
enum class ExrCompression { kNone, kZip };

// Writes planes from top to bottom through a temporary that commit() renames.
class ExrRowWriter {
 public:
  // channels: names, each its own. Throws IoError (kOutput); std::invalid_argument for names or sizes that
  // cannot be.
  ExrRowWriter(const std::filesystem::path& file, int width, int height, std::vector<std::string> channels,
               ExrDepth depth, const ImageMetadata& metadata = {},
               ExrCompression compression = ExrCompression::kZip);
  ~ExrRowWriter();

  // The next rows: planes [channel][row][column]. Halves are rounded to nearest; what a half cannot hold is
  // cut to the largest that it can, and counted. Throws IoError (kOutput), std::invalid_argument for NaN,
  // infinity or too many rows.
  void write(std::span<const float> planes, int rows);
  // After the last row. Throws IoError (kOutput); std::invalid_argument when rows are missing.
  void commit();
  std::size_t cut_values() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Reads planes by name.
class ExrRowReader {
 public:
  // Throws IoError (kInput): not there, not an EXR, a channel that is missing.
  ExrRowReader(const std::filesystem::path& file, std::vector<std::string> channels);
  ~ExrRowReader();

  int width() const;
  int height() const;
  // Rows [first, first + rows), planes [channel][row][column]. Throws IoError (kInput), also for values that
  // are not finite; std::invalid_argument for rows outside.
  std::vector<float> read(int first_row, int rows);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace brdfit::io

#endif  // BRDFIT_IO_EXR_ROWS_H_
