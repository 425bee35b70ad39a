// Errors of values against references, counted: maximum, percentiles, and the worst of all.
#ifndef BRDFIT_GPU_ERROR_TALLY_H_
#define BRDFIT_GPU_ERROR_TALLY_H_

#include <array>
#include <cstddef>
#include <cstdint>

namespace brdfit {

// How far a value may be from its reference. References above `bright` are judged by relative error, others
// by absolute error.
struct ErrorThreshold {
  double bright = 1e-4;
  double relative = 1e-5;
  double absolute = 1e-6;
  double allowed(double reference) const;  // as an absolute error
};

// Numbers >= 0 by their logarithm, 64 bins to a factor of 2.
class LogHistogram {
 public:
  void add(double value);

  // The smallest number that the given share of all numbers, in (0, 1], does not exceed: up to 1.6% too
  // large, never larger than the maximum. 0 if there are no numbers. Numbers below 1e-18 count as 0.
  double percentile(double share) const;
  double maximum() const { return maximum_; }
  std::uint64_t count() const { return count_; }

 private:
  static constexpr int kLowest = -60;  // powers of 2
  static constexpr int kHighest = 68;
  static constexpr std::size_t kPerOctave = 64;
  static double upper_edge(std::size_t bin);

  std::array<std::uint32_t, (kHighest - kLowest) * kPerOctave + 1> bins_{};  // the first: 0
  std::uint64_t count_ = 0;
  double maximum_ = 0.0;
};

// What one value adds.
struct TalliedError {
  double share;  // error over what is allowed; infinity where the value is not finite
  bool worst;    // larger than all before it
};

// Errors of values against references.
class ErrorTally {
 public:
  explicit ErrorTally(const ErrorThreshold& threshold) : threshold_(threshold) {}

  TalliedError add(double reference, float value);

  const LogHistogram& relative() const { return relative_; }  // of bright references
  const LogHistogram& ulp() const { return ulp_; }            // of bright references, in ulps of float
  const LogHistogram& absolute() const { return absolute_; }  // of the others
  double worst_share() const { return worst_share_; }
  std::uint64_t over() const { return over_; }  // values beyond the threshold
  std::uint64_t not_finite() const {
    return not_finite_;
  }  // values that are NaN or infinite; over() has them too

 private:
  ErrorThreshold threshold_;
  LogHistogram relative_;
  LogHistogram ulp_;
  LogHistogram absolute_;
  double worst_share_ = -1.0;
  std::uint64_t over_ = 0;
  std::uint64_t not_finite_ = 0;
};

}  // namespace brdfit

#endif  // BRDFIT_GPU_ERROR_TALLY_H_
