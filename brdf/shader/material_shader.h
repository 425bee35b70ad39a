// A material as a shader for other programs: the kernel's own code, cut down to what the material uses.
#ifndef BRDFIT_BRDF_SHADER_MATERIAL_SHADER_H_
#define BRDFIT_BRDF_SHADER_MATERIAL_SHADER_H_

#include <string>

#include "brdf/material.h"

namespace brdfit::shader {

enum class Language { kGlsl, kHlsl };

struct ShaderOptions {
  Language language = Language::kGlsl;
  // Whether parameters are constants of the shader, or members of a struct that the caller fills in.
  bool baked = true;
  // Starts every name, so that one shader can hold several materials. An identifier.
  std::string prefix = "brdf";
  // For the comment at the top: where the material comes from, and what made the file.
  std::string source;
  std::string made_by;

  bool is_valid(std::string* why) const;
};

// One file that needs no other. Effects that are off, options that were not chosen and functions that
// nothing calls are not in it. It defines, for directions in the local frame (unit, z = normal, pointing away
// from the surface; 0 where either is not above the horizon),
//   vec3 PREFIX_eval_cos(vec3 wi, vec3 wo)                     f(wi, wo) cos_i in sr^-1, linear Rec.709
//   vec3 PREFIX_eval_cos(PREFIX_Material m, vec3 wi, vec3 wo)  where parameters are not baked, and
//   PREFIX_Material PREFIX_material()                          the material's own parameters
// (float3 in HLSL), and where the macro BRDF_COMPUTE_MAIN is defined an entry point `main`, eight floats in
// (wi, 0, wo, 0) and four out (f cos_i, 0) for each pair, in buffers 0 and 1. Computed in single precision.
// Throws std::invalid_argument where options are invalid.
std::string material_shader(const Material& material, const ShaderOptions& options);

}  // namespace brdfit::shader

#endif  // BRDFIT_BRDF_SHADER_MATERIAL_SHADER_H_
