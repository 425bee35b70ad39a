// Image files: PNG for eyes, EXR for values.
#ifndef BRDFIT_IO_IMAGE_FILE_H_
#define BRDFIT_IO_IMAGE_FILE_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/error.h"

namespace brdfit::io {

// Text that goes into the file's header: what the image shows, units, exposure, provenance.
using ImageMetadata = std::vector<std::pair<std::string, std::string>>;

// Interleaved 8-bit samples, 1, 3 or 4 channels, sRGB-encoded, rows from top to bottom.
struct PixelView8 {
  int width = 0;
  int height = 0;
  int channels = 3;
  std::span<const std::uint8_t> samples;  // width * height * channels
};

// Interleaved float samples with a name for each channel ("R", "G", "B", "A"), rows from top to bottom.
struct PixelViewFloat {
  int width = 0;
  int height = 0;
  std::vector<std::string> channels;
  std::span<const float> samples;  // width * height * channels.size()
};

// A PNG file's bytes. Deterministic: no date. Throws std::invalid_argument if sizes disagree,
// std::runtime_error when the library cannot encode.
std::vector<unsigned char> encode_png(const PixelView8& pixels, const ImageMetadata& metadata = {});

// An EXR file's bytes: 32-bit float, ZIP. Throws as encode_png, and std::invalid_argument for NaN or
// infinity.
std::vector<unsigned char> encode_exr(const PixelViewFloat& pixels, const ImageMetadata& metadata = {});

// Writes bytes through a temporary that is then renamed. Throws IoError (kOutput).
void write_bytes(const std::filesystem::path& file, std::span<const unsigned char> bytes);
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace brdfit::io

#endif  // BRDFIT_IO_IMAGE_FILE_H_
