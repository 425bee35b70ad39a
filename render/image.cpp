// Pictures in memory.
#include "render/image.h"

namespace brdfit::render {

Image::Image(int image_width, int image_height) : width(image_width), height(image_height) {
  rgb.assign(3 * pixel_count(), 0.0F);
  state.assign(pixel_count(), PixelState::kValue);
}

std::array<std::size_t, kPixelStateCount> Image::counts() const {
  std::array<std::size_t, kPixelStateCount> result{};
  for (const PixelState s : state) ++result[static_cast<std::size_t>(s)];
  return result;
}

Picture::Picture(int picture_width, int picture_height) : width(picture_width), height(picture_height) {
  rgb.assign(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
}

}  // namespace brdfit::render
