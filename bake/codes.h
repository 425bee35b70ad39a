// Whole numbers that stand for a texel's amplitudes.
//
// Lobes overlap, so that most of what rounding one amplitude spoils can be made good by the others: the codes
// that render closest are the lattice point next to the best amplitudes under the texel's normal equations,
// and finding it, not rounding each amplitude by itself, is what makes 4 bits enough. Ranges need not be
// centred on 0; 0 itself is always a code, as for affine quantisation with a whole zero point (Jacob et al.
// 2018), so that a texel that is not corrected stays so and decoding is one subtraction and one product.
#ifndef BRDFIT_BAKE_CODES_H_
#define BRDFIT_BAKE_CODES_H_

#include <cstdint>
#include <span>
#include <vector>

#include "bake/compress.h"
#include "brdf/realis.h"

namespace brdfit::bake {

// How amplitudes become codes: whole numbers in [-zero, 2^bits - 1 - zero] of the lobe's range, 0 for 0.
struct Quantiser {
  int bits = 8;                     // 2 to 16
  std::vector<RealisRange> ranges;  // per lobe
  int smallest_code(std::size_t lobe) const { return -ranges[lobe].zero; }
  int largest_code(std::size_t lobe) const { return realis_top_code(bits) - ranges[lobe].zero; }
  double amplitude(std::size_t lobe, int code) const;
};

// Steps of a search, each the choice of one lobe's code. With few bits, looking further than the first codes
// that are found saves 40% of the squared rounding error (8 lobes of a measured head, 4 bits); with more bits
// there is nothing left to save. The more lobes overlap the more codes are close by: with 32 steps 16 lobes
// left more error than 8.
constexpr bool is_searched(int bits) {
  return bits <= 5;
}
constexpr int search_steps(int bits, std::size_t lobes) {
  const int cubed = static_cast<int>(lobes * lobes * lobes / 16);
  return !is_searched(bits) ? 0 : cubed > 32 ? cubed : 32;
}

// One texel, prepared for any number of searches.
class CodeSearch {
 public:
  CodeSearch() = default;  // of a texel without lobes
  // mask: bit k for lobe k: the others' codes are 0.
  CodeSearch(const TexelEquations& equations, std::uint32_t mask);

  const std::vector<int>& lobes() const { return lobes_; }  // in the mask, ascending
  const LobeVector& amplitudes() const { return best_; }    // of these, before rounding

  // Finds codes whose error above that of the best amplitudes, moved by `shift`, is least and returns that
  // error. The first that are tried round each amplitude given those that are rounded already (nearest plane,
  // Babai 1986); others follow while there are steps left, nearest first (Schnorr and Euchner 1994). Never
  // worse than codes of 0 alone. shift: per lobe of the mask, or empty. codes: per lobe of the equations,
  // overwritten.
  double find(const Quantiser& quantiser, const LobeVector& shift, int steps, std::span<int> codes) const;

  // A shift that is spread evenly over the amplitudes whose codes are the same, as noise is over [-0.5, 0.5):
  // codes of amplitudes that are shifted so are right in the mean (dithered lattices, Zamir and Feder 1992).
  // That cell is round where shifts of each lobe by itself would move the sum of overlapping lobes by
  // several steps. noise: per lobe of the equations. No limits of codes are looked at.
  LobeVector dither(const Quantiser& quantiser, std::span<const double> noise, int steps) const;

 private:
  class Walk;

  // Whether codes of 0 leave less than that error of these amplitudes: *none. So it may be where lobes almost
  // coincide, as the first codes that a walk meets are then far from the nearest.
  bool is_none_closer(const LobeVector& goal, double error, double* none) const;

  std::vector<int> lobes_;
  LobeVector best_;
  LobeVector weights_;   // of the squared distance of each amplitude to its best value given later lobes
  LobeMatrix feedback_;  // (k, j > k): how much of what rounding adds to j is taken from k
};

// Dither of a whole step leaves no trace of a ramp's contours in the mean over neighbours, but doubles each
// texel's squared rounding error. With this share of it the mean is as good and half of that cost is saved.
inline constexpr double kDitherStrength = 0.7;

// Codes per lobe of the equations; those outside `mask` are 0. noise: per lobe of the equations, in
// [-0.5, 0.5), or empty: no dither. strength: of dither, in [0, 1].
std::vector<int> quantise(const TexelEquations& equations, const Quantiser& quantiser, std::uint32_t mask,
                          std::span<const double> noise, int steps, double strength = kDitherStrength);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_CODES_H_
