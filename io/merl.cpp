// MERL .binary files: checked in full while they are read, written through a temporary.
#include "io/merl.h"

#include <fmt/format.h>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "io/atomic_file.h"
#include "io/input_file.h"

namespace brdfit::io {
namespace {

static_assert(std::endian::native == std::endian::little,
              "MERL files are little endian and read as they are");

using Header = std::array<std::int32_t, 3>;
constexpr std::size_t kHeaderBytes = sizeof(Header);
constexpr std::array<double, 3> kScale = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};
constexpr std::array<const char*, 3> kChannelNames = {"red", "green", "blue"};

[[noreturn]] void refuse(const InputFile& input, const std::string& found, const std::string& expected,
                         const std::string& advice) {
  throw IoError(IoError::Side::kInput, input.name(), found, expected, advice);
}

std::string text_of(const Header& header) {
  return fmt::format("{} x {} x {}", header[0], header[1], header[2]);
}

Header byte_swapped(Header header) {
  for (std::int32_t& n : header) {
    n = static_cast<std::int32_t>(__builtin_bswap32(static_cast<std::uint32_t>(n)));
  }
  return header;
}

// A dimension below 2^16 is not below 2^16 with its bytes swapped, and no table has three dimensions that
// large.
bool is_plausible(const Header& header) {
  return std::all_of(header.begin(), header.end(), [](std::int32_t n) { return n > 0 && n < 65536; });
}

Header read_header(const InputFile& input) {
  const std::string expected = "a MERL .binary file: three int32 dimensions, then three planes of float64";
  if (input.size() == 0) refuse(input, "the file is empty", expected, "copy it again from its source");
  if (input.size() < kHeaderBytes) {
    refuse(input, fmt::format("{} bytes, less than a header of {}", input.size(), kHeaderBytes), expected,
           "copy it again from its source");
  }
  Header header = {};
  input.read_at(0, std::as_writable_bytes(std::span(header)));
  if (is_plausible(byte_swapped(header))) {
    refuse(input, fmt::format("big-endian dimensions {}", text_of(byte_swapped(header))),
           "a little-endian file", "swap the bytes of every number in it");
  }
  if (std::any_of(header.begin(), header.end(), [](std::int32_t n) { return n <= 0; })) {
    refuse(input, fmt::format("dimensions {}", text_of(header)), "three positive numbers",
           "the header is damaged, or this is no MERL .binary file");
  }
  return header;
}

// The header's grid, once the size of the file agrees with it: before that, nothing is allocated.
Grid checked_grid(const InputFile& input, CellAnchor anchor) {
  const Header header = read_header(input);
  const Grid grid{header[0], header[1], header[2], anchor};
  constexpr std::size_t kCellBytes = 3 * sizeof(double);
  constexpr std::size_t kMostCells = (std::numeric_limits<std::size_t>::max() >> 1) / kCellBytes;
  const auto rows = static_cast<std::size_t>(grid.n_theta_h) * static_cast<std::size_t>(grid.n_theta_d);
  if (rows > kMostCells / static_cast<std::size_t>(grid.n_phi_d)) {
    refuse(input, fmt::format("dimensions {}, more cells than any file can hold", text_of(header)),
           "dimensions like 90 x 90 x 180", "the header is damaged, or this is no MERL .binary file");
  }
  const std::size_t bytes = kHeaderBytes + kCellBytes * grid.cell_count();
  const std::string expected = fmt::format("{} bytes for dimensions {}", bytes, text_of(header));
  if (input.size() < bytes) {
    refuse(input, fmt::format("truncated: {} bytes", input.size()), expected,
           "copy it again from its source");
  }
  if (input.size() > bytes) {
    refuse(input, fmt::format("trailing bytes: {} bytes", input.size()), expected,
           "the header is damaged, or this is no MERL .binary file");
  }
  return grid;
}

// f of stored values, -1 where they are negative. Returns whether any may not be finite, or be too large for
// a float. Works on the bits of the floats, without branches, because only so is it vectorised.
bool convert(const double* __restrict stored, double scale, float* __restrict f, std::size_t count) {
  constexpr std::uint32_t kMagnitude = 0x7fffffffU;
  constexpr std::uint32_t kMinusOne = 0xbf800000U;
  constexpr std::uint32_t kToSign = 0x00800000U;  // carries the exponent of infinity and NaN into the sign
  std::uint32_t odd = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double scaled = stored[k] * scale + 0.0;  // -0 becomes 0: it is not negative
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(scaled));
    const auto negative =
        static_cast<std::uint32_t>(static_cast<std::int32_t>(bits) >> 31);  // all bits or none
    odd |= (bits & kMagnitude) + kToSign;
    f[k] = std::bit_cast<float>((bits & ~negative) | (kMinusOne & negative));
  }
  return odd >> 31 != 0;
}

// The values of a run that are not finite.
struct NonFinite {
  std::size_t count = 0;
  std::size_t first = 0;  // its place in the planes
  double first_value = 0.0;
};

// Counts what convert() objected to and leaves it to the table as NaN.
NonFinite mark_non_finite(const double* stored, float* f, std::size_t count, std::size_t begin) {
  NonFinite found;
  for (std::size_t k = 0; k < count; ++k) {
    if (std::isfinite(stored[k]) && std::isfinite(f[k])) continue;
    f[k] = std::numeric_limits<float>::quiet_NaN();
    if (found.count++ == 0) {
      found.first = begin + k;
      found.first_value = stored[k];
    }
  }
  return found;
}

// The planes of f, read and converted piece by piece so that the doubles never leave the cache.
class PlaneReader {
 public:
  PlaneReader(const InputFile& input, const Grid& grid)
      : input_(input),
        cells_(grid.cell_count()),
        chunks_per_plane_((cells_ + kChunk - 1) / kChunk),
        found_(3 * chunks_per_plane_),
        planes_(3 * cells_) {}

