// Opening the image module, and errors that name the file.
#include "io/image_reader.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "io/image_plugin.h"
#include "io/input_file.h"

namespace brdfit::io {
namespace {

namespace fs = std::filesystem;
using Side = IoError::Side;

// Beside the executable as it is installed, and as it is built: build/FOLDER/NAME and build/lib/brdfit.
fs::path plugin_path() {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  const std::array candidates = {folder / BRDFIT_PLUGIN_FROM_BIN, folder / "../lib/brdfit"};
  for (const fs::path& candidate : candidates) {
    if (fs::exists(candidate / kImagePluginFile)) return candidate / kImagePluginFile;
  }
  const fs::path wanted = (candidates[0] / kImagePluginFile).lexically_normal();
  throw IoError(Side::kInput, wanted.string(), "the module that reads images is not there",
                "it beside the program, as it was installed", "install brdfit with cmake --install");
}

// Set before the module is loaded.
bool module_is_loaded = false;

const ImagePluginCalls& load_plugin() {
  const fs::path file = plugin_path();
  module_is_loaded = true;
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* symbol = library != nullptr ? dlsym(library, kImagePluginSymbol) : nullptr;
  if (symbol == nullptr) {
    const char* reason = dlerror();
    throw IoError(Side::kInput, file.string(),
                  fmt::format("the module that reads images cannot be loaded: {}", reason ? reason : "?"),
                  "OpenImageIO and a module of this version of brdfit",
                  "install libopenimageio2.4, or brdfit again");
  }
  return *reinterpret_cast<const ImagePluginCalls* (*)()>(symbol)();
}

// Loaded once; never unloaded, as OpenImageIO keeps threads and tables of its own. A failure is told anew
// each time.
const ImagePluginCalls& plugin() {
  static const ImagePluginCalls& calls = load_plugin();
  return calls;
}

std::size_t product(int rows, std::size_t row) {
  return static_cast<std::size_t>(rows) * row;
}

}  // namespace

std::size_t bytes_of(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return 1;
    case SampleType::kUint16:
    case SampleType::kHalf:
      return 2;
    case SampleType::kFloat:
      break;
  }
  return 4;
}

std::string name_of(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return "8 bit";
    case SampleType::kUint16:
      return "16 bit";
    case SampleType::kHalf:
      return "half";
    case SampleType::kFloat:
      break;
  }
  return "float";
}

void load_image_module() {
  static_cast<void>(plugin());
}

ImageReader::ImageReader(const fs::path& file) : name_(file.string()) {
  // For its messages: OpenImageIO's own differ from format to format.
  const InputFile check(file, "an image");
  std::string error;
  image_ = plugin().open(name_, header_, error);
  if (image_ == nullptr) {
    throw IoError(Side::kInput, name_, "cannot be read as an image: " + error,
                  "a format that OpenImageIO reads");
  }
}

ImageReader::ImageReader(ImageReader&& other) noexcept
    : name_(std::move(other.name_)),
      header_(std::move(other.header_)),
      image_(std::exchange(other.image_, nullptr)) {}

ImageReader& ImageReader::operator=(ImageReader&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(header_, other.header_);
  std::swap(image_, other.image_);
  return *this;
}

ImageReader::~ImageReader() {
  if (image_ != nullptr) plugin().close(image_);
}

void ImageReader::read(int first, int rows, SampleType type, std::span<std::byte> out) {
  const bool fits = first >= 0 && rows >= 0 && rows <= header_.height - first &&
                    out.size() == product(rows, header_.row_samples() * bytes_of(type));
  if (!fits) throw std::invalid_argument(name_ + ": rows outside the image, or room of another size");
  std::string error;
  if (rows == 0 || plugin().read(image_, first, rows, type, out.data(), error)) return;
  throw IoError(Side::kInput, name_,
                fmt::format("rows {} to {} cannot be read: {}", first, first + rows - 1, error),
                "an undamaged image");
}

void ImageReader::read_native(int first, int rows, std::span<std::byte> out) {
  read(first, rows, header_.type, out);
}

void ImageReader::read_floats(int first, int rows, std::span<float> out) {
  read(first, rows, SampleType::kFloat, std::as_writable_bytes(out));
}

void write_image(const fs::path& file, const ImagePixels& pixels, const ImageWriteOptions& options) {
  const bool fits =
      pixels.width > 0 && pixels.height > 0 && pixels.channels > 0 &&
      pixels.samples.size() ==
          product(pixels.width, product(pixels.height, product(pixels.channels, bytes_of(pixels.type))));
  if (!fits) throw std::invalid_argument(file.string() + ": samples and size disagree");
  // The format is known by the ending, so the temporary keeps it.
  const fs::path temporary =
      file.parent_path() / fmt::format(".{}.{}{}", file.stem().string(), getpid(), file.extension().string());
  std::string error;
  std::error_code ignored;
  if (!plugin().write(temporary.string(), pixels, options, error)) {
    fs::remove(temporary, ignored);
    throw IoError(Side::kOutput, file.string(), "cannot be written: " + error, "");
  }
  std::error_code failed;
  fs::rename(temporary, file, failed);
  if (!failed) return;
  fs::remove(temporary, ignored);
  throw IoError(Side::kOutput, file.string(), "cannot be written: " + failed.message(), "");
}

}  // namespace brdfit::io

#if defined(__SANITIZE_ADDRESS__)
// What OpenImageIO brings leaks as it is loaded and keeps threads that the leak sanitizer does not survive,
// so there is no search for leaks where images were read.
extern "C" int __lsan_is_turned_off() {
  return brdfit::io::module_is_loaded ? 1 : 0;
}
#endif
