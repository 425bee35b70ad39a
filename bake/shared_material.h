// One material for all texels of a stack: specular and Callisto parameters shared, base colours per texel.
#ifndef BRDFIT_BAKE_SHARED_MATERIAL_H_
#define BRDFIT_BAKE_SHARED_MATERIAL_H_

#include <optional>
#include <string>
#include <vector>

#include "bake/base_model.h"
#include "brdf/material.h"
#include "fit/identifiability.h"
#include "measured/image_stack.h"

namespace brdfit::bake {

struct SharedMaterialOptions {
  Model model = Model::kCallisto;
  MaterialOptions material_options;
  // Parameters up to this tier may move. Tints stay white, as a base colour is what tells texels apart.
  Tier tier = Tier::kAdvanced;
  // Of the model that may be used. Burley's specular tint and anisotropy never are.
  Effects effects = effects_of(Model::kCallisto);
  // Residuals above this many robust standard deviations of Lambert's count by their absolute value.
  double robust_width = 2.0;
  // Roughness stays at or above this: a narrower highlight falls between the lights of a stack, and a texel
  // that one of them happens to hit says nothing of it.
  double least_roughness = 0.15;
  // Values looked at, about: texels are thinned evenly, those that are black or without a normal left out.
  std::size_t values = 60000;
  // Starts are followed on so many values, about, before the best is refined on all.
  std::size_t explored_values = 9000;
  int max_iterations = 60;
  // Refined in place of any other start; nothing: starts are explored. What it was fitted to must not hold
  // lights that are to be held out.
  std::optional<Material> start;

  bool is_valid(std::string* why) const;
};

// A fit, with how it went. Non-convergence is data, not an exception.
struct SharedMaterial {
  BaseModel model;  // Lambert where there is nothing to fit (see `termination`)
  bool converged = false;
  std::string termination;  // in words
  int iterations = 0;
  std::size_t texels = 0;                       // looked at
  double rmse = 0.0;                            // of their luminances, with base colours solved
  double lambert_rmse = 0.0;                    // the same for the surface's own albedo
  std::vector<fit::ParameterState> parameters;  // without the base colour
};

// Fits the parameters that texels share, with each texel's base colour solved in closed form inside
// (variable projection, Golub and Pereyra 1973): Ceres moves the shared ones alone. Compared are radiances,
// robustly. surface: normals to use, and Lambert's albedo (photometric_stereo); lights: those that may be
// looked at. The material's own base colour is the mean of the texels'. From several starts; the same for any
// number of threads.
// Throws std::invalid_argument where sizes disagree or options are invalid.
SharedMaterial fit_shared_material(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                                   const LightChoice& lights, const SharedMaterialOptions& options = {});

// The best of the starts on few values: where fits of the same model to some of the lights may start.
SharedMaterial explore_shared_material(const StackInfo& info, const TexelBlock& block, const Surface& surface,
                                       const LightChoice& lights, const SharedMaterialOptions& options = {});

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_SHARED_MATERIAL_H_
