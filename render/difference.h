// Differences of two pictures, coloured with a bar to read them by.
#ifndef BRDFIT_RENDER_DIFFERENCE_H_
#define BRDFIT_RENDER_DIFFERENCE_H_

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/image.h"
#include "render/view.h"

namespace brdfit::render {

enum class DifferenceKind {
  kSigned,    // model - reference
  kAbsolute,  // |model - reference|
  kLogRatio,  // ln((model + 1e-3) / (reference + 1e-3)), as the log-ratio measure compares
};

std::string_view name_of(DifferenceKind kind);  // "signed", "absolute", "log-ratio"
std::optional<DifferenceKind> difference_kind_by_name(std::string_view name);

// One number per pixel: luminance, or the channel that is shown (the mean of the three for log-ratio of RGB).
struct Difference {
  int width = 0;
  int height = 0;
  std::vector<float> value;  // 0 where the state is not kValue
  // kValue where both have one; otherwise the reference's state, or the model's.
  std::vector<PixelState> state;
};

// Throws std::invalid_argument when the sizes differ. Exposure multiplies signed and absolute differences;
// those beyond the range of a float are its largest number. For log-ratio a negative value counts as 0.
Difference difference_of(const Image& model, const Image& reference, DifferenceKind kind,
                         const ViewOptions& view);

// A round number (1, 2 or 5 times a power of ten) that at least 98% of the values of all do not exceed; 1e-3
// at least.
double difference_range(std::span<const Difference> all);

// Share of the values of all that are beyond the range, in [0, 1]; 0 if there are none.
double share_beyond(std::span<const Difference> all, double range);

// Signed kinds: blue below, white at 0, red above. Absolute: white to dark red. Values beyond the range have
// the end's colour. Lightness falls evenly from white to both ends. Pixels without a value as in to_picture.
// Throws std::invalid_argument unless range is finite and above 0.
Picture difference_picture(const Difference& difference, DifferenceKind kind, double range);

// The bar that explains the colours: height pixels high, with ticks and numbers and the unit (may be empty).
// Throws as difference_picture.
Picture colour_bar(DifferenceKind kind, double range, const std::string& unit, int height, int text_px);

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_DIFFERENCE_H_
