// Rec.709 to I, T, P (ITU-R BT.2100-2 ICtCp with PQ, scaled by BT.2124), for double and for vectors of it.
#ifndef BRDFIT_RENDER_ITP_H_
#define BRDFIT_RENDER_ITP_H_

#include <cmath>
#include <cstddef>

#include "brdf/kernel/math.h"

namespace brdfit::render {

template <class T>
struct Itp {
  T i;
  T t;
  T p;
};

// Linear Rec.709 to BT.2100's LMS: BT.2087's matrix to BT.2020, then BT.2100's. Every weight is positive, so
// that colours without negative channels have none in LMS.
struct LmsWeights {
  double row[3][3];
};
constexpr LmsWeights lms_from_rec709() {
  constexpr double kRec2020[3][3] = {{0.627403895934699, 0.329283038377884, 0.043313065687417},
                                     {0.069097289358232, 0.919540395075458, 0.011362315566310},
                                     {0.016391438875150, 0.088013307877226, 0.895595253247624}};
  constexpr double kLms[3][3] = {{1688.0, 2146.0, 262.0}, {683.0, 2951.0, 462.0}, {99.0, 309.0, 3688.0}};
  LmsWeights result = {};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      for (int k = 0; k < 3; ++k) {
        result.row[row][column] += kLms[row][k] / 4096.0 * kRec2020[k][column];
      }
    }
  }
  return result;
}
inline constexpr LmsWeights kLmsFromRec709 = lms_from_rec709();

// The inverse PQ transfer (SMPTE ST 2084) of a linear value of which 1 is 100 cd/m2; below about 1e-28 it is
// that of 1e-30, which no display shows.
template <class T>
T pq_from_linear(T value) {
  using std::exp;
  using std::log;
  const T tiny(1e-30);
  const T absolute = value * T(0.01);
  const T power = exp(log(kernel::at_least(absolute, tiny)) * T(2610.0 / 16384.0));
  const T ratio = (T(3424.0 / 4096.0) + T(2413.0 / 128.0) * power) / (T(1.0) + T(2392.0 / 128.0) * power);
  return exp(log(ratio) * T(2523.0 / 32.0));
}

template <class T>
Itp<T> itp_of(T red, T green, T blue) {
  T lms[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const double* weight = kLmsFromRec709.row[k];
    lms[k] = pq_from_linear(T(weight[0]) * red + T(weight[1]) * green + T(weight[2]) * blue);
  }
  return {T(0.5) * (lms[0] + lms[1]),
          T(0.5) * (T(6610.0 / 4096.0) * lms[0] - T(13613.0 / 4096.0) * lms[1] + T(7003.0 / 4096.0) * lms[2]),
          T(17933.0 / 4096.0) * lms[0] - T(17390.0 / 4096.0) * lms[1] - T(543.0 / 4096.0) * lms[2]};
}

}  // namespace brdfit::render

#endif  // BRDFIT_RENDER_ITP_H_
