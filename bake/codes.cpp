// The search for codes, depth first over lobes.
#include "bake/codes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "brdf/kernel/realis.h"

namespace brdfit::bake {
namespace {

// Of codes whose range no noise reaches the end of.
constexpr int kUnlimitedBits = 16;

}  // namespace

double Quantiser::amplitude(std::size_t lobe, int code) const {
  const RealisRange& range = ranges[lobe];
  return kernel::realis_amplitude(static_cast<double>(code + range.zero), static_cast<double>(range.zero),
                                  range.step);
}

// One search. Errors are sums over lobes, from the last to the first: that of a lobe depends on those after
// it alone, and what exceeds the least error found so far is not followed.
class CodeSearch::Walk {
 public:
  Walk(const CodeSearch& texel, const Quantiser& quantiser, const LobeVector& goal, int steps)
      : texel_(texel), quantiser_(quantiser), goal_(goal), steps_left_(steps) {}

  void choose(Eigen::Index k, double error) {
    if (k < 0) {
      least_ = error;
      found_ = codes_;
      return;
    }
    if (steps_left_ <= 0 && least_ < std::numeric_limits<double>::infinity()) return;
    --steps_left_;
    const auto place = static_cast<std::size_t>(k);
    const auto lobe = static_cast<std::size_t>(texel_.lobes_[place]);
    double target = goal_[k];
    for (Eigen::Index j = k + 1; j < goal_.size(); ++j)
      target -= texel_.feedback_(k, j) * moved_[static_cast<std::size_t>(j)];
    const double step = quantiser_.ranges[lobe].step;
    if (!(step > 0.0)) {
      take(k, 0, 0.0, error + texel_.weights_[k] * target * target);
      return;
    }
    const double position = target / step;
    const int smallest = quantiser_.smallest_code(lobe);
    const int largest = quantiser_.largest_code(lobe);
    int below = static_cast<int>(
        std::clamp(std::floor(position + 0.5), static_cast<double>(smallest), static_cast<double>(largest)));
    int above = below + 1;
    while (below >= smallest || above <= largest) {
      const bool down = above > largest || (below >= smallest && position - below <= above - position);
      const int code = down ? below-- : above++;
      const double off = (code - position) * step;
      const double next = error + texel_.weights_[k] * off * off;
      if (!(next < least_)) return;
      take(k, code, quantiser_.amplitude(lobe, code), next);
    }
  }

  double least() const { return least_; }
  int code(std::size_t place) const { return found_[place]; }

 private:
  void take(Eigen::Index k, int code, double amplitude, double error) {
    const auto place = static_cast<std::size_t>(k);
    codes_[place] = code;
    moved_[place] = amplitude - goal_[k];
    choose(k - 1, error);
  }

  const CodeSearch& texel_;
  const Quantiser& quantiser_;
  const LobeVector& goal_;
  int steps_left_;
  double least_ = std::numeric_limits<double>::infinity();
  std::array<int, kMaxLobes> codes_{};
  std::array<int, kMaxLobes> found_{};
  std::array<double, kMaxLobes> moved_{};  // what rounding adds to amplitudes
};

CodeSearch::CodeSearch(const TexelEquations& equations, std::uint32_t mask)
    : lobes_(lobes_of(mask, equations.b.size())) {
  const TexelEquations part = restricted(equations, lobes_);
  const auto factor = part.a.llt();
  best_ = factor.solve(part.b);
  const LobeMatrix upper = factor.matrixU();
  weights_ = upper.diagonal().array().square();
  feedback_ = upper.diagonal().cwiseInverse().asDiagonal() * upper;
}

double CodeSearch::find(const Quantiser& quantiser, const LobeVector& shift, int steps,
                        std::span<int> codes) const {
  const LobeVector goal = shift.size() > 0 ? LobeVector(best_ + shift) : best_;
  Walk walk(*this, quantiser, goal, steps);
  walk.choose(best_.size() - 1, 0.0);
  std::fill(codes.begin(), codes.end(), 0);
  for (std::size_t k = 0; k < lobes_.size(); ++k) codes[static_cast<std::size_t>(lobes_[k])] = walk.code(k);
  return walk.least();
}

LobeVector CodeSearch::dither(const Quantiser& quantiser, std::span<const double> noise, int steps) const {
  // Noise over the box of one step per lobe covers what codes repeat, and so does what is left of it when
  // the codes next to it are taken away.
  Quantiser unlimited{kUnlimitedBits, quantiser.ranges};
  for (RealisRange& range : unlimited.ranges) range.zero = realis_top_code(kUnlimitedBits) / 2;
  LobeVector spread(best_.size());
  for (std::size_t k = 0; k < lobes_.size(); ++k) {
    const auto lobe = static_cast<std::size_t>(lobes_[k]);
    spread[static_cast<Eigen::Index>(k)] = noise[lobe] * quantiser.ranges[lobe].step;
  }
  Walk walk(*this, unlimited, spread, steps);
  walk.choose(best_.size() - 1, 0.0);
  LobeVector left = spread;
  for (std::size_t k = 0; k < lobes_.size(); ++k) {
    left[static_cast<Eigen::Index>(k)] -=
        unlimited.amplitude(static_cast<std::size_t>(lobes_[k]), walk.code(k));
  }
  return left;
}

std::vector<int> quantise(const TexelEquations& equations, const Quantiser& quantiser, std::uint32_t mask,
                          std::span<const double> noise, int steps, double strength) {
  std::vector<int> codes(static_cast<std::size_t>(equations.b.size()));
  const CodeSearch search(equations, mask);
  LobeVector shift;
  if (!noise.empty()) shift = strength * search.dither(quantiser, noise, steps);
  search.find(quantiser, shift, steps, codes);
  return codes;
}

}  // namespace brdfit::bake
