// Numbers and settings in words.
#include "render/caption.h"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <string_view>

namespace brdfit::render {
namespace {

// "1e-05" as "1e−5": a real minus sign, no padding of the exponent.
std::string with_minus_signs(std::string_view number) {
  std::string text;
  for (std::size_t k = 0; k < number.size(); ++k) {
    const bool in_exponent = number.substr(0, k).find('e') != std::string_view::npos;
    if (in_exponent && (number[k] == '+' || (number[k] == '0' && !std::isdigit(number[k - 1])))) continue;
    if (number[k] == '-') {
      text += "−";
    } else {
      text += number[k];
    }
  }
  return text;
}

std::string_view words_of(ViewTransform transform) {
  switch (transform) {
    case ViewTransform::kLinear:
      return "linear (no display curve)";
    case ViewTransform::kGranTurismo:
      return "Gran Turismo tone mapping";
    case ViewTransform::kSrgb:
      break;
  }
  return "sRGB";
}

std::string_view words_of(PixelState state) {
  switch (state) {
    case PixelState::kBelowHorizon:
      return "below the horizon (dark)";
    case PixelState::kUnmeasured:
      return "not measured (hatched grey)";
    case PixelState::kNotFinite:
      return "NaN or infinite (hatched magenta)";
    case PixelState::kNegative:
      return "negative (hatched cyan)";
    case PixelState::kValue:
    case PixelState::kOutside:
      break;
  }
  return "";
}

}  // namespace

std::string pretty_number(double value, int digits) {
  const double size = std::abs(value);
  if (size == 0.0) return "0";
  return with_minus_signs(size >= std::pow(10.0, digits) && size < 1e6
                              ? fmt::format("{:.0f}", value)
                              : fmt::format("{:.{}g}", value, digits));
}

std::string describe_view(const ViewOptions& view) {
  const double stops = view.exposure_stops;
  std::string text = fmt::format("exposure {}{} {}", stops > 0.0 ? "+" : "", pretty_number(stops, 4),
                                 std::abs(stops) == 1.0 ? "stop" : "stops");
  text += ", " + std::string(words_of(view.transform));
  if (view.channel == Channel::kLuminance) text += ", luminance";
  if (view.channel != Channel::kRgb && view.channel != Channel::kLuminance) {
    text += ", " + std::string(name_of(view.channel)) + " channel";
  }
  return text;
}

std::string describe_quantity(Quantity quantity) {
  return quantity == Quantity::kF ? "f (sr⁻¹)" : "f cos θi (sr⁻¹)";
}

std::string describe_slice(const SliceOptions& slice) {
  std::string text = fmt::format("φd = {}°, ", pretty_number(slice.phi_d_deg, 6));
  text += describe_quantity(slice.quantity);
  if (slice.sampling == SliceSampling::kStored) text += ", at the stored angles";
  return text;
}

std::vector<MissingNote> missing_notes(const std::array<std::size_t, kPixelStateCount>& counts) {
  std::vector<MissingNote> notes;
  for (const PixelState state :
       {PixelState::kUnmeasured, PixelState::kNotFinite, PixelState::kNegative, PixelState::kBelowHorizon}) {
    const std::size_t count = counts[static_cast<std::size_t>(state)];
    if (count == 0) continue;
    notes.push_back(
        {state, fmt::format("{} {} {}", count, count == 1 ? "pixel" : "pixels", words_of(state))});
  }
  return notes;
}

}  // namespace brdfit::render
