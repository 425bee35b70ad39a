// The images beside a stack's pictures: dark, flat, mask, normals, albedo.
#ifndef BRDFIT_IO_STACK_FRAMES_H_
#define BRDFIT_IO_STACK_FRAMES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/pixel_converter.h"
#include "io/row_source.h"
#include "io/stack_source.h"

namespace brdfit::io {

// Pixels that are chosen from rows in order: whole rows, or some pixels of each.
struct PixelChoice {
  int first_row = 0;
  int rows = 0;
  // Ascending indices y * width + x; empty: all of the rows.
  std::span<const std::uint32_t> texels;
};

// What the frames say about chosen pixels, as planes; each is empty where the stack has no such frame.
struct FrameValues {
  std::vector<float> dark;            // [3][pixel], linear
  std::vector<float> gain;            // [3][pixel]
  std::vector<float> normals;         // [3][pixel], unit
  std::vector<float> albedo;          // [3][pixel], linear
  std::vector<std::uint8_t> blocked;  // [pixel]: not 0 where the texel cannot be used
  std::size_t masked_texels = 0;
  std::size_t bad_texels = 0;
};

class StackFrames {
 public:
  // transfer: of dark and flat frames; nothing: as each says itself. Throws IoError (kInput): see FileStack.
  StackFrames(const StackSource& source, const std::optional<Transfer>& transfer, int width, int height);

  // In order from top to bottom.
  FrameValues read(const PixelChoice& choice);

  bool has_normals() const { return normals_.has_value(); }
  bool has_albedo() const { return albedo_.has_value(); }

 private:
  // An image with its conversion to light.
  struct Frame {
    RowSource rows;
    PixelConverter converter;
  };

  static std::vector<float> values_of(Frame& frame, const PixelChoice& choice);
  void measure_flat(int height);
  void correct(FrameValues& values, const PixelChoice& choice);
  void add_normals(FrameValues& values, const PixelChoice& choice);

  int width_;
  std::optional<Frame> dark_, flat_, mask_, normals_, albedo_;
  std::array<double, 3> flat_mean_ = {1.0, 1.0, 1.0};
};

// Samples of chosen pixels of an image, as the file stores them.
std::vector<std::byte> samples_of(RowSource& rows, const PixelChoice& choice);

// The transfer of an image that nobody else says anything about.
Transfer own_transfer(const RowSource& rows);

// Throws IoError (kInput) unless the image has that size.
void require_size(const RowSource& rows, int width, int height, const std::string& as_what);

}  // namespace brdfit::io

#endif  // BRDFIT_IO_STACK_FRAMES_H_
