// Random numbers that depend on a seed and a counter alone, so that neither threads nor order matter.
#ifndef BRDFIT_DATA_SYNTHETIC_COUNTER_RANDOM_H_
#define BRDFIT_DATA_SYNTHETIC_COUNTER_RANDOM_H_

#include <cmath>
#include <cstdint>
#include <numbers>

namespace brdfit::synthetic {

// The output function of SplitMix64 (Steele, Lea and Flood 2014).
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

// Element k of SplitMix64's sequence, for a start that seed and stream determine. Streams keep apart what is
// drawn for different purposes.
class CounterRandom {
 public:
  constexpr CounterRandom(std::uint64_t seed, std::uint64_t stream)
      : start_(mix_bits(mix_bits(seed + kStep) + kStep * (stream + 1))) {}

  constexpr std::uint64_t bits(std::uint64_t counter) const {
    return mix_bits(start_ + kStep * (counter + 1));
  }

  // Evenly in (0, 1), both ends excluded: 52 bits and a half fit a double exactly.
  constexpr double uniform(std::uint64_t counter) const {
    return (static_cast<double>(bits(counter) >> 12) + 0.5) * 0x1p-52;
  }

  // Standard normal (Box and Muller 1958). Uses the uniform numbers 2 counter and 2 counter + 1.
  double normal(std::uint64_t counter) const {
    const double radius = std::sqrt(-2.0 * std::log(uniform(2 * counter)));
    return radius * std::cos(2.0 * std::numbers::pi * uniform(2 * counter + 1));
  }

  // Evenly in 0 ... count - 1, for count > 0 (the bias is below count / 2^64).
  constexpr std::uint64_t below(std::uint64_t counter, std::uint64_t count) const {
    return bits(counter) % count;
  }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15U;
  std::uint64_t start_;
};

}  // namespace brdfit::synthetic

#endif  // BRDFIT_DATA_SYNTHETIC_COUNTER_RANDOM_H_
