// What a candidate gains over another in folds of held-out lights, and whether that is more than chance.
#ifndef BRDFIT_BAKE_FOLD_GAIN_H_
#define BRDFIT_BAKE_FOLD_GAIN_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace brdfit::bake {

// A candidate must help in this share of the folds: where it fails it may fail by far.
inline constexpr double kHelpedFolds = 0.75;

struct FoldGain {
  double mean = 0.0;            // of the error that goes away in a fold
  double standard_error = 0.0;  // of that mean
  double helped = 0.0;          // share of the folds with a gain, in [0, 1]
};

inline double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

// Errors per fold, as many of one as of the other, at least one.
inline FoldGain fold_gain(const std::vector<double>& with, const std::vector<double>& without) {
  const auto folds = static_cast<double>(without.size());
  FoldGain gain;
  gain.mean = (sum(without) - sum(with)) / folds;
  double squares = 0.0;
  for (std::size_t f = 0; f < without.size(); ++f) {
    const double one = without[f] - with[f];
    if (one > 0.0) gain.helped += 1.0 / folds;
    squares += (one - gain.mean) * (one - gain.mean);
  }
  gain.standard_error = std::sqrt(squares / (folds * std::max(folds - 1.0, 1.0)));
  return gain;
}

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_FOLD_GAIN_H_
