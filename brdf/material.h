// A material: a model, its options, its effects and its parameters by their public names.
#ifndef BRDFIT_BRDF_MATERIAL_H_
#define BRDFIT_BRDF_MATERIAL_H_

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/effects.h"
#include "brdf/vec3.h"

namespace brdfit {

enum class Model { kLambertGgx, kBurley, kCallisto };

// What an artist is shown: each tier includes those before it.
enum class Tier { kBase, kAdvanced, kFull };

enum class Masking { kSeparable = BRDF_MASKING_SEPARABLE, kCorrelated = BRDF_MASKING_CORRELATED };
enum class BurleyG { k2012 = BRDF_BURLEY_G_2012, k2017 = BRDF_BURLEY_G_2017 };
enum class Diffuse { kLambert = BRDF_DIFFUSE_LAMBERT, kProxima = BRDF_DIFFUSE_PROXIMA };

// What a parameter is.
enum class Kind {
  kNumber,     // a plain number
  kColour,     // three linear Rec.709 channels, shown as 8-bit sRGB too
  kTint,       // three channels whose largest is 1, multiplying the intensity `partner`
  kIntensity,  // a number with a tint `partner`
};

// One row of a model's parameter table. Unit: all parameters are dimensionless.
struct ParameterInfo {
  std::string_view name;  // JSON name
  int components;         // 1, or 3 (red, green, blue)
  double lower;           // range of every component, both ends allowed
  double upper;
  double default_value;  // of every component
  Tier tier;             // the first tier that exposes it
  Effect effect;         // the effect that it belongs to; kNone: always there
  Kind kind;
  std::string_view partner;  // the intensity of a tint, the tint of an intensity; empty for others
  std::string_view help;     // one line, for people
  int offset;                // of its first component in Material::values()
};

// Options that are not fitted. Those that a model does not have are ignored by it and not written.
struct MaterialOptions {
  Masking masking = Masking::kSeparable;  // Lambert + GGX, Callisto
  BurleyG burley_g = BurleyG::k2012;      // Burley
  Diffuse diffuse = Diffuse::kLambert;    // Lambert + GGX, Callisto
  friend bool operator==(const MaterialOptions&, const MaterialOptions&) = default;
};

// Names as in JSON and on the command line: "lambert-ggx", "burley", "callisto"; "base", "advanced", "full";
// "separable", "correlated"; "2012", "2017"; "lambert", "proxima".
std::string_view name_of(Model model);
std::string_view name_of(Tier tier);
std::string_view name_of(Masking masking);
std::string_view name_of(BurleyG burley_g);
std::string_view name_of(Diffuse diffuse);
std::optional<Model> model_by_name(std::string_view name);
std::optional<Tier> tier_by_name(std::string_view name);
std::optional<Masking> masking_by_name(std::string_view name);
std::optional<BurleyG> burley_g_by_name(std::string_view name);
std::optional<Diffuse> diffuse_by_name(std::string_view name);

// "Lambert + GGX", "Burley", "Callisto": for tables and titles.
std::string_view title_of(Model model);

std::span<const Model> all_models();

// The parameter table of a model, in the order in which it is shown and stored.
std::span<const ParameterInfo> parameters_of(Model model);

// The row of that name; nullptr if the model has none.
const ParameterInfo* find_parameter(Model model, std::string_view name);

// Every effect of a model.
Effects effects_of(Model model);

// A material with every parameter at its default and no effects: Lambert + GGX, whatever the model.
class Material {
 public:
  explicit Material(Model model = Model::kLambertGgx);

  Model model() const { return model_; }
  const MaterialOptions& options() const { return options_; }
  MaterialOptions& options() { return options_; }
  Effects effects() const { return effects_; }

  // Sets the effects in use; those that the model does not have are an error (std::invalid_argument).
  void set_effects(Effects effects);

  // All components of all parameters, in the order of parameters_of(model()).
  std::span<const double> values() const { return values_; }
  std::span<double> values() { return values_; }

  // A parameter by name: a number, or three channels (the same three times for a number).
  // Throws std::invalid_argument if the model has no such parameter.
  double number(std::string_view name) const;
  Rgb colour(std::string_view name) const;
  void set(std::string_view name, double value);  // all components
  void set(std::string_view name, const Rgb& value);

  // Whether every parameter is finite and in its range; if not, *why (when not null) names the first that is
  // not, what it is and what it may be.
  bool is_valid(std::string* why) const;

  friend bool operator==(const Material&, const Material&) = default;

 private:
  Model model_;
  MaterialOptions options_;
  Effects effects_;
  std::vector<double> values_;
};

// The effects whose parameters differ from those of a material that lacks them: what a material read without
// a list of effects uses.
Effects effects_in_use(const Material& material);

}  // namespace brdfit

#endif  // BRDFIT_BRDF_MATERIAL_H_
