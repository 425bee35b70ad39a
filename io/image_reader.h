// Image files of any kind that OpenImageIO reads and writes, at their full bit depth.
//
// OpenImageIO and what it brings take a program 0.13 s to load, so it is linked by a module of its own
// (brdfit_images.so), which is opened when the first image is.
#ifndef BRDFIT_IO_IMAGE_READER_H_
#define BRDFIT_IO_IMAGE_READER_H_

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "io/error.h"

namespace brdfit::io {

// How a file stores a sample. Other types (32-bit integers, doubles, packed bits) are read as kFloat.
enum class SampleType { kUint8, kUint16, kHalf, kFloat };

std::size_t bytes_of(SampleType type);
std::string name_of(SampleType type);  // "8 bit", "16 bit", "half", "float"

// What a file says of itself.
struct ImageHeader {
  int width = 0;
  int height = 0;
  int channels = 0;
  SampleType type = SampleType::kUint8;
  std::string format;         // OpenImageIO's name of it: "jpeg", "openexr"
  std::string colour_space;   // as OpenImageIO names it ("sRGB", "Linear", "Gamma2.2"); may be its own guess
  bool is_scanline = true;    // rows of a tiled file may be read in any order at no more cost
  bool is_compressed = true;  // rows out of order may mean decoding from the beginning

  std::size_t row_samples() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  }
  std::size_t row_bytes() const { return row_samples() * bytes_of(type); }
};

// Loads the module now, for whoever measures time: else the first image does. Throws IoError (kInput): it is
// missing.
void load_image_module();

// An open image. Rows are numbered from the top; samples are interleaved. Reading from top to bottom decodes
// the file once; a step back may decode it again from the beginning. One thread at a time.
class ImageReader {
 public:
  // Throws IoError (kInput): no such file, no image, several images deep (volumes), the module missing.
  explicit ImageReader(const std::filesystem::path& file);
  ImageReader(ImageReader&& other) noexcept;
  ImageReader& operator=(ImageReader&& other) noexcept;
  ~ImageReader();

  const std::string& name() const { return name_; }
  const ImageHeader& header() const { return header_; }

  // Rows [first, first + rows) as the file stores them; out holds rows * header().row_bytes() bytes. Throws
  // IoError (kInput) when the file is damaged, std::invalid_argument for rows outside or another size.
  void read_native(int first, int rows, std::span<std::byte> out);

  // As floats: integers over their largest value. out holds rows * header().row_samples().
  void read_floats(int first, int rows, std::span<float> out);

 private:
  void read(int first, int rows, SampleType type, std::span<std::byte> out);

  std::string name_;
  ImageHeader header_;
  void* image_ = nullptr;  // the module's
};

// Interleaved samples of a picture to be written.
struct ImagePixels {
  int width = 0;
  int height = 0;
  int channels = 3;
  SampleType type = SampleType::kFloat;  // of the samples
  std::span<const std::byte> samples;    // width * height * channels of them
};

struct ImageWriteOptions {
  SampleType type = SampleType::kFloat;    // in the file; a format that lacks it is an error
  int jpeg_quality = 95;                   // 1 to 100
  std::string jpeg_subsampling = "4:2:0";  // of colours: 4:4:4, 4:2:2, 4:2:0, 4:1:1
  std::string colour_space = {};  // said in the file where the format can: "sRGB", "Linear"; empty: nothing
};

// Writes a file in the format of its ending, through a temporary that is then renamed. Floats become integers
// by rounding v * largest, limited to the range. Throws IoError (kOutput), kInput when the module is missing;
// std::invalid_argument when sizes disagree.
void write_image(const std::filesystem::path& file, const ImagePixels& pixels,
                 const ImageWriteOptions& options);

}  // namespace brdfit::io

#endif  // BRDFIT_IO_IMAGE_READER_H_
