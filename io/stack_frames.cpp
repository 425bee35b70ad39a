// Reading frames beside the pictures.
#include "io/stack_frames.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>

#include "io/error.h"

namespace brdfit::io {
namespace {

constexpr int kRowsAtOnce = 8;

}  // namespace

StackFrames::StackFrames(const StackSource& source, const std::optional<Transfer>& transfer, int width,
                         int height)
    : width_(width) {
  const FrameSize size = {width, height, source.pictures.front().file.filename().string()};
  const auto open = [&](std::optional<FrameImage>& frame, const std::optional<std::filesystem::path>& file,
                        const std::optional<Transfer>& its_transfer) {
    if (file) frame.emplace(*file, its_transfer, size);
  };
  open(dark_, source.dark, transfer);
  open(flat_, source.flat, transfer);
  open(mask_, source.mask, Transfer{});
  open(normals_, source.normals, Transfer{});
  open(albedo_, source.albedo, {});
  if (flat_) measure_flat(height);
}

void StackFrames::measure_flat(int height) {
  std::array<double, 3> sum{};
  std::size_t pixels = 0;
  for (int first = 0; first < height; first += kRowsAtOnce) {
    const PixelChoice rows = {first, std::min(kRowsAtOnce, height - first), {}};
    std::vector<float> values = flat_->values(rows);
    const std::vector<float> dark = dark_ ? dark_->values(rows) : std::vector<float>(values.size());
    const std::size_t count = values.size() / 3;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < count; ++k) sum[c] += values[c * count + k] - dark[c * count + k];
    }
    pixels += count;
  }
  for (std::size_t c = 0; c < 3; ++c) flat_mean_[c] = sum[c] / static_cast<double>(pixels);
  if (std::all_of(flat_mean_.begin(), flat_mean_.end(), [](double mean) { return mean > 0.0; })) return;
  throw IoError(IoError::Side::kInput, flat_->name(), "the flat frame is black in a channel",
                "a picture of an even white surface");
}

void StackFrames::correct(FrameValues& values, const PixelChoice& choice) {
  if (dark_) values.dark = dark_->values(choice);
  if (!flat_) return;
  values.gain = flat_->values(choice);
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
  values.normals = normals_->unit_vectors(choice);
  const std::size_t count = choice.count(width_);
  for (std::size_t k = 0; k < count; ++k) {
    const bool is_normal = values.normals[k] != 0.0F || values.normals[count + k] != 0.0F ||
                           values.normals[2 * count + k] != 0.0F;
    if (is_normal) continue;
    // A stand-in that faces the camera, in a texel that does not count.
    values.normals[2 * count + k] = 1.0F;
    if (values.blocked[k] == 0) {
      values.blocked[k] = 1;
      ++values.bad_texels;
    }
  }
}

FrameValues StackFrames::read_correction(const PixelChoice& choice) {
  FrameValues values;
  const std::size_t count = choice.count(width_);
  if (mask_ || flat_ || normals_) values.blocked.assign(count, 0);
  if (mask_) {
    const std::vector<float> mask = mask_->values(choice);
    for (std::size_t k = 0; k < count; ++k) {
      if (mask[k] >= 0.5F) continue;
      values.blocked[k] = 1;
      ++values.masked_texels;
    }
  }
  correct(values, choice);
  return values;
}

void StackFrames::read_surface(FrameValues& values, const PixelChoice& choice) {
  tbb::parallel_invoke(
      [&] {
        if (albedo_) values.albedo = albedo_->values(choice);
      },
      [&] {
        if (normals_) add_normals(values, choice);
      });
}

FrameValues StackFrames::read(const PixelChoice& choice) {
  FrameValues values = read_correction(choice);
  read_surface(values, choice);
  return values;
}

}  // namespace brdfit::io
