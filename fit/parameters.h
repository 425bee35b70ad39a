// Which parameters a fit may move, and how they make up a model's product form (brdf/coefficients.h).
#ifndef BRDFIT_FIT_PARAMETERS_H_
#define BRDFIT_FIT_PARAMETERS_H_

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "brdf/material.h"
#include "fit/groups.h"

namespace brdfit::fit {

// One number that the optimiser moves.
struct FreeParameter {
  std::string name;       // "roughness", "base_color.r"; "diffuse_fresnel.g" for intensity times tint
  std::string parameter;  // the public parameter that shows its state; for a product the intensity
  std::string tint;       // for a product of two free parameters: the tint
  double lower = 0.0;
  double upper = 1.0;
  // Changes are measured against this when parameters are compared: the width of the range; for intensities,
  // whose range is wide, their own size (at least 1).
  bool relative = false;
};

// The linear map from free numbers x to the product form q: q[k] = factor[k] x[source[k]], or constant[k]
// where source[k] is -1.
struct Parametrisation {
  Material start;  // what fixed parameters hold; free ones are replaced
  std::vector<FreeParameter> free;
  std::vector<int> source;
  std::vector<double> factor;
  std::vector<double> constant;

  std::size_t size() const { return free.size(); }

  // x at the values of a material, moved to the nearest bound where it is outside.
  std::vector<double> from_material(const Material& material) const;

  // The material at x. Where an intensity and its tint are free, the largest channel of the tint becomes 1.
  Material to_material(std::span<const double> x) const;

  std::vector<double> product(std::span<const double> x) const;

  // What a unit of parameter k counts as at x: see FreeParameter::relative.
  double scale(std::size_t k, double x) const;

  // The free parameters that are the three channels of a product with a range on both sides of 0 (the
  // terminator): a material has one sign for all three. Empty where there is none.
  std::vector<std::size_t> one_signed;
};

// Values that --fix gives, by public name: one number, or three.
using FixedValues = std::map<std::string, std::vector<double>>;

struct FreedomOptions {
  Tier tier = Tier::kFull;
  Effects effects;  // of the model
  FixedValues fixed;
  // Of the model; all where absent. Parameters of the others stand at their defaults.
  std::optional<Groups> groups = {};
};

// start: the model, its options, and the values of parameters that are not free.
// Throws std::invalid_argument: an unknown parameter or a value out of range in `fixed`, effects that the
// model does not have, a parameter fixed whose effect or group is off.
Parametrisation make_parametrisation(const Material& start, const FreedomOptions& options);

}  // namespace brdfit::fit

#endif  // BRDFIT_FIT_PARAMETERS_H_
