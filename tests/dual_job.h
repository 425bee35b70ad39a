// What the test of dual numbers hands to vector code.
#ifndef BRDFIT_TESTS_DUAL_JOB_H_
#define BRDFIT_TESTS_DUAL_JOB_H_

#include <cstddef>

namespace brdfit::simd {

inline constexpr std::size_t kDualCount = 64;
inline constexpr std::size_t kDualOperations = 16;

// Two variables, and the values and slopes (by x, by y) of every operation at them.
struct DualJob {
  double x[kDualCount];
  double y[kDualCount];
  double value[kDualOperations][kDualCount];
  double slope[2][kDualOperations][kDualCount];
};

}  // namespace brdfit::simd

#endif  // BRDFIT_TESTS_DUAL_JOB_H_
