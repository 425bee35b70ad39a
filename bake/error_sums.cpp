// Squares, counts, and the roots of their ratios.
#include "bake/error_sums.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brdfit::bake {
namespace {

double root_mean_255(double sum, double count) {
  return count > 0.0 ? 255.0 * std::sqrt(sum / count) : 0.0;
}

}  // namespace

ErrorSums ErrorSums::of_lights(std::size_t lights) {
  ErrorSums sums;
  sums.squares.assign(lights, 0.0);
  sums.counts.assign(lights, 0.0);
  return sums;
}

void ErrorSums::add(const LightChoice& lights, const TexelProblem& problem, std::span<const float> shade,
                    std::span<const float> errors) {
  for (std::size_t t = 0; t < lights.size(); ++t) {
    for (std::size_t k = 0; k < problem.texels; ++k) {
      const std::size_t at = problem.at(t, k);
      if (problem.weight_of(t, k) == 0.0F) continue;
      const double squared = std::pow(static_cast<double>(errors[at]), 2);
      squares[lights[t]] += squared;
      counts[lights[t]] += 1.0;
      if (shade[at] > 0.0F) {
        lit_squares += squared;
        lit_count += 1.0;
      }
    }
  }
}

void ErrorSums::add(const ErrorSums& sums) {
  if (sums.squares.size() != squares.size() || sums.counts.size() != counts.size()) {
    throw std::invalid_argument("ErrorSums: they are of another number of lights");
  }
  for (std::size_t light = 0; light < squares.size(); ++light) {
    squares[light] += sums.squares[light];
    counts[light] += sums.counts[light];
  }
  lit_squares += sums.lit_squares;
  lit_count += sums.lit_count;
}

StackErrors ErrorSums::errors() const {
  StackErrors out;
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t light = 0; light < squares.size(); ++light) {
    sum += squares[light];
    count += counts[light];
    const double rmse = root_mean_255(squares[light], counts[light]);
    out.per_light_255.push_back(rmse);
    if (rmse > out.worst_light_rmse_255) {
      out.worst_light_rmse_255 = rmse;
      out.worst_light = light;
    }
  }
  out.rmse_255 = root_mean_255(sum, count);
  out.lit_rmse_255 = root_mean_255(lit_squares, lit_count);
  // Without any error a peak's ratio to it has no number: as that of the smallest error a float can show.
  out.psnr_db = 20.0 * std::log10(255.0 / std::max(out.rmse_255, 255.0 * 0x1p-24));
  return out;
}

}  // namespace brdfit::bake
