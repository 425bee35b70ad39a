// What a synthetic light stack is made of: the recipe, and its JSON form.
#ifndef BRDFIT_DATA_SYNTHETIC_STACK_RECIPE_H_
#define BRDFIT_DATA_SYNTHETIC_STACK_RECIPE_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "brdf/material.h"
#include "data/synthetic/recipe.h"
#include "io/json.h"

namespace brdfit::synthetic {

enum class Relief {
  kPlane,   // flat, facing the camera
  kSphere,  // the largest that the picture holds; texels beside it are masked
  kBumps,   // a sum of waves
};

struct ShapeRecipe {
  Relief relief = Relief::kBumps;
  double slope = 0.5;         // of bumps: the steepest one, as height over length, in [0, 10]
  double wavelength_px = 48;  // of bumps: the longest wave, in [4, 4096]
  friend bool operator==(const ShapeRecipe&, const ShapeRecipe&) = default;
};

enum class Arrangement {
  kDome,    // evenly over the cap down to theta_deg
  kRing,    // evenly around at theta_deg
  kSparse,  // at random within theta_deg
};

struct LightsRecipe {
  Arrangement arrangement = Arrangement::kDome;
  int count = 50;           // in [1, 10000]
  double theta_deg = 75.0;  // from the view axis, in [0, 90]
  double intensity = 1.0;   // in (0, 1e6]
  double distance =
      0.0;  // near lights: from the picture's centre, in picture widths; 0: directional. In [0, 1e6]
  friend bool operator==(const LightsRecipe&, const LightsRecipe&) = default;
};

// What no model explains: amplitudes that vary smoothly over texels, on known lobes, the same in all
// channels.
struct ResidualRecipe {
  int lobes = 0;             // evenly over the cap of the lights, in [0, 32]
  double sharpness = 4.0;    // in [0, 1e6]
  double cut_off_deg = 180;  // in (0, 180]
  double strength = 0.1;     // largest amplitude, in units of pi f, in [0, 1000]
  friend bool operator==(const ResidualRecipe&, const ResidualRecipe&) = default;
};

// What goes wrong in real captures.
struct StackFaults {
  std::vector<std::pair<int, double>> gains;  // light, factor on its picture in (0, 100]; not in the manifest
  std::vector<std::pair<int, int>> swapped;   // pairs of lights whose pictures are exchanged
  bool upside_down = false;                   // directions in the manifest have their y turned over
  int hot_pixels = 0;  // texels, in [0, 1000000], each far too bright under one light in four
  friend bool operator==(const StackFaults&, const StackFaults&) = default;
};

struct StackFiles {
  std::string format = "exr";              // what OpenImageIO writes by that ending: exr, png, tif, jpg, ...
  std::string transfer = "linear";         // linear or srgb: how pixels are encoded
  int jpeg_quality = 95;                   // in [1, 100]; of formats other than JPEG nothing
  std::string jpeg_subsampling = "4:2:0";  // of colours: 4:4:4 keeps one for each pixel; 4:2:2, 4:2:0, 4:1:1
  std::string manifest = "json";           // json or lp
  bool give_normals = false;               // whether the manifest names the true normals and albedo
  bool give_albedo = false;
  friend bool operator==(const StackFiles&, const StackFiles&) = default;
};

struct StackRecipe {
  std::string name;    // not empty, no path
  std::string source;  // where the facts come from; may be empty
  int width = 64;      // in [1, 16384]
  int height = 64;
  ShapeRecipe shape;
  std::vector<Material> materials;  // at least one
  int patch_px = 0;  // edge of the squares that each have one of the materials; 0: the first everywhere
  double albedo_variation =
      0.0;  // texels' base colours lie between (1 - this) and 1 times the material's, in [0, 1];
            // above 0 only for models that are affine in it (no metallic, not Burley)
  LightsRecipe lights;
  bool cast_shadows = true;
  ResidualRecipe residual;
  Noise noise;  // a value v becomes v (1 + multiplicative z1) + additive z2
  StackFaults faults;
  StackFiles files;
  std::uint64_t seed = 1;

  // Whether all ranges above hold; if not, *why (when not null) names the first that does not.
  bool is_valid(std::string* why) const;
  friend bool operator==(const StackRecipe&, const StackRecipe&) = default;
};

// {"brdfit_stack_recipe": 1, "name", "source", "width", "height", "shape": {"relief": "plane|sphere|bumps",
// "slope", "wavelength_px"}, "materials": [...], "patch_px", "albedo_variation", "lights": {"arrangement":
// "dome|ring|sparse", "count", "theta_deg", "intensity", "distance"}, "cast_shadows", "residual": {"lobes",
// "sharpness", "cut_off_deg", "strength"}, "noise": {...}, "faults": {"gains": [[light, factor]...],
// "swapped": [[light, light]...], "upside_down", "hot_pixels"}, "files": {"format", "transfer",
// "jpeg_quality", "jpeg_subsampling", "manifest", "give_normals", "give_albedo"}, "seed"}. All but version,
// name and materials may be absent. Errors as in recipe.h.
io::Json stack_recipe_to_json(const StackRecipe& recipe);
StackRecipe stack_recipe_from_json(const io::Json& json, const std::string& file);
StackRecipe read_stack_recipe(const std::filesystem::path& file);

// Whether a file's JSON is a stack's recipe rather than a table's.
bool is_stack_recipe(const io::Json& json);

}  // namespace brdfit::synthetic

#endif  // BRDFIT_DATA_SYNTHETIC_STACK_RECIPE_H_
