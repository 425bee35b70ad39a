// What the first bytes of PNG and JPEG files say that OpenImageIO does not pass on.
#ifndef BRDFIT_IO_IMAGE_LAYOUT_H_
#define BRDFIT_IO_IMAGE_LAYOUT_H_

#include <filesystem>

namespace brdfit::io {

struct ImageLayout {
  // Progressive JPEG, interlaced PNG: a decoder holds the whole image before it has one row.
  bool needs_whole_image = false;
  // The file itself says how its samples are encoded: PNG chunks sRGB, gAMA, iCCP or cICP; a JPEG's profile.
  bool says_colour_space = false;
};

// Of other formats: both false. Throws IoError (kInput) when the file cannot be read, or is a JPEG that was
// cut off among its pixels, which decoders fill up with grey without a word.
ImageLayout layout_of(const std::filesystem::path& file);

}  // namespace brdfit::io

#endif  // BRDFIT_IO_IMAGE_LAYOUT_H_
