// Decoding by table. 8 bits without frames to correct by, which is nearly every stack, has a path of its own
// that costs a few cycles a pixel; all else goes sample by sample.
#include "io/pixel_converter.h"

#include <Imath/half.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace brdfit::io {
namespace {

static_assert(std::endian::native == std::endian::little, "codes are taken out of words from the low end");

constexpr std::array<double, 3> kLuminance = {0.2126, 0.7152, 0.0722};  // ITU-R BT.709

float half_from_bits(std::uint16_t bits) {
  Imath::half value;
  value.setBits(bits);
  return value;
}

}  // namespace

CodeTable::CodeTable(SampleType type, const Transfer& transfer) : type_(type), transfer_(transfer) {
  if (type == SampleType::kFloat) return;
  const std::size_t count = type == SampleType::kUint8 ? 256 : 65536;
  values_.resize(count);
  for (std::size_t code = 0; code < count; ++code) {
    const double value = type == SampleType::kHalf
                             ? half_from_bits(static_cast<std::uint16_t>(code))
                             : static_cast<double>(code) / static_cast<double>(count - 1);
    values_[code] = static_cast<float>(to_linear(transfer, value));
  }
}

PixelConverter::PixelConverter(std::shared_ptr<const CodeTable> codes, int channels, double scale,
                               const Matrix3& matrix)
    : codes_(std::move(codes)), channels_(static_cast<std::size_t>(channels)), is_diagonal_(true) {
  for (std::size_t i = 0; i < 3; ++i) {
    double luminance = 0.0;
    for (std::size_t j = 0; j < 3; ++j) {
      matrix_[i][j] = static_cast<float>(scale * matrix[i][j]);
      is_diagonal_ = is_diagonal_ && (i == j || matrix[i][j] == 0.0);
      luminance += kLuminance[j] * scale * matrix[j][i];
    }
    luminance_[i] = static_cast<float>(luminance);
  }
  if (codes_->type() != SampleType::kUint8) return;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t code = 0; code < 256; ++code) {
      rgb8_[c][code] = matrix_[c][c] * codes_->values()[code];
      luminance8_[c][code] = luminance_[c] * codes_->values()[code];
    }
  }
}

namespace {

// Calls f(pixel, red, green, blue) with the codes of every pixel. Three channels are taken four pixels at a
// time, from two loads: single bytes would keep the load units busier than the tables do.
template <class F>
void for_codes(const std::uint8_t* in, std::size_t count, std::size_t channels, const F& f) {
  std::size_t k = 0;
  if (channels == 3) {
    for (; k + 4 <= count; k += 4, in += 12) {
      std::uint64_t a = 0;
      std::uint32_t b = 0;
      std::memcpy(&a, in, 8);
      std::memcpy(&b, in + 8, 4);
      f(k, a & 255, a >> 8 & 255, a >> 16 & 255);
      f(k + 1, a >> 24 & 255, a >> 32 & 255, a >> 40 & 255);
      f(k + 2, a >> 48 & 255, a >> 56, b & 255);
      f(k + 3, b >> 8 & 255, b >> 16 & 255, b >> 24);
    }
  }
  const std::size_t green = channels >= 3 ? 1 : 0;
  const std::size_t blue = channels >= 3 ? 2 : 0;
  for (; k < count; ++k, in += channels) f(k, in[0], in[green], in[blue]);
}

}  // namespace

bool PixelConverter::convert_bytes(std::span<const std::byte> samples, std::size_t count, Output output,
                                   float* out, std::size_t plane_stride) const {
  if (output == Output::kRgb && !is_diagonal_) return false;
  const auto* in = reinterpret_cast<const std::uint8_t*>(samples.data());
  if (output == Output::kLuminance) {
    const auto& [table_r, table_g, table_b] = luminance8_;
    for_codes(in, count, channels_, [&](std::size_t k, std::size_t r, std::size_t g, std::size_t b) {
      out[k] = table_r[r] + table_g[g] + table_b[b];
    });
    return true;
  }
  const auto& [table_r, table_g, table_b] = rgb8_;
  float* red = out;
  float* green = out + plane_stride;
  float* blue = out + 2 * plane_stride;
  for_codes(in, count, channels_, [&](std::size_t k, std::size_t r, std::size_t g, std::size_t b) {
    red[k] = table_r[r];
    green[k] = table_g[g];
    blue[k] = table_b[b];
  });
  return true;
}

