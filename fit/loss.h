// The losses under which a material is fitted: how f cos_i is transformed before differences are squared.
#ifndef BRDFIT_FIT_LOSS_H_
#define BRDFIT_FIT_LOSS_H_

#include <optional>
#include <span>
#include <string_view>

namespace brdfit::fit {

// Values are used as ints in vector code (fit/loss_kernel.h).
enum class Loss {
  kLogRatio = 0,  // ln(f cos_i + 1e-3): the default
  kCubeRoot = 1,  // cbrt(f cos_i + 1e-6)
  kLinear = 2,    // f cos_i
  kSrgb = 3,      // sRGB transfer of pi f cos_i, continued above 1 so that highlights keep a gradient
  kSlice = 4,     // min(f, 1), without the cosine: what the measure "slice %" looks at
};

std::string_view name_of(Loss loss);  // "log-ratio", "cube-root", "linear", "srgb", "slice"
std::optional<Loss> loss_by_name(std::string_view name);
std::span<const Loss> all_losses();

// What a loss is beside its transform.
//
// The log-ratio is judged by its mean absolute value, so large residuals must not count by their squares. It
// also compares f cos_i, and gives up bright cells towards grazing angles for dark ones elsewhere. A second
// residual, min(f, 1) - min(measured f, 1), keeps what a display shows of them: over cells below 80 deg in
// theta_h and theta_d, with a share that grows as the cosines fall.
struct LossShape {
  // Residuals beyond this count by their absolute value rather than their square (pseudo-Huber); 0: squares
  // throughout.
  double robust_width = 0.0;
  // The second residual's cost, as a share of the first's, is this / sqrt(cos_h cos_d); 0: there is none.
  double clipped_share = 0.0;
  double clipped_width = 0.0;  // as robust_width, for the second residual
};

LossShape shape_of(Loss loss);

// The transform of a measured f (sr^-1) at cos_i, as the residual compares it.
double loss_target(Loss loss, double f, double cos_i);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_LOSS_H_
