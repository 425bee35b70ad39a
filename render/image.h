// Pictures in memory: values of f or radiance with the state of every pixel, and 8-bit pictures for eyes.
#ifndef BRDFIT_RENDER_IMAGE_H_
#define BRDFIT_RENDER_IMAGE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace brdfit::render {

// What a pixel holds. Only kValue has a value; the others are shown as what they are, never as black.
enum class PixelState : std::uint8_t {
  kValue,
  kOutside,       // nothing to see: beside the sphere or the patch
  kBelowHorizon,  // wi or wo is not above the surface, so f is not defined
  kUnmeasured,    // the table holds "no measurement"
  kNotFinite,     // the table held NaN or infinity
  kNegative,      // the table held a negative value in some, not in all channels
};
inline constexpr std::size_t kPixelStateCount = 6;

// Linear Rec.709 values, rows from top to bottom.
struct Image {
  Image() = default;
  Image(int image_width, int image_height);

  std::size_t pixel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  // Pixels of each state.
  std::array<std::size_t, kPixelStateCount> counts() const;

  int width = 0;
  int height = 0;
  std::vector<float> rgb;         // 3 per pixel; 0 where the state is not kValue
  std::vector<PixelState> state;  // 1 per pixel
};

// 8-bit RGB, encoded for a display, rows from top to bottom.
struct Picture {
  Picture() = default;
  Picture(int picture_width, int picture_height);

  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  // 3 per pixel
};

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_IMAGE_H_