template <class Decode>
void PixelConverter::convert_any(std::size_t count, const CorrectionPlanes& correction, Output output,
                                 float* out, std::size_t plane_stride, std::uint32_t first_pixel,
                                 Unusable& unusable, const Decode& decode) const {
  for (std::size_t k = 0; k < count; ++k) {
    std::array<float, 3> light;
    bool is_saturated = false;
    decode(k, light, is_saturated);
    for (std::size_t c = 0; c < 3; ++c) {
      if (!correction.dark.empty()) light[c] -= correction.dark[c * count + k];
      if (!correction.gain.empty()) light[c] *= correction.gain[c * count + k];
    }
    std::array<float, 3> result{};
    if (output == Output::kLuminance) {
      result[0] = luminance_[0] * light[0] + luminance_[1] * light[1] + luminance_[2] * light[2];
    } else {
      for (std::size_t c = 0; c < 3; ++c) {
        result[c] = is_diagonal_
                        ? matrix_[c][c] * light[c]
                        : matrix_[c][0] * light[0] + matrix_[c][1] * light[1] + matrix_[c][2] * light[2];
      }
    }
    const bool is_finite = std::isfinite(light[0]) && std::isfinite(light[1]) && std::isfinite(light[2]) &&
                           std::isfinite(result[0]) && std::isfinite(result[1]) && std::isfinite(result[2]);
    if (!is_finite) result = {};
    if (!is_finite || is_saturated) {
      unusable.pixels.push_back(first_pixel + static_cast<std::uint32_t>(k));
      ++(is_finite ? unusable.saturated : unusable.non_finite);
    }
    const std::size_t planes = output == Output::kLuminance ? 1 : 3;
    for (std::size_t c = 0; c < planes; ++c) out[c * plane_stride + k] = result[c];
  }
}

namespace {

// Pixels that hold the byte 255 in a channel that counts.
void find_saturated(std::span<const std::byte> samples, std::size_t channels, std::uint32_t first_pixel,
                    Unusable& unusable) {
  const std::size_t counted = channels >= 3 ? 3 : 1;
  const auto* begin = reinterpret_cast<const std::uint8_t*>(samples.data());
  const std::uint8_t* end = begin + samples.size();
  const std::uint8_t* at = begin;
  while (at < end) {
    at = static_cast<const std::uint8_t*>(std::memchr(at, 255, static_cast<std::size_t>(end - at)));
    if (at == nullptr) return;
    const auto place = static_cast<std::size_t>(at - begin);
    const std::size_t pixel = place / channels;
    if (place % channels >= counted) {
      ++at;
      continue;
    }
    unusable.pixels.push_back(first_pixel + static_cast<std::uint32_t>(pixel));
    ++unusable.saturated;
    at = begin + (pixel + 1) * channels;
  }
}

template <class Sample>
Sample sample_at(std::span<const std::byte> samples, std::size_t index) {
  Sample value;
  std::memcpy(&value, samples.data() + index * sizeof(Sample), sizeof(Sample));
  return value;
}

}  // namespace

void PixelConverter::convert(std::span<const std::byte> samples, std::size_t count,
                             const CorrectionPlanes& correction, Output output, float* out,
                             std::size_t plane_stride, std::uint32_t first_pixel, Unusable& unusable) const {
  const bool is_plain = correction.dark.empty() && correction.gain.empty();
  if (codes_->type() == SampleType::kUint8 && is_plain &&
      convert_bytes(samples, count, output, out, plane_stride)) {
    find_saturated(samples, channels_, first_pixel, unusable);
    return;
  }
  const std::span<const float> values = codes_->values();
  const auto decode_codes = [&](auto code, auto largest) {
    using Code = decltype(code);
    convert_any(count, correction, output, out, plane_stride, first_pixel, unusable,
                [&](std::size_t k, std::array<float, 3>& light, bool& is_saturated) {
                  for (std::size_t c = 0; c < 3; ++c) {
                    const std::size_t channel = channels_ >= 3 ? c : 0;
                    const auto value = sample_at<Code>(samples, k * channels_ + channel);
                    is_saturated = is_saturated || value == largest;
                    light[c] = values[value];
                  }
                });
  };
  switch (codes_->type()) {
    case SampleType::kUint8:
      return decode_codes(std::uint8_t{}, 255);
    case SampleType::kUint16:
      return decode_codes(std::uint16_t{}, 65535);
    case SampleType::kHalf:
      return decode_codes(std::uint16_t{}, -1);
    case SampleType::kFloat:
      break;
  }
  const bool is_linear = codes_->transfer().kind == Transfer::Kind::kLinear;
  convert_any(count, correction, output, out, plane_stride, first_pixel, unusable,
              [&](std::size_t k, std::array<float, 3>& light, bool&) {
                for (std::size_t c = 0; c < 3; ++c) {
                  const std::size_t channel = channels_ >= 3 ? c : 0;
                  const auto value = sample_at<float>(samples, k * channels_ + channel);
                  light[c] = is_linear ? value : static_cast<float>(to_linear(codes_->transfer(), value));
                }
              });
}

}  // namespace brdfit::io
