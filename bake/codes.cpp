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
      : feedback_(texel.feedback_),
        weights_(texel.weights_),
        goal_(goal),
        places_(static_cast<std::size_t>(goal.size())),
        steps_left_(steps) {
    for (std::size_t place = 0; place < places_; ++place) {
      const auto lobe = static_cast<std::size_t>(texel.lobes_[place]);
      const RealisRange& range = quantiser.ranges[lobe];
      grid_[place] = {range.step, static_cast<double>(range.zero),
                      static_cast<double>(quantiser.smallest_code(lobe)),
                      static_cast<double>(quantiser.largest_code(lobe))};
    }
    if (places_ == 0) {
      least_ = 0.0;
      return;
    }
    std::copy_n(goal.data(), places_, target_[places_ - 1].begin());
    choose(places_ - 1, 0.0);
  }

  double least() const { return least_; }
  int code(std::size_t place) const { return static_cast<int>(found_[place]); }

 private:
  // Codes of a lobe, as doubles: nothing here leaves them.
  struct Grid {
    double step, zero, smallest, largest;
  };

  void choose(std::size_t k, double error) {
    if (steps_left_ <= 0 && least_ < std::numeric_limits<double>::infinity()) return;
    --steps_left_;
    const Grid& grid = grid_[k];
    const double target = target_[k][k];
    const double weight = weights_[static_cast<Eigen::Index>(k)];
    if (!(grid.step > 0.0)) {
      take(k, 0.0, 0.0, error + weight * target * target);
      return;
    }
    const double position = target / grid.step;
    double below = nearest(std::clamp(position, grid.smallest, grid.largest));
    double above = below + 1.0;
    while (below >= grid.smallest || above <= grid.largest) {
      const bool down =
          above > grid.largest || (below >= grid.smallest && position - below <= above - position);
      const double code = down ? below-- : above++;
      const double off = (code - position) * grid.step;
      const double next = error + weight * off * off;
      if (!(next < least_)) return;
      take(k, code, kernel::realis_amplitude(code + grid.zero, grid.zero, grid.step), next);
    }
  }

  // Of numbers far below 2^31. The library's function is a call for every machine that may run this.
  static double nearest(double x) {
    const double cut = static_cast<double>(static_cast<int>(x));
    return cut + (x - cut >= 0.5 ? 1.0 : 0.0) - (x - cut < -0.5 ? 1.0 : 0.0);
  }

  // Lobe k gets a code; the best values of those before it follow.
  void take(std::size_t k, double code, double amplitude, double error) {
    codes_[k] = code;
    if (k == 0) {
      least_ = error;
      std::copy_n(codes_.begin(), places_, found_.begin());
      return;
    }
    const auto place = static_cast<Eigen::Index>(k);
    const double moved = amplitude - goal_[place];
    const double* column = &feedback_(0, place);
    const double* before = target_[k].data();
    double* after = target_[k - 1].data();
    for (std::size_t j = 0; j < k; ++j) after[j] = before[j] - column[j] * moved;
    choose(k - 1, error);
  }

  const LobeMatrix& feedback_;
  const LobeVector& weights_;
  const LobeVector& goal_;
  std::size_t places_;
  int steps_left_;
  double least_ = std::numeric_limits<double>::infinity();
  std::array<Grid, kMaxLobes> grid_;
  // Of row k, the first k + 1: best values of the lobes up to k when those after it have their codes.
  std::array<std::array<double, kMaxLobes>, kMaxLobes> target_;
  std::array<double, kMaxLobes> codes_;
  std::array<double, kMaxLobes> found_;
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

bool CodeSearch::is_none_closer(const LobeVector& goal, double error, double* none) const {
  double sum = 0.0;
  // From the last lobe on, as its term is known at once, and mostly more than the error already.
  for (Eigen::Index k = goal.size() - 1; k >= 0; --k) {
    double off = goal[k];
    for (Eigen::Index j = k + 1; j < goal.size(); ++j) off += feedback_(k, j) * goal[j];
    sum += weights_[k] * off * off;
    if (sum >= error) return false;
  }
  *none = sum;
  return goal.size() > 0;
}

double CodeSearch::find(const Quantiser& quantiser, const LobeVector& shift, int steps,
                        std::span<int> codes) const {
  const LobeVector goal = shift.size() > 0 ? LobeVector(best_ + shift) : best_;
  const Walk walk(*this, quantiser, goal, steps);
  std::fill(codes.begin(), codes.end(), 0);
  double none = 0.0;
  if (is_none_closer(goal, walk.least(), &none)) return none;
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
  const Walk walk(*this, unlimited, spread, steps);
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
