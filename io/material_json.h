// Material JSON: a material, and the evidence of the fit that it came from.
#ifndef BRDFIT_IO_MATERIAL_JSON_H_
#define BRDFIT_IO_MATERIAL_JSON_H_

#include <filesystem>

#include "brdf/material.h"
#include "io/json.h"

namespace brdfit::io {

// {"brdfit": 1, "model": ..., "parameters": {...}, "effects": [...], "options": {...}}. Colours and tints are
// three linear floats, with the 8-bit sRGB triple beside them under NAME_srgb8. Parameters of effects that
// are off are absent. Options that the model does not have are absent.
Json material_to_json(const Material& material);

// The inverse. file and where name the place for errors. The sRGB triples are ignored but must have the right
// shape. A material without "effects" uses effects_in_use(). A member "fit" (evidence) is allowed and
// ignored. Throws IoError (kInput): unknown version, model, option, effect, key; a value outside its range; a
// missing or badly typed member; a parameter of an effect that is off.
Material material_from_json(const Json& json, const std::string& file, const std::string& where = "");

// {"effects": [...], "parameters": {...}}: what tells a material from others of its model and options. No
// sRGB triples. For evidence that holds several materials.
Json effects_and_values_to_json(const Material& material);

// The inverse, with model and options of `like`. Throws as material_from_json().
Material material_from_effects_and_values(const Material& like, const Json& json, const std::string& file,
                                          const std::string& where = "");

// Reads a file; round-trips bit for bit with write_material.
Material read_material(const std::filesystem::path& file);

// Writes a material with the evidence under "fit" (null: no such member).
void write_material(const std::filesystem::path& file, const Material& material,
                    const Json& evidence = nullptr);

// 8-bit sRGB of a linear channel in [0, 1] (IEC 61966-2-1), rounded to nearest; values outside are an error
// (std::invalid_argument).
int srgb8_from_linear(double linear);
double linear_from_srgb8(int srgb8);

}  // namespace brdfit::io

#endif  // BRDFIT_IO_MATERIAL_JSON_H_
