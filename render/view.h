// From values to what a display shows: exposure, channel, tone mapping, 8 bits.
#ifndef BRDFIT_RENDER_VIEW_H_
#define BRDFIT_RENDER_VIEW_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "render/image.h"

namespace brdfit::render {

enum class ViewTransform {
  kLinear,       // clipped to [0, 1]; the 8-bit code is proportional to the value
  kSrgb,         // clipped to [0, 1], then the sRGB curve (IEC 61966-2-1)
  kGranTurismo,  // Uchimura's tone mapper with its linear section (CEDEC 2017), then the sRGB curve
};

enum class Channel { kRgb, kRed, kGreen, kBlue, kLuminance };  // a single one is shown as grey

struct ViewOptions {
  ViewTransform transform = ViewTransform::kSrgb;
  double exposure_stops = 0.0;  // values are multiplied by 2^exposure_stops first
  Channel channel = Channel::kRgb;
};

// "linear", "srgb", "gt"; "rgb", "red", "green", "blue", "luminance".
std::string_view name_of(ViewTransform transform);
std::string_view name_of(Channel channel);
std::optional<ViewTransform> view_transform_by_name(std::string_view name);
std::optional<Channel> channel_by_name(std::string_view name);

// Gran Turismo tone mapper with the published defaults: maximum 1, contrast 1, linear section from 0.22 over
// 0.4 of the rest, black tightness 1.33, pedestal 0. value >= 0; the result is at most 1.
double gran_turismo(double value);

// Display value in [0, 1] of a linear value (before rounding to 8 bits), exposure not applied. Negative
// values and NaN, which no Image holds, give 0.
double display_value(ViewTransform transform, double value);

// The 8-bit picture: codes are 255 display_value(2^exposure_stops value), rounded to nearest. Pixels without
// a value are drawn by their state: outside dark grey, below the horizon darker still, unmeasured hatched
// grey, not finite hatched magenta, negative hatched cyan. Parallel over rows. Throws std::invalid_argument
// when the exposure is not finite.
Picture to_picture(const Image& image, const ViewOptions& options);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_VIEW_H_
