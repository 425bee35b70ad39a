// Maps over single pictures of a stack: how much each texel counts, or is lit, in [0, 1].
#ifndef BRDFIT_IO_PICTURE_MAPS_H_
#define BRDFIT_IO_PICTURE_MAPS_H_

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "io/frame_image.h"
#include "measured/image_stack.h"

namespace brdfit::io {

class PictureMaps {
 public:
  // files: per picture, nothing where it has no map. Throws IoError (kInput): no image, or of another size.
  PictureMaps(std::span<const std::optional<std::filesystem::path>> files, const FrameSize& size);

  bool is_any() const { return is_any_; }
  bool has(std::size_t picture) const { return maps_[picture].has_value(); }

  // The first channel of chosen pixels, integers over their largest value; empty where the picture has no
  // map. Threads may read maps of different pictures at once. Throws IoError (kInput) for a value that is
  // outside [0, 1] or not finite.
  std::vector<float> read(std::size_t picture, const PixelChoice& choice);

  // Multiplies the weights of a block of these pixels.
  void weigh(TexelBlock& block, const PixelChoice& choice);

  // Maps that are kept aside as they are decoded; all: also those whose decoder needs no whole image. make
  // is called if there is one, and returns what must outlive this.
  template <class Make>
  void use_spill(bool all, const Make& make) {
    for (auto& map : maps_) {
      if (map && (all || map->needs_whole_image())) map->use_spill(make());
    }
  }

 private:
  std::vector<std::optional<FrameImage>> maps_;
  int width_;
  bool is_any_ = false;
};

}  // namespace brdfit::io

#endif  // BRDFIT_IO_PICTURE_MAPS_H_
