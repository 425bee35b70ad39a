// Draws pairs by kind. Random numbers depend on seed and place alone.
#include "gpu/parity_pairs.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace brdfit {
namespace {

using enum PairKind;

constexpr std::array kKinds = {kAnywhere, kGrazing, kMirror,   kPole, kRetro,
                               kOpposite, kRight,   kDenormal, kBelow};
constexpr std::array<std::string_view, kKinds.size()> kNames = {
    "anywhere", "grazing", "mirror", "pole", "retro", "opposite", "right angle", "denormal", "below"};

using Vector = std::array<double, 3>;

class Draw {
 public:
  // Far apart for every seed and index: a start next to another one would draw the same numbers, shifted.
  Draw(std::uint64_t seed, std::uint64_t index) : state_(mixed(mixed(seed) + index)) {}

  // Evenly in (0, 1).
  double uniform() { return (static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52; }
  double between(double lower, double upper) { return lower + (upper - lower) * uniform(); }
  // Evenly in the logarithm, between 10^lower and 10^upper.
  double power_of_ten(double lower, double upper) { return std::pow(10.0, between(lower, upper)); }
  // One time in n.
  bool rarely(int n) { return uniform() * n < 1.0; }
  double sign() { return rarely(2) ? -1.0 : 1.0; }

 private:
  // SplitMix64 (Steele, Lea and Flood 2014).
  static std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31);
  }
  std::uint64_t bits() {
    const std::uint64_t result = mixed(state_);
    state_ += 0x9e3779b97f4a7c15U;
    return result;
  }
  std::uint64_t state_;
};

