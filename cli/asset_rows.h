// What goes into the files of an asset, from blocks of texels.
#ifndef BRDFIT_CLI_ASSET_ROWS_H_
#define BRDFIT_CLI_ASSET_ROWS_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/compress_block.h"
#include "bake/plan.h"
#include "brdf/realis_asset.h"
#include "cli/asset_files.h"

namespace brdfit::cli {

class AssetRowsMaker {
 public:
  // All are referred to. asset: with lobes and packing.
  AssetRowsMaker(const StackInfo& info, const bake::BakePlan& plan, const bake::BakeSettings& settings,
                 const RealisAsset& asset, bool dither);

  // The asset's ranges of codes, [lobe][channel], as a sample of its texels asks for them; of 0 without
  // lobes.
  std::vector<RealisRange> ranges(const TexelBlock& sample) const;

  // With the ranges in the asset, whether luminance of the pictures is all that rows are made from.
  bool needs_luminance_alone() const;
  // Memory that a texel of a block takes, with what is made of it.
  std::size_t texel_bytes(bool luminance) const;

  struct Made {
    AssetRows rows;
    std::size_t cut_codes = 0;  // at an end of their range, where that is looked at
  };
  // One block at a time.
  Made rows_of(const TexelBlock& block);

 private:
  bool has_short_way() const;
  std::size_t planes_per_light(bool luminance) const;
  bake::CompressOptions compress_options() const;
  std::vector<std::uint32_t> shared_masks(const bake::BakedBlock& baked) const;
  void compress(const bake::BakedBlock& baked, const TexelBlock& block, AssetRows& rows) const;

  const StackInfo& info_;
  const bake::BakePlan& plan_;
  const bake::BakeSettings& settings_;
  const RealisAsset& asset_;
  bool dither_;
  std::vector<float> room_;  // that blocks work in
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_ASSET_ROWS_H_
