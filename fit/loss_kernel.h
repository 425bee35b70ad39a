// The transforms of fit/loss.h and their slopes, for double and for lanes.
#ifndef BRDFIT_FIT_LOSS_KERNEL_H_
#define BRDFIT_FIT_LOSS_KERNEL_H_

#include "brdf/kernel/math.h"

#define BRDFIT_LOSS_LOG_RATIO 0
#define BRDFIT_LOSS_CUBE_ROOT 1
#define BRDFIT_LOSS_LINEAR 2
#define BRDFIT_LOSS_SRGB 3
#define BRDFIT_LOSS_SLICE 4

namespace brdfit::fit {

// The floor of the log-ratio (in f cos_i) and of the cube root.
inline constexpr double kLogFloor = 1e-3;
inline constexpr double kCubeRootFloor = 1e-6;

template <class T>
struct Transformed {
  T value;
  T slope;  // with respect to y
};

// y = f cos_i >= 0.
template <class T>
inline Transformed<T> transform(int loss, T y, T cos_i) {
  using kernel::select;
  using std::exp;
  using std::log;
  if (loss == BRDFIT_LOSS_LOG_RATIO) {
    const T shifted = y + T(kLogFloor);
    return {log(shifted), T(1.0) / shifted};
  }
  if (loss == BRDFIT_LOSS_CUBE_ROOT) {
    const T shifted = y + T(kCubeRootFloor);
    const T root = exp(log(shifted) * T(1.0 / 3.0));
    return {root, root / (T(3.0) * shifted)};
  }
  if (loss == BRDFIT_LOSS_SRGB) {
    const T x = y * T(BRDF_PI);
    const auto dark = x < T(0.0031308);
    const T safe = select(dark, T(0.0031308), x);
    const T power = T(1.055) * exp(log(safe) * T(1.0 / 2.4));
    return {select(dark, T(12.92) * x, power - T(0.055)),
            T(BRDF_PI) * select(dark, T(12.92), power / (T(2.4) * safe))};
  }
  if (loss == BRDFIT_LOSS_SLICE) {
    const T f = y / cos_i;
    const auto clipped = f > T(1.0);
    return {select(clipped, T(1.0), f), select(clipped, T(0.0), T(1.0) / cos_i)};
  }
  return {y, T(1.0)};
}

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_LOSS_KERNEL_H_
