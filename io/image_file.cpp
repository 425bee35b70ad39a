// PNG through libpng and EXR through OpenEXR, made in memory and then written whole. (OpenImageIO writes
// both, but the libraries that it brings take a program 0.13 s to load, several times the work of a command.)
#include "io/image_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <set>
#include <stdexcept>
#include <string_view>

#include "io/atomic_file.h"

namespace brdfit::io {
namespace {

// A PNG's keyword has at most that many bytes; an EXR's name may be longer.
constexpr std::size_t kLongestName = 79;

// Names that OpenImageIO (as a reader) or the format itself gives a meaning, so that text under them would be
// lost, change the file, or put a date into it.
constexpr std::string_view kTakenNames[] = {"capdate",
                                            "channels",
                                            "chunkcount",
                                            "comments",
                                            "compression",
                                            "datawindow",
                                            "datetime",
                                            "displaywindow",
                                            "iccprofile",
                                            "lineorder",
                                            "name",
                                            "orientation",
                                            "owner",
                                            "pixelaspectratio",
                                            "preview",
                                            "resolutionunit",
                                            "screenwindowcenter",
                                            "screenwindowwidth",
                                            "smpte:timecode",
                                            "tiles",
                                            "type",
                                            "worldtocamera",
                                            "worldtoscreen",
                                            "xresolution",
                                            "yresolution"};

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

bool is_taken(std::string_view name) {
  const std::string lower = lower_case(name);
  constexpr std::string_view kTakenPrefixes[] = {"oiio:", "png:", "openexr:", "exif:", "iptc:", "gps:"};
  return std::find(std::begin(kTakenNames), std::end(kTakenNames), lower) != std::end(kTakenNames) ||
         std::any_of(std::begin(kTakenPrefixes), std::end(kTakenPrefixes),
                     [&](std::string_view prefix) { return lower.starts_with(prefix); });
}

bool is_name(std::string_view name) {
  const bool is_printable =
      std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; });
  return !name.empty() && name.size() <= kLongestName && is_printable && name.front() != ' ' &&
         name.back() != ' ' && name.find("  ") == std::string_view::npos && !is_taken(name);
}

void check_metadata(const ImageMetadata& metadata) {
  std::set<std::string> seen;
  for (const auto& [name, text] : metadata) {
    if (!is_name(name) || !seen.insert(lower_case(name)).second) {
      throw std::invalid_argument(
          fmt::format("image metadata: '{}' cannot be a name: 1 to {} printable ASCII characters, single "
                      "spaces only inside, each name once, none that the format uses itself",
                      name, kLongestName));
    }
    if (text.find('\0') != std::string::npos) {
      throw std::invalid_argument(fmt::format("image metadata: the text of '{}' holds a zero byte", name));
    }
  }
}

void check_size(int width, int height, std::size_t channels, std::size_t samples) {
  const bool is_sound =
      width > 0 && height > 0 && channels > 0 &&
      samples / channels / static_cast<std::size_t>(width) == static_cast<std::size_t>(height) &&
      samples % (channels * static_cast<std::size_t>(width)) == 0;
  if (is_sound) return;
  throw std::invalid_argument(fmt::format("image: {} samples are not {} x {} pixels of {} channels", samples,
                                          width, height, channels));
}

using Bytes = std::vector<unsigned char>;

// What a PNG calls the description that EXIF and OpenImageIO call ImageDescription.
const char* png_keyword(const std::string& name) {
  return name == "ImageDescription" ? "Description" : name.c_str();
}

void append_png(png_structp png, png_bytep data, png_size_t size) {
  auto& bytes = *static_cast<Bytes*>(png_get_io_ptr(png));
  bytes.insert(bytes.end(), data, data + size);
}

// UTF-8 text for libpng, which wants pointers that are not const.
std::vector<png_text> png_texts(const ImageMetadata& metadata) {
  std::vector<png_text> texts;
  for (const auto& [name, text] : metadata) {
    png_text entry{};
    entry.compression = PNG_ITXT_COMPRESSION_NONE;
    entry.key = const_cast<char*>(png_keyword(name));
    entry.text = const_cast<char*>(text.c_str());
    entry.itxt_length = text.size();
    texts.push_back(entry);
  }
  return texts;
}

