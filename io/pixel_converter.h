// From the samples of a picture's file to planes of linear Rec.709 floats.
#ifndef BRDFIT_IO_PIXEL_CONVERTER_H_
#define BRDFIT_IO_PIXEL_CONVERTER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "io/colour_chart.h"
#include "io/transfer.h"

namespace brdfit::io {

// Linear values of all codes of a sample type; for floats, which have too many, none.
class CodeTable {
 public:
  CodeTable(SampleType type, const Transfer& transfer);
  SampleType type() const { return type_; }
  const Transfer& transfer() const { return transfer_; }
  std::span<const float> values() const { return values_; }

 private:
  SampleType type_;
  Transfer transfer_;
  std::vector<float> values_;
};

// Pixels whose values cannot be used.
struct Unusable {
  std::vector<std::uint32_t> pixels;  // ascending
  std::size_t saturated = 0;
  std::size_t non_finite = 0;
};

// Frames that every picture is corrected by, for the pixels that are converted: planes [3][pixel], or empty.
struct CorrectionPlanes {
  std::span<const float> dark;  // taken off
  std::span<const float> gain;  // then multiplied with: that of the flat frame
};

// Converts the pixels of one picture: code to light, less dark, times gain and scale, through the matrix. A
// pixel is saturated where a channel has the largest code of an integer type; where a channel is not finite
// all three become 0. Values below 0 (noise about the dark frame) stay.
class PixelConverter {
 public:
  enum class Output { kRgb, kLuminance };

  // channels: of the file: 1 or 2 are grey, of more the first three count. scale: 1 / exposure.
  PixelConverter(std::shared_ptr<const CodeTable> codes, int channels, double scale, const Matrix3& matrix);

  // samples: count pixels as in the file. out: 3 planes (or 1) of count values, plane_stride apart. unusable:
  // appended to, with first_pixel as the number of the first one.
  void convert(std::span<const std::byte> samples, std::size_t count, const CorrectionPlanes& correction,
               Output output, float* out, std::size_t plane_stride, std::uint32_t first_pixel,
               Unusable& unusable) const;

 private:
  using Table8 = std::array<float, 256>;

  bool convert_bytes(std::span<const std::byte> samples, std::size_t count, Output output, float* out,
                     std::size_t plane_stride) const;
  template <class Decode>
  void convert_any(std::size_t count, const CorrectionPlanes& correction, Output output, float* out,
                   std::size_t plane_stride, std::uint32_t first_pixel, Unusable& unusable,
                   const Decode& decode) const;

  std::shared_ptr<const CodeTable> codes_;
  std::size_t channels_;
  bool is_diagonal_;
  std::array<std::array<float, 3>, 3> matrix_;  // with the scale
  std::array<float, 3> luminance_;              // of the scaled matrix
  std::array<Table8, 3> rgb8_;                  // of 8-bit codes: the diagonal matrix's channels
  std::array<Table8, 3> luminance8_;            // and the parts of luminance
};

}  // namespace brdfit::io

#endif  // BRDFIT_IO_PIXEL_CONVERTER_H_
