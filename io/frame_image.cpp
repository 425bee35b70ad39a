// Chosen pixels of one image.
#include "io/frame_image.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>

#include "io/error.h"

namespace brdfit::io {
namespace {

constexpr int kRowsAtOnce = 8;

RowSource open_image(const std::filesystem::path& file, const FrameSize& size) {
  RowSource rows(file);
  require_size(rows, size.width, size.height, size.as_what);
  return rows;
}

PixelConverter converter_of(const RowSource& rows, const std::optional<Transfer>& transfer) {
  const auto codes =
      std::make_shared<const CodeTable>(rows.header().type, transfer ? *transfer : own_transfer(rows));
  return PixelConverter(codes, rows.header().channels, 1.0, kIdentity3);
}

// Texels of neighbouring rows with one call to the decoder.
void copy_chosen(RowSource& rows, std::span<const std::uint32_t> texels, std::byte* out) {
  const auto width = static_cast<std::uint32_t>(rows.header().width);
  const std::size_t row_bytes = rows.header().row_bytes();
  const std::size_t pixel_bytes = row_bytes / width;
  std::vector<std::byte> strip(kRowsAtOnce * row_bytes);
  for (std::size_t k = 0; k < texels.size();) {
    const std::uint32_t first = texels[k] / width;
    std::size_t end = k;
    while (end < texels.size() && texels[end] / width < first + kRowsAtOnce) ++end;
    const std::size_t count = texels[end - 1] / width - first + 1;
    rows.read(static_cast<int>(first), static_cast<int>(count), std::span(strip).first(count * row_bytes));
    for (; k < end; ++k, out += pixel_bytes) {
      const std::size_t place = (texels[k] / width - first) * row_bytes + texels[k] % width * pixel_bytes;
      std::memcpy(out, strip.data() + place, pixel_bytes);
    }
  }
}

}  // namespace

std::size_t PixelChoice::count(int width) const {
  return texels.empty() ? static_cast<std::size_t>(rows) * static_cast<std::size_t>(width) : texels.size();
}

std::vector<std::byte> samples_of(RowSource& rows, const PixelChoice& choice) {
  const ImageHeader& header = rows.header();
  std::vector<std::byte> samples(choice.count(header.width) * header.row_bytes() /
                                 static_cast<std::size_t>(header.width));
  if (choice.texels.empty()) {
    rows.read(choice.first_row, choice.rows, samples);
    return samples;
  }
  copy_chosen(rows, choice.texels, samples.data());
  return samples;
}

Transfer own_transfer(const RowSource& rows) {
  return transfer_in_file(rows.name(), rows.header()).value_or(usual_transfer(rows.header().type));
}

void require_size(const RowSource& rows, int width, int height, const std::string& as_what) {
  const ImageHeader& header = rows.header();
  if (header.width == width && header.height == height) return;
  throw IoError(IoError::Side::kInput, rows.name(),
                fmt::format("is {} x {} pixels", header.width, header.height),
                fmt::format("{} x {} as {}", width, height, as_what), "all images of a stack have one size");
}

FrameImage::FrameImage(const std::filesystem::path& file, const std::optional<Transfer>& transfer,
                       const FrameSize& size)
    : rows_(open_image(file, size)), converter_(converter_of(rows_, transfer)) {}

std::vector<float> FrameImage::values(const PixelChoice& choice, Unusable& unusable) {
  const std::vector<std::byte> samples = samples_of(rows_, choice);
  const std::size_t count = choice.count(rows_.header().width);
  std::vector<float> values(3 * count);
  converter_.convert(samples, count, {}, PixelConverter::Output::kRgb, values.data(), count, 0, unusable);
  return values;
}

std::vector<float> FrameImage::values(const PixelChoice& choice) {
  Unusable unusable;
  return values(choice, unusable);
}

std::vector<float> FrameImage::unit_vectors(const PixelChoice& choice) {
  std::vector<float> vectors = values(choice);
  const bool is_encoded = type() == SampleType::kUint8 || type() == SampleType::kUint16;
  const std::size_t count = vectors.size() / 3;
  for (std::size_t k = 0; k < count; ++k) {
    std::array<double, 3> normal;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = vectors[c * count + k];
      normal[c] = is_encoded ? 2.0 * value - 1.0 : value;
    }
    // Squares of floats do not overflow in double precision, so that the slow hypot is not needed.
    const double length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    // Nothing there, or far from a normal.
    const bool is_sound = std::isfinite(length) && length > 0.5;
    for (std::size_t c = 0; c < 3; ++c) {
      vectors[c * count + k] = is_sound ? static_cast<float>(normal[c] / length) : 0.0F;
    }
  }
  return vectors;
}

}  // namespace brdfit::io
