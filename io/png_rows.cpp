// Runs of rows through libpng.
#include "io/png_rows.h"

#include <png.h>
#include <zlib.h>

#include <csetjmp>
#include <exception>
#include <stdexcept>
#include <utility>

#include "io/atomic_file.h"

namespace brdfit::io {

struct PngRowWriter::State {
  explicit State(const std::filesystem::path& path) : name(path.string()), file(path) {}
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { png_destroy_write_struct(&png, &info); }
  std::string name;
  AtomicFile file;
  png_structp png = nullptr;
  png_infop info = nullptr;
  int width = 0;
  int height = 0;
  int channels = 0;
  int done = 0;
  std::exception_ptr failure;  // of the file, kept while libpng jumps
};

namespace {

// No exception may pass through libpng: it is kept, and libpng jumps.
template <class State>
void write_bytes_of(png_structp png, png_bytep data, png_size_t size) {
  auto& state = *static_cast<State*>(png_get_io_ptr(png));
  try {
    state.file.write(std::as_bytes(std::span(data, size)));
    return;
  } catch (...) {
    state.failure = std::current_exception();
  }
  png_error(png, "writing failed");
}

// libpng jumps here from its errors, so nothing in these functions needs a destructor.
bool begin(png_structp png, png_infop info, int width, int height, int colour_type,
           PngCompression compression) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8, colour_type,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  const bool is_plain = compression == PngCompression::kNone;
  png_set_filter(png, PNG_FILTER_TYPE_BASE, is_plain ? PNG_FILTER_NONE : PNG_FILTER_UP);
  png_set_compression_level(png, is_plain ? 0 : 1);
  png_set_compression_strategy(png, Z_HUFFMAN_ONLY);
  png_write_info(png, info);
  return true;
}

bool write_rows(png_structp png, const std::uint8_t* samples, std::size_t stride, int rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  for (int y = 0; y < rows; ++y) png_write_row(png, samples + static_cast<std::size_t>(y) * stride);
  return true;
}

bool end(png_structp png) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_write_end(png, nullptr);
  return true;
}

template <class State>
void require(bool good, const State& state) {
  if (good) return;
  if (state.failure) std::rethrow_exception(state.failure);
  throw IoError(IoError::Side::kOutput, state.name, "cannot be encoded", "a PNG file");
}

}  // namespace

PngRowWriter::PngRowWriter(const std::filesystem::path& file, int width, int height, int channels,
                           PngCompression compression) {
  if (width <= 0 || height <= 0 || (channels != 1 && channels != 3 && channels != 4)) {
    throw std::invalid_argument("PNG: sizes must be positive, with 1, 3 or 4 channels");
  }
  state_ = std::make_unique<State>(file);
  State& s = *state_;
  s.width = width;
  s.height = height;
  s.channels = channels;
  s.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  s.info = s.png != nullptr ? png_create_info_struct(s.png) : nullptr;
  const int colour_type = channels == 1   ? PNG_COLOR_TYPE_GRAY
                          : channels == 3 ? PNG_COLOR_TYPE_RGB
                                          : PNG_COLOR_TYPE_RGB_ALPHA;
  if (s.info != nullptr) png_set_write_fn(s.png, &s, write_bytes_of<State>, nullptr);
  require(s.info != nullptr && begin(s.png, s.info, width, height, colour_type, compression), s);
}

PngRowWriter::~PngRowWriter() = default;

void PngRowWriter::write(std::span<const std::uint8_t> samples, int rows) {
  State& s = *state_;
  const std::size_t stride = static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.channels);
  if (rows < 0 || s.done + rows > s.height || samples.size() != stride * static_cast<std::size_t>(rows)) {
    throw std::invalid_argument("PNG: rows that the file has no place for");
  }
  require(write_rows(s.png, samples.data(), stride, rows), s);
  s.done += rows;
}

void PngRowWriter::commit() {
  State& s = *state_;
  if (s.done != s.height) throw std::invalid_argument("PNG: rows are missing");
  require(end(s.png), s);
  s.file.commit();
}

}  // namespace brdfit::io
