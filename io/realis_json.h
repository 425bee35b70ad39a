// Realis JSON: the description of a baked asset beside its textures.
#ifndef BRDFIT_IO_REALIS_JSON_H_
#define BRDFIT_IO_REALIS_JSON_H_

#include <filesystem>

#include "brdf/realis_asset.h"
#include "io/json.h"

namespace brdfit::io {

// {"brdfit_realis": 2, "name", "width", "height", "colour", "albedo_in_modulation", "frame", "view", "lobes":
// [{"axis", "sharpness", "cos_cut_off"}...], "penalty", "base": "lambert" or a material, "packing": {"bits",
// "dominant", "step", "zero", "bytes_per_texel"}, "fade": {...}, "files": {...}}. Throws
// std::invalid_argument if the asset is not valid. See docs/schema/realis.schema.json.
Json realis_to_json(const RealisAsset& asset);

// Parts of it: [x, y, z], and the array of lobes.
Json vector_to_json(const Vec3& v);
Json lobes_to_json(const LobeSet& lobes);

// The inverse. A member "bake" (evidence) is allowed and ignored. Throws IoError (kInput): unknown version or
// key, a wrong type or range, parts that do not agree.
RealisAsset realis_from_json(const Json& json, const std::string& file);

// Reads NAME.realis.json.
RealisAsset read_realis(const std::filesystem::path& file);
// Writes it, with the evidence of the bake under "bake" (null: no such member).
void write_realis(const std::filesystem::path& file, const RealisAsset& asset,
                  const Json& evidence = nullptr);

}  // namespace brdfit::io

#endif  // BRDFIT_IO_REALIS_JSON_H_
