// One image beside a stack's pictures, with its conversion: a dark frame, a mask, a weight map.
#ifndef BRDFIT_IO_FRAME_IMAGE_H_
#define BRDFIT_IO_FRAME_IMAGE_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/pixel_converter.h"
#include "io/row_source.h"
#include "io/transfer.h"

namespace brdfit::io {

// Pixels that are chosen from rows in order: whole rows, or some pixels of each.
struct PixelChoice {
  int first_row = 0;
  int rows = 0;
  // Ascending indices y * width + x; empty: all of the rows.
  std::span<const std::uint32_t> texels;

  std::size_t count(int width) const;
};

// Samples of chosen pixels of an image, as the file stores them.
std::vector<std::byte> samples_of(RowSource& rows, const PixelChoice& choice);

// The transfer of an image that nobody else says anything about.
Transfer own_transfer(const RowSource& rows);

// Throws IoError (kInput) unless the image has that size.
void require_size(const RowSource& rows, int width, int height, const std::string& as_what);

// The size that all images of a stack have, and the name of one that has it.
struct FrameSize {
  int width = 0;
  int height = 0;
  std::string as_what;
};

class FrameImage {
 public:
  // transfer: how codes become light; nothing: as the file says itself. Throws IoError (kInput): no image, or
  // of another size.
  FrameImage(const std::filesystem::path& file, const std::optional<Transfer>& transfer,
             const FrameSize& size);

  // [3][pixel]. unusable: appended to; those that are not finite are 0.
  std::vector<float> values(const PixelChoice& choice, Unusable& unusable);
  std::vector<float> values(const PixelChoice& choice);
  // [3][pixel] of an image of normals, where integers hold n / 2 + 1/2: unit, or 0 where there is none.
  std::vector<float> unit_vectors(const PixelChoice& choice);

  SampleType type() const { return rows_.header().type; }
  const std::string& name() const { return rows_.name(); }
  bool needs_whole_image() const { return rows_.needs_whole_image(); }
  void use_spill(SpillFile& spill) { rows_.use_spill(spill); }

 private:
  RowSource rows_;
  PixelConverter converter_;
};

}  // namespace brdfit::io

#endif  // BRDFIT_IO_FRAME_IMAGE_H_
