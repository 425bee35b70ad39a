// MERL .binary files (Matusik et al. 2003): read and write.
//
// Little endian: int32 n_theta_h, n_theta_d, n_phi_d, then the planes R, G, B of that many float64. f is the
// stored value times (1, 1.15, 1.66)/1500. Negative values mean "no measurement".
#ifndef BRDFIT_IO_MERL_H_
#define BRDFIT_IO_MERL_H_

#include <cstddef>
#include <filesystem>
#include <functional>

#include "io/error.h"
#include "measured/table.h"

namespace brdfit::io {

struct MerlReadOptions {
  CellAnchor anchor = CellAnchor::kLowerEdge;
  // NaN and infinities make the file unusable; with lenient they count as "no measurement" instead.
  bool lenient = false;
};

// What reading a file found in it, beside the table.
struct MerlReadReport {
  std::size_t file_bytes = 0;
  std::size_t cells = 0;
  std::size_t invalid_cells = 0;      // at least one channel negative or, with lenient, not finite
  std::size_t non_finite_values = 0;  // single channel values; only ever > 0 with lenient
};

// Reads and checks a whole file. Throws IoError (kInput): not a regular file, unreadable, empty, a short
// header, dimensions that are zero, negative, too large or byte-swapped (big endian), planes truncated,
// trailing bytes, NaN or infinity (unless lenient), no valid cell. report may be null.
MeasuredTable read_merl(const std::filesystem::path& file, const MerlReadOptions& options = {},
                        MerlReadReport* report = nullptr);

// f at a cell, as it is to be stored; a negative channel marks the cell as not measured.
using CellValue = std::function<Rgb(int i_theta_h, int i_theta_d, int i_phi_d)>;

// Writes a file in double precision through a temporary that is then renamed. value is called once per cell,
// from several threads. Throws IoError (kOutput); std::invalid_argument if value gives NaN or infinity.
void write_merl(const std::filesystem::path& file, const Grid& grid, const CellValue& value);

// As above, for a table in memory (invalid cells become -1).
void write_merl(const std::filesystem::path& file, const MeasuredTable& table);

}  // namespace brdfit::io

#endif  // BRDFIT_IO_MERL_H_
