// The module brdfit_images: reading and writing through OpenImageIO.
#include "io/image_plugin.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <vector>

namespace brdfit::io {
namespace {

OIIO::TypeDesc oiio_type(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return OIIO::TypeDesc::UINT8;
    case SampleType::kUint16:
      return OIIO::TypeDesc::UINT16;
    case SampleType::kHalf:
      return OIIO::TypeDesc::HALF;
    case SampleType::kFloat:
      break;
  }
  return OIIO::TypeDesc::FLOAT;
}

SampleType sample_type(OIIO::TypeDesc type) {
  if (type == OIIO::TypeDesc::UINT8) return SampleType::kUint8;
  if (type == OIIO::TypeDesc::UINT16) return SampleType::kUint16;
  if (type == OIIO::TypeDesc::HALF) return SampleType::kHalf;
  return SampleType::kFloat;
}

// Images are decoded in parallel, each by one thread; pools inside the libraries would only be in the way.
// Said once: each time resizes OpenImageIO's pool, which threads that open images at the same time do not
// survive.
void use_one_thread() {
  static const bool is_said = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1);
  static_cast<void>(is_said);
}

// OpenImageIO 2.4 cannot open two JPEG images with colour profiles at once (its issue 3756). Only headers are
// read then, so it costs little to take turns.
std::mutex& opening() {
  static std::mutex mutex;
  return mutex;
}

// OpenImageIO keeps errors of opening per thread, and often ends them with a new line.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text.empty() ? "OpenImageIO gives no reason" : text;
}

class Image {
 public:
  explicit Image(std::unique_ptr<OIIO::ImageInput> input) : input_(std::move(input)), spec_(input_->spec()) {
    input_->threads(1);
  }

  ImageHeader header() const {
    ImageHeader header;
    header.width = spec_.width;
    header.height = spec_.height;
    header.channels = spec_.nchannels;
    header.type = sample_type(spec_.format);
    header.format = input_->format_name();
    header.colour_space = spec_.get_string_attribute("oiio:ColorSpace");
    header.is_scanline = spec_.tile_width == 0;
    header.is_compressed = spec_.get_string_attribute("compression", "unknown") != "none";
    return header;
  }

  bool read(int first, int rows, SampleType type, void* out) {
    if (spec_.tile_width != 0) return read_tiled(first, rows, oiio_type(type), static_cast<char*>(out));
    const int top = spec_.y + first;
    return input_->read_scanlines(0, 0, top, top + rows, 0, 0, spec_.nchannels, oiio_type(type), out);
  }

  std::string error() const { return one_line(input_->geterror()); }

 private:
  // Whole rows of tiles are read and the last one kept: the next strip may begin inside it.
  bool read_tiled(int first, int rows, OIIO::TypeDesc type, char* out) {
    const std::size_t row_bytes =
        static_cast<std::size_t>(spec_.width) * static_cast<std::size_t>(spec_.nchannels) * type.size();
    for (int row = first; row < first + rows; ++row) {
      const int begin = row / spec_.tile_height * spec_.tile_height;
      if ((kept_begin_ != begin || kept_type_ != type) && !keep_tiles(begin, type, row_bytes)) return false;
      std::memcpy(out, kept_.data() + static_cast<std::size_t>(row - begin) * row_bytes, row_bytes);
      out += row_bytes;
    }
    return true;
  }

  bool keep_tiles(int begin, OIIO::TypeDesc type, std::size_t row_bytes) {
    const int end = std::min(begin + spec_.tile_height, spec_.height);
    kept_.resize(static_cast<std::size_t>(end - begin) * row_bytes);
    kept_begin_ = -1;
    if (!input_->read_tiles(0, 0, spec_.x, spec_.x + spec_.width, spec_.y + begin, spec_.y + end, 0, 1, 0,
                            spec_.nchannels, type, kept_.data())) {
      return false;
    }
    kept_begin_ = begin;
    kept_type_ = type;
    return true;
  }

  std::unique_ptr<OIIO::ImageInput> input_;
  OIIO::ImageSpec spec_;
  std::vector<char> kept_;
  int kept_begin_ = -1;
  OIIO::TypeDesc kept_type_;
};

void* open(const std::string& file, ImageHeader& header, std::string& error) {
  try {
    use_one_thread();
    // Alpha is not used, so colours must not be multiplied with it.
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    std::unique_lock<std::mutex> turn(opening());
    auto input = OIIO::ImageInput::open(file, &config);
    turn.unlock();
    if (!input) {
      error = one_line(OIIO::geterror());
      return nullptr;
    }
    if (input->spec().deep || input->spec().depth > 1) {
      error = "it is a volume or has deep samples";
      return nullptr;
    }
    auto image = std::make_unique<Image>(std::move(input));
    header = image->header();
    return image.release();
  } catch (const std::exception& exception) {
    error = one_line(exception.what());
    return nullptr;
  }
}

bool read(void* image, int first_row, int rows, SampleType type, void* out, std::string& error) {
  auto& opened = *static_cast<Image*>(image);
  try {
    if (opened.read(first_row, rows, type, out)) return true;
    error = opened.error();
  } catch (const std::exception& exception) {
    error = one_line(exception.what());
  }
  return false;
}

void close(void* image) {
  delete static_cast<Image*>(image);
}

bool write_pixels(const std::string& file, const ImagePixels& pixels, const ImageWriteOptions& options,
                  std::string& error) {
  auto output = OIIO::ImageOutput::create(file);
  if (!output) {
    error = one_line(OIIO::geterror());
    return false;
  }
  OIIO::ImageSpec spec(pixels.width, pixels.height, pixels.channels, oiio_type(options.type));
  spec.attribute("CompressionQuality", options.jpeg_quality);
  spec.attribute("jpeg:subsampling", options.jpeg_subsampling);
  // An empty one: without any, EXR and TIFF say when they were written, and no two runs give the same bytes.
  spec.attribute("DateTime", "");
  // A fourth channel is written as it is given.
  spec.attribute("oiio:UnassociatedAlpha", 1);
  if (!options.colour_space.empty()) spec.attribute("oiio:ColorSpace", options.colour_space);
  if (!output->open(file, spec)) {
    error = one_line(output->geterror());
    return false;
  }
  if (output->spec().format != spec.format) {
    error = "the format " + std::string(output->format_name()) + " does not hold such samples";
    return false;
  }
  if (output->write_image(oiio_type(pixels.type), pixels.samples.data()) && output->close()) return true;
  error = one_line(output->geterror());
  return false;
}

bool write(const std::string& file, const ImagePixels& pixels, const ImageWriteOptions& options,
           std::string& error) {
  try {
    use_one_thread();
    return write_pixels(file, pixels, options, error);
  } catch (const std::exception& exception) {
    error = one_line(exception.what());
    return false;
  }
}

}  // namespace
}  // namespace brdfit::io

extern "C" __attribute__((visibility("default"))) const brdfit::io::ImagePluginCalls*
brdfit_image_plugin_1() {
  static const brdfit::io::ImagePluginCalls calls = {brdfit::io::open, brdfit::io::read, brdfit::io::close,
                                                     brdfit::io::write};
  return &calls;
}
