// The images beside a stack's pictures: dark, flat, mask, normals, albedo.
#ifndef BRDFIT_IO_STACK_FRAMES_H_
#define BRDFIT_IO_STACK_FRAMES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/frame_image.h"
#include "io/stack_source.h"

namespace brdfit::io {

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

  // The same in two parts, so that pictures can be read beside the second: what they are corrected by and the
  // mask; then normals and albedo.
  FrameValues read_correction(const PixelChoice& choice);
  void read_surface(FrameValues& values, const PixelChoice& choice);

  bool has_normals() const { return normals_.has_value(); }
  bool has_albedo() const { return albedo_.has_value(); }

 private:
  void measure_flat(int height);
  void correct(FrameValues& values, const PixelChoice& choice);
  void add_normals(FrameValues& values, const PixelChoice& choice);

  int width_;
  std::optional<FrameImage> dark_, flat_, mask_, normals_, albedo_;
  std::array<double, 3> flat_mean_ = {1.0, 1.0, 1.0};
};

}  // namespace brdfit::io

#endif  // BRDFIT_IO_STACK_FRAMES_H_
