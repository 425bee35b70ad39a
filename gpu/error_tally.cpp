// Bins by exponent and leading digits.
#include "gpu/error_tally.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brdfit {
namespace {

// The distance between floats around x > 0.
double float_ulp(double x) {
  const int exponent = std::max(std::ilogb(x), std::numeric_limits<float>::min_exponent - 1);
  return std::ldexp(1.0, exponent - (std::numeric_limits<float>::digits - 1));
}

}  // namespace

double ErrorThreshold::allowed(double reference) const {
  const double size = std::fabs(reference);
  return size > bright ? relative * size : absolute;
}

void LogHistogram::add(double value) {
  ++count_;
  maximum_ = std::max(maximum_, value);
  if (!(value >= std::ldexp(1.0, kLowest))) {
    ++bins_[0];
    return;
  }
  int exponent = 0;
  const double mantissa =
      std::frexp(std::min(value, std::nextafter(std::ldexp(1.0, kHighest), 0.0)), &exponent);
  const auto step = static_cast<std::size_t>((mantissa - 0.5) * 2.0 * kPerOctave);
  ++bins_[1 + static_cast<std::size_t>(exponent - 1 - kLowest) * kPerOctave + step];
}

double LogHistogram::upper_edge(std::size_t bin) {
  if (bin == 0) return 0.0;
  const int exponent = kLowest + static_cast<int>((bin - 1) / kPerOctave);
  const double step = static_cast<double>((bin - 1) % kPerOctave + 1) / kPerOctave;
  return std::ldexp(1.0 + step, exponent);
}

double LogHistogram::percentile(double share) const {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t below = 0;
  // The last bin has what is larger too.
  for (std::size_t bin = 0; bin + 1 < bins_.size(); ++bin) {
    below += bins_[bin];
    if (below >= wanted) return std::min(upper_edge(bin), maximum_);
  }
  return maximum_;
}

TalliedError ErrorTally::add(double reference, float value) {
  double share = std::numeric_limits<double>::infinity();
  if (std::isfinite(value)) {
    const double error = std::fabs(static_cast<double>(value) - reference);
    const double size = std::fabs(reference);
    share = error / threshold_.allowed(reference);
    if (size > threshold_.bright) {
      relative_.add(error / size);
      ulp_.add(error / float_ulp(size));
    } else {
      absolute_.add(error);
    }
  } else {
    ++not_finite_;
  }
  if (!(share <= 1.0)) ++over_;
  const bool worst = share > worst_share_;
  if (worst) worst_share_ = share;
  return {share, worst};
}

}  // namespace brdfit
