// Ranges by descent on the error itself.
#include "bake/code_ranges.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace brdfit::bake {
namespace {

constexpr double kStepFactor = 0.9;
constexpr int kMostRounds = 3;
constexpr int kMostMoves = 12;        // of one lobe in a round, in one way
constexpr double kLeastGain = 0.005;  // of a round, below which another is not worth its time

// Ranges and what they cost, changed one lobe at a time.
class Descent {
 public:
  Descent(std::span<const CodeSearch> texels, Quantiser start)
      : texels_(texels), best_(std::move(start)), error_(rounding_error(texels, best_)) {}

  void start_from(std::vector<RealisRange> ranges) { keep_if_better({best_.bits, std::move(ranges)}); }

  void round() {
    for (std::size_t lobe = 0; lobe < best_.ranges.size(); ++lobe) {
      if (!(best_.ranges[lobe].step > 0.0)) continue;
      for (const double factor : {kStepFactor, 1.0 / kStepFactor}) change_on(lobe, factor, 0);
      for (const int move : {-1, 1}) change_on(lobe, 1.0, move);
    }
  }

  double error() const { return error_; }
  const std::vector<RealisRange>& ranges() const { return best_.ranges; }

 private:
  void change_on(std::size_t lobe, double factor, int move) {
    int moves = 0;
    while (moves < kMostMoves && change(lobe, factor, move)) ++moves;
  }

  bool change(std::size_t lobe, double factor, int move) {
    Quantiser next = best_;
    RealisRange& range = next.ranges[lobe];
    range.step *= factor;
    range.zero += move;
    return range.zero >= 0 && range.zero <= realis_top_code(next.bits) && keep_if_better(std::move(next));
  }

  bool keep_if_better(Quantiser next) {
    const double error = rounding_error(texels_, next);
    if (!(error < error_)) return false;
    error_ = error;
    best_ = std::move(next);
    return true;
  }

  std::span<const CodeSearch> texels_;
  Quantiser best_;
  double error_;
};

}  // namespace

RealisRange range_between(double low, double high, int bits) {
  if (!(low <= 0.0 && high >= 0.0 && std::isfinite(high - low)))
    throw std::invalid_argument("range_between: 0 is not between the ends");
  const int top = realis_top_code(bits);
  const double width = high - low;
  if (!(width > 0.0)) return {0.0, 0};
  // The whole zero point on one or the other side of where 0 lies between the ends.
  RealisRange best{std::numeric_limits<double>::infinity(), 0};
  const int beside = static_cast<int>(std::floor(-low / width * top));
  for (const int zero : {std::min(beside, top), std::min(beside + 1, top)}) {
    if ((zero == 0 && low < 0.0) || (zero == top && high > 0.0)) continue;
    const double step = std::max(zero > 0 ? -low / zero : 0.0, zero < top ? high / (top - zero) : 0.0);
    if (step < best.step) best = {step, zero};
  }
  return best;
}

std::vector<RealisRange> quantile_ranges(std::span<const CodeSearch> texels, std::size_t lobes, int bits,
                                         double tail) {
  if (!(tail >= 0.0 && tail < 0.5)) throw std::invalid_argument("quantile_ranges: tail outside [0, 0.5)");
  std::vector<std::vector<double>> values(lobes);
  for (const CodeSearch& texel : texels) {
    for (std::size_t k = 0; k < texel.lobes().size(); ++k) {
      values.at(static_cast<std::size_t>(texel.lobes()[k]))
          .push_back(texel.amplitudes()[static_cast<Eigen::Index>(k)]);
    }
  }
  std::vector<RealisRange> ranges(lobes);
  for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
    std::vector<double>& sorted = values[lobe];
    if (sorted.empty()) continue;
    std::sort(sorted.begin(), sorted.end());
    const auto cut = static_cast<std::size_t>(tail * static_cast<double>(sorted.size()));
    ranges[lobe] =
        range_between(std::min(sorted[cut], 0.0), std::max(sorted[sorted.size() - 1 - cut], 0.0), bits);
  }
  return ranges;
}

double rounding_error(std::span<const CodeSearch> texels, const Quantiser& quantiser) {
  std::vector<double> errors(texels.size());
  tbb::parallel_for(std::size_t{0}, texels.size(), [&](std::size_t k) {
    std::array<int, kMaxLobes> codes{};
    errors[k] = texels[k].find(quantiser, {}, search_steps(quantiser.bits, texels[k].lobes().size()),
                               std::span(codes).first(quantiser.ranges.size()));
  });
  return std::accumulate(errors.begin(), errors.end(), 0.0);
}

std::vector<RealisRange> fitted_ranges(std::span<const CodeSearch> texels, std::size_t lobes, int bits) {
  Descent descent(texels, {bits, quantile_ranges(texels, lobes, bits, kTails[0])});
  for (const double tail : kTails) descent.start_from(quantile_ranges(texels, lobes, bits, tail));
  // Steps of many bits are so fine that moving a range's ends gains nothing.
  const int rounds = is_searched(bits) ? kMostRounds : 0;
  for (int round = 0; round < rounds; ++round) {
    const double before = descent.error();
    descent.round();
    if (!(descent.error() < (1.0 - kLeastGain) * before)) break;
  }
  return descent.ranges();
}

}  // namespace brdfit::bake
