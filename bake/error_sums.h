// Errors of predictions under the lights of a stack, as sums that blocks and folds add to.
#ifndef BRDFIT_BAKE_ERROR_SUMS_H_
#define BRDFIT_BAKE_ERROR_SUMS_H_

#include <cstddef>
#include <span>
#include <vector>

#include "bake/photometric_stereo.h"
#include "bake/texel_problem.h"

namespace brdfit::bake {

// Over texels and lights, in 1/255 (a value of 1 is 255): of luminances, or of the three channels together.
struct StackErrors {
  double rmse_255 = 0.0;
  double psnr_db = 0.0;       // of a peak of 1
  double lit_rmse_255 = 0.0;  // where the texel faces the light
  double worst_light_rmse_255 = 0.0;
  std::size_t worst_light = 0;
  std::vector<double> per_light_255;
};

// Squared errors, each value of weight above 0 alike.
struct ErrorSums {
  std::vector<double> squares;  // per light of the stack; empty: nothing was added
  std::vector<double> counts;   // values in them
  double lit_squares = 0.0;     // where the texel faces the light
  double lit_count = 0.0;

  static ErrorSums of_lights(std::size_t lights);

  bool is_empty() const { return squares.empty(); }
  // errors, shade: [light][texel] of the problem, whose lights have these places in the stack.
  void add(const LightChoice& lights, const TexelProblem& problem, std::span<const float> shade,
           std::span<const float> errors);
  // Throws std::invalid_argument where they are of another number of lights.
  void add(const ErrorSums& sums);
  StackErrors errors() const;
};

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_ERROR_SUMS_H_
