// Walking the chunks of a PNG and the segments of a JPEG up to the pixels.
#include "io/image_layout.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "io/error.h"
#include "io/input_file.h"

namespace brdfit::io {
namespace {

// Bytes of a file; none where it ends.
template <std::size_t N>
std::array<std::uint8_t, N> bytes_at(const InputFile& file, std::size_t offset) {
  std::array<std::uint8_t, N> bytes{};
  if (offset + N <= file.size()) file.read_at(offset, std::as_writable_bytes(std::span(bytes)));
  return bytes;
}

std::size_t big_endian(const std::uint8_t* bytes, int count) {
  std::size_t value = 0;
  for (int k = 0; k < count; ++k) value = value << 8 | bytes[k];
  return value;
}

// PNG 3rd edition, 5.3: length, type, data, check sum; IHDR is the first chunk, interlacing its last byte.
ImageLayout png_layout(const InputFile& file) {
  ImageLayout layout;
  layout.needs_whole_image = bytes_at<1>(file, 28)[0] != 0;
  std::size_t at = 8;
  while (at + 12 <= file.size()) {
    const auto head = bytes_at<8>(file, at);
    const std::string_view type(reinterpret_cast<const char*>(head.data() + 4), 4);
    if (type == "IDAT" || type == "IEND") break;
    layout.says_colour_space |= type == "sRGB" || type == "gAMA" || type == "iCCP" || type == "cICP";
    at += 12 + big_endian(head.data(), 4);
  }
  return layout;
}

// What follows a file's first scan must hold an end of image, which cannot stand among coded pixels (T.81,
// B.1.1.5). Decoders fill up with grey what a file that was cut off lacks. Looked for from the end, where it
// is.
void require_end_of_image(const InputFile& file, std::size_t scan) {
  constexpr std::size_t kPiece = 4096;
  for (std::size_t end = file.size(); end > scan + 1;) {
    const std::size_t begin = end - scan > kPiece ? end - kPiece : scan;
    std::vector<std::uint8_t> piece(end - begin);
    file.read_at(begin, std::as_writable_bytes(std::span(piece)));
    constexpr std::array<std::uint8_t, 2> kEnd = {0xFF, 0xD9};
    if (!std::ranges::search(piece, kEnd).empty()) return;
    end = begin + (begin > scan ? 1 : 0);  // the marker may lie across two pieces
  }
  throw IoError(IoError::Side::kInput, file.name(), "is cut off: it has no end of image",
                "a whole JPEG file");
}

// ITU-T T.81, B.1: 0xFF, marker, length with itself, data. SOF2 is progressive; SOS begins the pixels. An
// APP2 that begins with ICC_PROFILE holds one.
ImageLayout jpeg_layout(const InputFile& file) {
  ImageLayout layout;
  std::size_t at = 2;
  while (at + 4 <= file.size()) {
    const auto head = bytes_at<4>(file, at);
    if (head[0] == 0xFF && head[1] == 0xDA) require_end_of_image(file, at);
    if (head[0] != 0xFF || head[1] == 0xDA || head[1] == 0xD9) break;
    if (head[1] == 0xFF) {  // fill
      ++at;
      continue;
    }
    // Progressive, with either coding.
    layout.needs_whole_image |= head[1] == 0xC2 || head[1] == 0xCA;
    const auto tag = bytes_at<4>(file, at + 4);
    const std::string_view name(reinterpret_cast<const char*>(tag.data()), 4);
    layout.says_colour_space |= head[1] == 0xE2 && name == "ICC_";
    at += 2 + std::max<std::size_t>(2, big_endian(head.data() + 2, 2));
  }
  return layout;
}

}  // namespace

ImageLayout layout_of(const std::filesystem::path& name) {
  const InputFile file(name, "an image");
  const auto head = bytes_at<8>(file, 0);
  constexpr std::array<std::uint8_t, 8> kPng = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  if (head == kPng) return png_layout(file);
  if (head[0] == 0xFF && head[1] == 0xD8) return jpeg_layout(file);
  return {};
}

}  // namespace brdfit::io
