// A surface at run time that is not the one that was baked: pictures of albedo and normals.
#ifndef BRDFIT_CLI_RUN_TIME_SURFACE_H_
#define BRDFIT_CLI_RUN_TIME_SURFACE_H_

#include <filesystem>
#include <memory>

#include "bake/reconstruct.h"
#include "brdf/realis_asset.h"

namespace brdfit::cli {

// Formats are those of a stack's albedo and normals (docs/schema/olat.schema.json).
struct RunTimeSurfaceFiles {
  std::filesystem::path albedo;     // empty: the baked one
  std::filesystem::path normals;    // empty: the baked ones
  Rgb albedo_scale{1.0, 1.0, 1.0};  // linear, multiplied in; >= 0
};

class RunTimeSurface {
 public:
  // Throws io::IoError (kInput): no such file, no image, or not of the asset's size.
  RunTimeSurface(const RealisAsset& asset, const RunTimeSurfaceFiles& files);
  ~RunTimeSurface();

  // Puts the surface of rows, in order from the top, in place of texels.surface. Where the picture holds no
  // normal the baked one stays. Throws io::IoError (kInput) for an albedo that is negative or not finite.
  void replace(bake::RunTimeTexels& texels, int first_row, int rows);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_RUN_TIME_SURFACE_H_
