// How the samples of an image encode light.
#ifndef BRDFIT_IO_TRANSFER_H_
#define BRDFIT_IO_TRANSFER_H_

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "io/image_reader.h"

namespace brdfit::io {

struct Transfer {
  enum class Kind {
    kLinear,
    kSrgb,    // IEC 61966-2-1
    kRec709,  // the camera's curve of ITU-R BT.709
    kGamma,   // light = code^gamma
  };
  Kind kind = Kind::kLinear;
  double gamma = 1.0;  // of kGamma

  friend bool operator==(const Transfer& a, const Transfer& b) {
    return a.kind == b.kind && (a.kind != Kind::kGamma || a.gamma == b.gamma);
  }
};

// "linear", "srgb", "rec709", "gamma 2.2" (any number from 0.2 to 5). Nothing for other text.
std::optional<Transfer> transfer_from(std::string_view text);
inline constexpr std::string_view kTransferNames = "linear, srgb, rec709 or gamma G (such as gamma 2.2)";
std::string name_of(const Transfer& transfer);

// Linear light of a code, 1 for 1. Codes above 1 continue the curve; those below 0 mirror it.
double to_linear(const Transfer& transfer, double code);

// The inverse.
double to_code(const Transfer& transfer, double linear);

// What an image's own metadata says of its transfer; nothing where it does not say. A JPEG without a profile
// says nothing, nor does a PNG without sRGB, gAMA or cICP chunk.
std::optional<Transfer> transfer_in_file(const std::filesystem::path& file, const ImageHeader& header);

// What is taken where nobody says: srgb for 8 bit, linear for all else.
Transfer usual_transfer(SampleType type);

}  // namespace brdfit::io

#endif  // BRDFIT_IO_TRANSFER_H_
