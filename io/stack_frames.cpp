// Reading frames beside the pictures.
#include "io/stack_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/error.h"

namespace brdfit::io {
namespace {

constexpr int kRowsAtOnce = 8;

std::size_t pixel_count(const PixelChoice& choice, int width) {
  return choice.texels.empty() ? static_cast<std::size_t>(choice.rows) * static_cast<std::size_t>(width)
                               : choice.texels.size();
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

std::vector<std::byte> samples_of(RowSource& rows, const PixelChoice& choice) {
  const ImageHeader& header = rows.header();
  std::vector<std::byte> samples(pixel_count(choice, header.width) * header.row_bytes() /
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

StackFrames::StackFrames(const StackSource& source, const std::optional<Transfer>& transfer, int width,
                         int height)
    : width_(width) {
  const std::string as_what = source.pictures.front().file.filename().string();
  const auto open = [&](std::optional<Frame>& frame, const std::optional<std::filesystem::path>& file,
                        const std::optional<Transfer>& its_transfer) {
    if (!file) return;
    RowSource rows(*file);
    require_size(rows, width, height, as_what);
    const auto codes = std::make_shared<const CodeTable>(rows.header().type,
                                                         its_transfer ? *its_transfer : own_transfer(rows));
    const int channels = rows.header().channels;
    frame.emplace(Frame{std::move(rows), PixelConverter(codes, channels, 1.0, kIdentity3)});
  };
  open(dark_, source.dark, transfer);
  open(flat_, source.flat, transfer);
  open(mask_, source.mask, Transfer{});
  open(normals_, source.normals, Transfer{});
  open(albedo_, source.albedo, {});
  if (flat_) measure_flat(height);
}

std::vector<float> StackFrames::values_of(Frame& frame, const PixelChoice& choice) {
  const std::vector<std::byte> samples = samples_of(frame.rows, choice);
  const std::size_t count = pixel_count(choice, frame.rows.header().width);
  std::vector<float> values(3 * count);
  Unusable unusable;
  frame.converter.convert(samples, count, {}, PixelConverter::Output::kRgb, values.data(), count, 0,
                          unusable);
  return values;
}

void StackFrames::measure_flat(int height) {
  std::array<double, 3> sum{};
  std::size_t pixels = 0;
  for (int first = 0; first < height; first += kRowsAtOnce) {
    const PixelChoice rows = {first, std::min(kRowsAtOnce, height - first), {}};
    std::vector<float> values = values_of(*flat_, rows);
    const std::vector<float> dark = dark_ ? values_of(*dark_, rows) : std::vector<float>(values.size());
    const std::size_t count = values.size() / 3;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < count; ++k) sum[c] += values[c * count + k] - dark[c * count + k];
    }
    pixels += count;
  }
  for (std::size_t c = 0; c < 3; ++c) flat_mean_[c] = sum[c] / static_cast<double>(pixels);
  if (std::all_of(flat_mean_.begin(), flat_mean_.end(), [](double mean) { return mean > 0.0; })) return;
  throw IoError(IoError::Side::kInput, flat_->rows.name(), "the flat frame is black in a channel",
                "a picture of an even white surface");
}

void StackFrames::correct(FrameValues& values, const PixelChoice& choice) {
  if (dark_) values.dark = values_of(*dark_, choice);
  if (!flat_) return;
  values.gain = values_of(*flat_, choice);
  const std::size_t count = values.gain.size() / 3;
  for (std::size_t k = 0; k < count; ++k) {
    bool is_black = false;
    for (std::size_t c = 0; c < 3; ++c) {
      float& gain = values.gain[c * count + k];
      const float light = gain - (values.dark.empty() ? 0.0F : values.dark[c * count + k]);
      is_black = is_black || !(light > 0.0F);
      gain = light > 0.0F ? static_cast<float>(flat_mean_[c]) / light : 0.0F;
    }
    if (is_black && values.blocked[k] == 0) {
      values.blocked[k] = 1;
      ++values.bad_texels;
    }
  }
}

void StackFrames::add_normals(FrameValues& values, const PixelChoice& choice) {
  values.normals = values_of(*normals_, choice);
  const SampleType type = normals_->rows.header().type;
  const bool is_encoded = type == SampleType::kUint8 || type == SampleType::kUint16;
  const std::size_t count = values.normals.size() / 3;
  for (std::size_t k = 0; k < count; ++k) {
    std::array<double, 3> normal;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = values.normals[c * count + k];
      normal[c] = is_encoded ? 2.0 * value - 1.0 : value;
    }
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    // Nothing there, or far from a normal: a stand-in that faces the camera, in a texel that does not count.
    const bool is_sound = std::isfinite(length) && length > 0.5;
    if (!is_sound) normal = {0.0, 0.0, 1.0};
    if (!is_sound && values.blocked[k] == 0) {
      values.blocked[k] = 1;
      ++values.bad_texels;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      values.normals[c * count + k] = static_cast<float>(normal[c] / (is_sound ? length : 1.0));
    }
  }
}

FrameValues StackFrames::read(const PixelChoice& choice) {
  FrameValues values;
  const std::size_t count = pixel_count(choice, width_);
  if (mask_ || flat_ || normals_) values.blocked.assign(count, 0);
  if (mask_) {
    const std::vector<float> mask = values_of(*mask_, choice);
    for (std::size_t k = 0; k < count; ++k) {
      if (mask[k] >= 0.5F) continue;
      values.blocked[k] = 1;
      ++values.masked_texels;
    }
  }
  correct(values, choice);
  if (normals_) add_normals(values, choice);
  if (albedo_) values.albedo = values_of(*albedo_, choice);
  return values;
}

}  // namespace brdfit::io