// libpng jumps here from its errors, so nothing in this function needs a destructor.
bool write_png(png_structp png, png_infop info, const PixelView8& pixels, int colour_type,
               const std::vector<png_text>& texts, Bytes& bytes) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  const auto width = static_cast<png_uint_32>(pixels.width);
  png_set_write_fn(png, &bytes, append_png, nullptr);
  png_set_IHDR(png, info, width, static_cast<png_uint_32>(pixels.height), 8, colour_type, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
  png_write_info(png, info);
  const std::size_t stride = std::size_t{width} * static_cast<std::size_t>(pixels.channels);
  for (std::size_t y = 0; y < static_cast<std::size_t>(pixels.height); ++y) {
    png_write_row(png, pixels.samples.data() + y * stride);
  }
  png_write_end(png, nullptr);
  return true;
}

// Where OpenEXR writes to.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("memory.exr") {}

  void write(const char data[], int size) override {
    const auto count = static_cast<std::size_t>(size);
    if (bytes_.size() < place_ + count) bytes_.resize(place_ + count);
    std::memcpy(bytes_.data() + place_, data, count);
    place_ += count;
  }
  std::uint64_t tellp() override { return place_; }
  void seekp(std::uint64_t place) override { place_ = static_cast<std::size_t>(place); }

  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
  std::size_t place_ = 0;
};

}  // namespace

std::vector<unsigned char> encode_png(const PixelView8& pixels, const ImageMetadata& metadata) {
  if (pixels.channels != 1 && pixels.channels != 3 && pixels.channels != 4) {
    throw std::invalid_argument(fmt::format("image: {} channels; a PNG has 1, 3 or 4", pixels.channels));
  }
  check_size(pixels.width, pixels.height, static_cast<std::size_t>(pixels.channels), pixels.samples.size());
  check_metadata(metadata);
  const int colour_type = pixels.channels == 1   ? PNG_COLOR_TYPE_GRAY
                          : pixels.channels == 3 ? PNG_COLOR_TYPE_RGB
                                                 : PNG_COLOR_TYPE_RGB_ALPHA;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  Bytes bytes;
  const std::vector<png_text> texts = png_texts(metadata);
  const bool is_done = info != nullptr && write_png(png, info, pixels, colour_type, texts, bytes);
  png_destroy_write_struct(&png, &info);
  if (!is_done) throw std::runtime_error("libpng cannot encode the picture");
  return bytes;
}

std::vector<unsigned char> encode_exr(const PixelViewFloat& pixels, const ImageMetadata& metadata) {
  check_size(pixels.width, pixels.height, pixels.channels.size(), pixels.samples.size());
  check_metadata(metadata);
  const std::set<std::string> names(pixels.channels.begin(), pixels.channels.end());
  if (names.size() != pixels.channels.size() || names.contains("")) {
    throw std::invalid_argument("image: every channel needs a name of its own");
  }
  const auto bad = std::find_if(pixels.samples.begin(), pixels.samples.end(),
                                [](float value) { return !std::isfinite(value); });
  if (bad != pixels.samples.end()) {
    const auto pixel = static_cast<std::size_t>(bad - pixels.samples.begin()) / pixels.channels.size();
    throw std::invalid_argument(fmt::format("image: the pixel at column {}, row {} is not finite",
                                            pixel % static_cast<std::size_t>(pixels.width),
                                            pixel / static_cast<std::size_t>(pixels.width)));
  }
  Imf::Header header(pixels.width, pixels.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer frame;
  const std::size_t pixel_bytes = pixels.channels.size() * sizeof(float);
  for (std::size_t c = 0; c < pixels.channels.size(); ++c) {
    header.channels().insert(pixels.channels[c], Imf::Channel(Imf::FLOAT));
    // OpenEXR reads through a pointer that is not const.
    char* first = reinterpret_cast<char*>(const_cast<float*>(pixels.samples.data() + c));
    frame.insert(pixels.channels[c], Imf::Slice(Imf::FLOAT, first, pixel_bytes,
                                                pixel_bytes * static_cast<std::size_t>(pixels.width)));
  }
  for (const auto& [name, text] : metadata) {
    header.insert(name == "ImageDescription" ? "comments" : name, Imf::StringAttribute(text));
  }
  MemoryStream memory;
  {
    // One thread, and whole when it is destroyed.
    Imf::OutputFile file(memory, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(pixels.height);
  }
  return memory.take();
}

void write_bytes(const std::filesystem::path& file, std::span<const unsigned char> bytes) {
  AtomicFile output(file);
  output.write(std::as_bytes(bytes));
  output.commit();
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  AtomicFile output(file);
  output.write(text);
  output.commit();
}

}  // namespace brdfit::io