  void read() {
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, found_.size()),
                              [this](const oneapi::tbb::blocked_range<std::size_t>& range) {
                                const auto buffer = std::make_unique_for_overwrite<double[]>(kChunk);
                                for (std::size_t k = range.begin(); k < range.end(); ++k) {
                                  read_chunk(k, buffer.get());
                                }
                              });
  }

  // Over the whole file, in its order.
  NonFinite non_finite() const {
    NonFinite all;
    for (const NonFinite& chunk : found_) {
      if (all.count == 0) all = {0, chunk.first, chunk.first_value};
      all.count += chunk.count;
    }
    return all;
  }

  std::vector<float> take_planes() { return std::move(planes_); }

 private:
  static constexpr std::size_t kChunk = 8192;  // values: 64 KiB of doubles

  void read_chunk(std::size_t chunk, double* buffer) {
    const std::size_t plane = chunk / chunks_per_plane_;
    const std::size_t first_cell = chunk % chunks_per_plane_ * kChunk;
    const std::size_t count = std::min(kChunk, cells_ - first_cell);
    const std::size_t begin = plane * cells_ + first_cell;
    input_.read_at(kHeaderBytes + begin * sizeof(double), std::as_writable_bytes(std::span(buffer, count)));
    float* f = planes_.data() + begin;
    if (convert(buffer, kScale[plane], f, count)) found_[chunk] = mark_non_finite(buffer, f, count, begin);
  }

  const InputFile& input_;
  std::size_t cells_;
  std::size_t chunks_per_plane_;
  std::vector<NonFinite> found_;  // of every chunk
  std::vector<float> planes_;
};

void refuse_non_finite(const InputFile& input, const Grid& grid, const NonFinite& found) {
  const std::size_t cell = found.first % grid.cell_count();
  const auto columns = static_cast<std::size_t>(grid.n_phi_d);
  const auto rows = static_cast<std::size_t>(grid.n_theta_d);
  refuse(input,
         fmt::format("{} of {} values are not finite, the first is {} in the {} plane at theta_h {}, "
                     "theta_d {}, phi_d {}",
                     found.count, 3 * grid.cell_count(), found.first_value,
                     kChannelNames[found.first / grid.cell_count()], cell / columns / rows,
                     cell / columns % rows, cell % columns),
         "finite single-precision numbers", "repair the file, or take them as not measured with --lenient");
}

// One cell's stored values. Not measured is -1 in all channels.
Rgb stored_value(const Rgb& f) {
  Rgb stored = {};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    stored[channel] = f[channel] / kScale[channel];
    if (!std::isfinite(stored[channel])) {
      throw std::invalid_argument(fmt::format("write_merl: a cell's value is {}", f[channel]));
    }
  }
  const bool is_measured = f[0] >= 0.0 && f[1] >= 0.0 && f[2] >= 0.0;
  return is_measured ? stored : Rgb{-1.0, -1.0, -1.0};
}

void fill_row(const Grid& grid, int i_theta_h, const CellValue& value, std::vector<double>& planes) {
  const std::size_t cells = grid.cell_count();
  for (int i_theta_d = 0; i_theta_d < grid.n_theta_d; ++i_theta_d) {
    for (int i_phi_d = 0; i_phi_d < grid.n_phi_d; ++i_phi_d) {
      const Rgb stored = stored_value(value(i_theta_h, i_theta_d, i_phi_d));
      const std::size_t cell = grid.index(i_theta_h, i_theta_d, i_phi_d);
      for (std::size_t channel = 0; channel < 3; ++channel) planes[channel * cells + cell] = stored[channel];
    }
  }
}

}  // namespace

MeasuredTable read_merl(const std::filesystem::path& file, const MerlReadOptions& options,
                        MerlReadReport* report) {
  const InputFile input(file, "a MERL .binary file");
  const Grid grid = checked_grid(input, options.anchor);
  PlaneReader reader(input, grid);
  reader.read();
  const NonFinite non_finite = reader.non_finite();
  if (non_finite.count > 0 && !options.lenient) refuse_non_finite(input, grid, non_finite);

  MeasuredTable table(grid, reader.take_planes());
  const std::size_t cells = grid.cell_count();
  if (table.valid_count() == 0) {
    refuse(input, fmt::format("none of its {} cells holds a measurement", cells),
           "values that are not negative", "there is nothing to fit in this file");
  }
  if (report != nullptr) *report = {input.size(), cells, cells - table.valid_count(), non_finite.count};
  return table;
}

void write_merl(const std::filesystem::path& file, const Grid& grid, const CellValue& value) {
  if (grid.n_theta_h <= 0 || grid.n_theta_d <= 0 || grid.n_phi_d <= 0) {
    throw std::invalid_argument("write_merl: a dimension is not positive");
  }
  AtomicFile output(file);  // first, so that a wrong name fails before the work
  std::vector<double> planes(3 * grid.cell_count());
  oneapi::tbb::parallel_for(0, grid.n_theta_h,
                            [&](int i_theta_h) { fill_row(grid, i_theta_h, value, planes); });
  const Header header = {grid.n_theta_h, grid.n_theta_d, grid.n_phi_d};
  output.write(std::as_bytes(std::span(header)));
  output.write(std::as_bytes(std::span(planes)));
  output.commit();
}

void write_merl(const std::filesystem::path& file, const MeasuredTable& table) {
  const Grid& grid = table.grid();
  write_merl(file, grid, [&](int i_theta_h, int i_theta_d, int i_phi_d) {
    return table.value(grid.index(i_theta_h, i_theta_d, i_phi_d));
  });
}

}  // namespace brdfit::io