// The direction of that cosine and azimuth.
Vector direction(double cosine, double azimuth) {
  const double sine = std::sqrt(std::fmax(0.0, (1.0 - cosine) * (1.0 + cosine)));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

double any_azimuth(Draw& draw) {
  // The axes are where components vanish.
  if (draw.rarely(8)) return std::numbers::pi / 2 * std::floor(draw.between(0.0, 4.0));
  return draw.between(0.0, 2 * std::numbers::pi);
}

Vector at_cosine(double cosine, Draw& draw) {
  return direction(cosine, any_azimuth(draw));
}

double small_cosine(Draw& draw) {
  return draw.power_of_ten(-25.0, -1.0);
}

double any_cosine(Draw& draw) {
  return draw.rarely(8) ? small_cosine(draw) : draw.uniform();
}

Vector anywhere(Draw& draw) {
  return at_cosine(draw.uniform(), draw);
}

// A unit vector near w, still above the horizon.
Vector near(Vector w, Draw& draw) {
  if (draw.rarely(8)) return w;
  const double distance = draw.power_of_ten(-12.0, -0.5);
  for (double& x : w) x += distance * draw.between(-1.0, 1.0);
  w[2] = std::fabs(w[2]);
  const double length = std::hypot(w[0], w[1], w[2]);
  return {w[0] / length, w[1] / length, w[2] / length};
}

// Rounds the directions; not normalised again, as a renderer's are not.
FloatPair rounded(const Vector& wi, const Vector& wo) {
  const auto as_float = [](const Vector& w) {
    return std::array{static_cast<float>(w[0]), static_cast<float>(w[1]), static_cast<float>(w[2])};
  };
  return {as_float(wi), as_float(wo)};
}

FloatPair grazing(Draw& draw) {
  const Vector a = at_cosine(small_cosine(draw), draw);
  const Vector b = at_cosine(any_cosine(draw), draw);
  return draw.rarely(2) ? rounded(a, b) : rounded(b, a);
}

FloatPair mirror(Draw& draw) {
  const Vector wi = at_cosine(any_cosine(draw), draw);
  return rounded(wi, near({-wi[0], -wi[1], wi[2]}, draw));
}

// The components along the surface are so small that their squares vanish in float.
FloatPair pole(Draw& draw) {
  const auto close = [&] {
    const double distance = draw.rarely(8) ? 0.0 : draw.power_of_ten(-45.0, -3.0);
    const double x = distance * draw.between(-1.0, 1.0);
    const double y = distance * draw.between(-1.0, 1.0);
    return Vector{x, y, std::sqrt(1.0 - x * x - y * y)};
  };
  const Vector wi = close();
  return rounded(wi, close());
}

FloatPair retro(Draw& draw) {
  const Vector wi = at_cosine(any_cosine(draw), draw);
  return rounded(wi, near(wi, draw));
}

FloatPair opposite(Draw& draw) {
  const Vector wi = at_cosine(small_cosine(draw), draw);
  Vector wo = {-wi[0], -wi[1], small_cosine(draw)};
  if (draw.rarely(2)) wo[0] += draw.sign() * draw.power_of_ten(-40.0, -3.0);
  if (draw.rarely(2)) wo[1] += draw.sign() * draw.power_of_ten(-40.0, -3.0);
  const double length = std::hypot(wo[0], wo[1], wo[2]);
  return rounded(wi, {wo[0] / length, wo[1] / length, wo[2] / length});
}

FloatPair at_right_angles(Draw& draw) {
  const Vector wi = at_cosine(any_cosine(draw), draw);
  const Vector other = anywhere(draw);
  Vector wo = {wi[1] * other[2] - wi[2] * other[1], wi[2] * other[0] - wi[0] * other[2],
               wi[0] * other[1] - wi[1] * other[0]};
  const double length = std::hypot(wo[0], wo[1], wo[2]);
  const double scale = (wo[2] < 0.0 ? -1.0 : 1.0) / std::fmax(length, 1e-300);
  if (length < 1e-6) return rounded({1.0, 0.0, 1e-3}, {0.0, 1.0, 1e-3});
  for (double& x : wo) x *= scale;
  return rounded(wi, near(wo, draw));
}

double denormal(Draw& draw) {
  return draw.power_of_ten(-45.0, -37.0);
}

FloatPair denormal_cosines(Draw& draw) {
  const Vector a = at_cosine(denormal(draw), draw);
  const Vector b = at_cosine(draw.rarely(2) ? denormal(draw) : any_cosine(draw), draw);
  return draw.rarely(2) ? rounded(a, b) : rounded(b, a);
}

FloatPair below(Draw& draw) {
  const auto low = [&]() -> double {
    if (draw.rarely(8)) return draw.sign() * 0.0;
    return draw.rarely(2) ? -draw.uniform() : -draw.power_of_ten(-45.0, -1.0);
  };
  const Vector a = at_cosine(low(), draw);
  const Vector b = at_cosine(draw.rarely(2) ? low() : any_cosine(draw), draw);
  return draw.rarely(2) ? rounded(a, b) : rounded(b, a);
}

FloatPair drawn(PairKind kind, Draw& draw) {
  switch (kind) {
    case kAnywhere: {
      const Vector wi = anywhere(draw);
      return rounded(wi, anywhere(draw));
    }
    case kGrazing:
      return grazing(draw);
    case kMirror:
      return mirror(draw);
    case kPole:
      return pole(draw);
    case kRetro:
      return retro(draw);
    case kOpposite:
      return opposite(draw);
    case kRight:
      return at_right_angles(draw);
    case kDenormal:
      return denormal_cosines(draw);
    case kBelow:
      break;
  }
  return below(draw);
}

}  // namespace

std::span<const PairKind> all_pair_kinds() {
  return kKinds;
}

std::string_view name_of(PairKind kind) {
  return kNames[static_cast<std::size_t>(kind)];
}

PairKind kind_of_parity_pair(std::uint64_t index) {
  return kKinds[index % kKinds.size()];
}

void fill_parity_pairs(std::uint64_t seed, std::uint64_t first, std::span<FloatPair> out) {
  for (std::size_t k = 0; k < out.size(); ++k) {
    const std::uint64_t index = first + k;
    Draw draw(seed, index);
    out[k] = drawn(kind_of_parity_pair(index), draw);
  }
}

}  // namespace brdfit
