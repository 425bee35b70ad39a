// Curves, and where files say which one is theirs.
#include "io/transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "io/image_layout.h"

namespace brdfit::io {
namespace {

constexpr double kLeastGamma = 0.2;
constexpr double kLargestGamma = 5.0;

std::optional<double> number_in(std::string_view text) {
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{} || result.ptr != text.data() + text.size()) return {};
  return value;
}

std::optional<Transfer> gamma_transfer(std::string_view number) {
  const std::optional<double> gamma = number_in(number);
  if (!gamma || !(*gamma >= kLeastGamma && *gamma <= kLargestGamma)) return {};
  return Transfer{Transfer::Kind::kGamma, *gamma};
}

// A curve that is linear up to a knee: slope, knee (of the code), offset, exponent.
struct KneeCurve {
  double slope, knee, offset, exponent;
  double to_linear(double code) const {
    return code <= knee ? code / slope : std::pow((code + offset) / (1.0 + offset), exponent);
  }
  double to_code(double linear) const {
    return linear * slope <= knee ? linear * slope
                                  : (1.0 + offset) * std::pow(linear, 1.0 / exponent) - offset;
  }
};
constexpr KneeCurve kSrgbCurve = {12.92, 0.04045, 0.055, 2.4};
constexpr KneeCurve kRec709Curve = {4.5, 0.081, 0.099, 1.0 / 0.45};

// OpenImageIO's names of colour spaces, in lower case.
std::optional<Transfer> transfer_named(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (name == "srgb") return Transfer{Transfer::Kind::kSrgb};
  if (name == "linear" || name == "lin_srgb" || name == "scene_linear") return Transfer{};
  if (name == "rec709") return Transfer{Transfer::Kind::kRec709};
  if (name.starts_with("gammacorrected")) return gamma_transfer(std::string_view(name).substr(14));
  if (name.starts_with("gamma")) return gamma_transfer(std::string_view(name).substr(5));
  return {};
}

}  // namespace

std::optional<Transfer> transfer_from(std::string_view text) {
  if (text == "linear") return Transfer{};
  if (text == "srgb") return Transfer{Transfer::Kind::kSrgb};
  if (text == "rec709") return Transfer{Transfer::Kind::kRec709};
  constexpr std::string_view kGamma = "gamma ";
  if (text.starts_with(kGamma)) return gamma_transfer(text.substr(kGamma.size()));
  return {};
}

std::string name_of(const Transfer& transfer) {
  switch (transfer.kind) {
    case Transfer::Kind::kLinear:
      return "linear";
    case Transfer::Kind::kSrgb:
      return "srgb";
    case Transfer::Kind::kRec709:
      return "rec709";
    case Transfer::Kind::kGamma:
      break;
  }
  return fmt::format("gamma {}", transfer.gamma);
}

double to_linear(const Transfer& transfer, double code) {
  if (code < 0.0) return -to_linear(transfer, -code);
  switch (transfer.kind) {
    case Transfer::Kind::kLinear:
      return code;
    case Transfer::Kind::kSrgb:
      return kSrgbCurve.to_linear(code);
    case Transfer::Kind::kRec709:
      return kRec709Curve.to_linear(code);
    case Transfer::Kind::kGamma:
      break;
  }
  return std::pow(code, transfer.gamma);
}

double to_code(const Transfer& transfer, double linear) {
  if (linear < 0.0) return -to_code(transfer, -linear);
  switch (transfer.kind) {
    case Transfer::Kind::kLinear:
      return linear;
    case Transfer::Kind::kSrgb:
      return kSrgbCurve.to_code(linear);
    case Transfer::Kind::kRec709:
      return kRec709Curve.to_code(linear);
    case Transfer::Kind::kGamma:
      break;
  }
  return std::pow(linear, 1.0 / transfer.gamma);
}

std::optional<Transfer> transfer_in_file(const std::filesystem::path& file, const ImageHeader& header) {
  // OpenImageIO names sRGB where these say nothing.
  const bool is_guess =
      (header.format == "jpeg" || header.format == "png") && !layout_of(file).says_colour_space;
  if (is_guess || header.colour_space.empty()) return {};
  return transfer_named(header.colour_space);
}

Transfer usual_transfer(SampleType type) {
  return type == SampleType::kUint8 ? Transfer{Transfer::Kind::kSrgb} : Transfer{};
}

}  // namespace brdfit::io
