// The textures of a baked asset, written and read by runs of rows.
#ifndef BRDFIT_CLI_ASSET_FILES_H_
#define BRDFIT_CLI_ASSET_FILES_H_

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "bake/pack.h"
#include "bake/reconstruct.h"
#include "brdf/realis_asset.h"
#include "cli/clocks.h"
#include "io/exr_rows.h"

namespace brdfit::cli {

// One run of rows of an asset. Planes are [plane][texel].
struct AssetRows {
  std::vector<float> amplitudes;
  bake::PackedTexels packed;
  std::vector<float> chroma;
  bake::Surface surface;
  std::vector<float> confidence;  // in [0, 1]
};

// The names that an asset's files have, into asset.files.
void name_asset_files(RealisAsset& asset);

// Every file that the asset names, in the folder.
std::vector<std::filesystem::path> asset_paths(const RealisAsset& asset, const std::filesystem::path& folder);

bake::PackLayout layout_of(const RealisAsset& asset);

// Writes all textures from top to bottom, each file by one thread; they appear under their names at commit().
// zip: smaller files, for time.
class AssetWriter {
 public:
  AssetWriter(const RealisAsset& asset, const std::filesystem::path& folder, io::ExrDepth depth, bool zip);
  ~AssetWriter();
  // cpu: what it takes is added to it.
  void write(const AssetRows& rows, int count, CpuMeter& cpu);
  void commit();
  // Amplitudes that a half could not hold.
  std::size_t cut_values() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Reads textures back.
class AssetReader {
 public:
  // packed: amplitudes from the packed codes, as at run time; otherwise from the EXR.
  AssetReader(RealisAsset asset, std::filesystem::path folder, bool packed);
  ~AssetReader();
  // Rows in order from the top, with the surface as it was baked, at run time and then.
  bake::RunTimeTexels read(int first_row, int rows);
  // The bytes that the amplitudes of the rows read last came from, as they are stored.
  const bake::PackedTexels& packed_bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_ASSET_FILES_H_
