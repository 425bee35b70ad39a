// What pictures say in words: numbers, view, slice, pixels without a value.
#ifndef BRDFIT_RENDER_CAPTION_H_
#define BRDFIT_RENDER_CAPTION_H_

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "render/image.h"
#include "render/slice.h"
#include "render/view.h"

namespace brdfit::render {

// At most `digits` significant digits, with a real minus sign: "0.05", "−1200", "2e−5".
std::string pretty_number(double value, int digits = 3);

// "exposure +1.5 stops, sRGB, red channel".
std::string describe_view(const ViewOptions& view);

// "f cos θi (sr⁻¹)".
std::string describe_quantity(Quantity quantity);

// "φd = 90°, f (sr⁻¹), at the stored angles".
std::string describe_slice(const SliceOptions& slice);

// A state that a picture shows, and how many of its pixels are in it.
struct MissingNote {
  PixelState state = PixelState::kUnmeasured;
  std::string text;  // "312 pixels not measured (hatched grey)"
};

// Of pixels by state, as Image::counts() gives them. kValue and kOutside need no note.
std::vector<MissingNote> missing_notes(const std::array<std::size_t, kPixelStateCount>& counts);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_CAPTION_H_
