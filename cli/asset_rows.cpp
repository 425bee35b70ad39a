// Solving, coding and packing, in one go where that is possible.
#include "cli/asset_rows.h"

#include <algorithm>
#include <utility>

#include "bake/bake_rows.h"
#include "bake/pack.h"

namespace brdfit::cli {
namespace {

// Bytes per texel of a block's surface, amplitudes, codes, and what the files are given of them, which they
// are while the next block is made.
constexpr std::size_t kMadeBytes = 200;

// Planes of all problems of a block, [lobe][channel][texel].
std::vector<float> planes_of(const std::vector<std::vector<float>>& channels, std::size_t lobes,
                             std::size_t count) {
  std::vector<float> planes;
  planes.reserve(channels.size() * lobes * count);
  for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
    for (const std::vector<float>& channel : channels) {
      const auto from = channel.begin() + static_cast<std::ptrdiff_t>(lobe * count);
      planes.insert(planes.end(), from, from + static_cast<std::ptrdiff_t>(count));
    }
  }
  return planes;
}

}  // namespace

AssetRowsMaker::AssetRowsMaker(const StackInfo& info, const bake::BakePlan& plan,
                               const bake::BakeSettings& settings, const RealisAsset& asset, bool dither)
    : info_(info), plan_(plan), settings_(settings), asset_(asset), dither_(dither) {}

bool AssetRowsMaker::has_short_way() const {
  return bake::has_short_way(info_, plan_, settings_, asset_.packing);
}

bool AssetRowsMaker::needs_luminance_alone() const {
  return has_short_way() && bake::needs_luminance_alone(info_, plan_);
}

std::size_t AssetRowsMaker::texel_bytes(bool luminance) const {
  return planes_per_light(luminance) * sizeof(float) * info_.lights.size() + kMadeBytes;
}

// Values, weight; and a residual, or (the long way) render, residual, modulation and a copy, of colours three
// times; and directions, where they are each texel's own.
std::size_t AssetRowsMaker::planes_per_light(bool luminance) const {
  const bool is_near = has_near_lights(info_);
  const std::size_t directions = is_near ? 3 : 0;
  if (luminance) return 2;
  if (has_short_way() && !is_near) return plan_.base.material ? 5 : 4;
  return directions + (settings_.colour == RealisColour::kRgb ? 22 : 14);
}

bake::CompressOptions AssetRowsMaker::compress_options() const {
  return {asset_.packing.bits, asset_.packing.dominant, dither_};
}

// The lobes that the channels of each texel keep together; empty where there is one channel, or all are kept.
std::vector<std::uint32_t> AssetRowsMaker::shared_masks(const bake::BakedBlock& baked) const {
  const int dominant = asset_.packing.dominant;
  if (baked.solved.size() < 2 || static_cast<std::size_t>(dominant) == asset_.lobes.size()) return {};
  return bake::dominant_masks(*plan_.system, baked.problems, baked.solved, dominant);
}

std::vector<RealisRange> AssetRowsMaker::ranges(const TexelBlock& sample) const {
  std::vector<RealisRange> planes(asset_.plane_count());
  if (!plan_.system) return planes;
  const bake::BakedBlock baked = bake::bake_block(info_, sample, plan_, settings_);
  const std::size_t channels = baked.solved.size();
  const std::vector<std::uint32_t> shared = shared_masks(baked);
  for (std::size_t c = 0; c < channels; ++c) {
    const std::vector<RealisRange> lobes = bake::code_ranges(
        *plan_.system, baked.problems[c], baked.solved[c].amplitudes, compress_options(), shared);
    for (std::size_t k = 0; k < lobes.size(); ++k) planes[k * channels + c] = lobes[k];
  }
  return planes;
}

AssetRowsMaker::Made AssetRowsMaker::rows_of(const TexelBlock& block) {
  Made made;
  AssetRows& rows = made.rows;
  if (has_short_way()) {
    bake::BakedRows baked = bake::bake_rows(info_, block, plan_, settings_, asset_.packing, dither_, &room_);
    made.cut_codes = bake::cut_codes(baked);
    rows.packed = bake::pack_all(layout_of(asset_), baked.stored);
    rows.amplitudes = std::move(baked.solved.amplitudes);
    rows.confidence = std::move(baked.solved.confidence);
    rows.surface = std::move(baked.surface);
    return made;
  }
  bake::BakedBlock baked = bake::bake_block(info_, block, plan_, settings_);
  rows.confidence.assign(block.count(), 0.0F);
  if (plan_.system) compress(baked, block, rows);
  rows.chroma = std::move(baked.chroma);
  rows.surface = std::move(baked.surface);
  return made;
}

void AssetRowsMaker::compress(const bake::BakedBlock& baked, const TexelBlock& block, AssetRows& rows) const {
  const std::size_t lobes = asset_.lobes.size();
  const std::size_t channels = baked.solved.size();
  std::vector<std::vector<float>> amplitudes;
  std::vector<int> codes(asset_.plane_count() * block.count(), 0);
  std::vector<std::uint32_t> masks(block.count(), 0);
  const std::vector<std::uint32_t> shared = shared_masks(baked);
  for (std::size_t c = 0; c < channels; ++c) {
    const bake::SolveResult& solved = baked.solved[c];
    std::vector<RealisRange> ranges;
    for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
      ranges.push_back(asset_.packing.ranges[lobe * channels + c]);
    }
    const bake::Compressed small =
        bake::compress_block(*plan_.system, baked.problems[c], solved.amplitudes, block.texels, asset_.width,
                             ranges, compress_options(), shared);
    for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
      std::copy_n(small.codes.begin() + static_cast<std::ptrdiff_t>(lobe * block.count()), block.count(),
                  codes.begin() + static_cast<std::ptrdiff_t>((lobe * channels + c) * block.count()));
    }
    for (std::size_t k = 0; k < block.count(); ++k) {
      masks[k] |= small.masks[k];
      rows.confidence[k] = std::max(rows.confidence[k], solved.confidence[k]);
    }
    amplitudes.push_back(solved.amplitudes);
  }
  rows.packed = bake::pack(layout_of(asset_), codes, masks);
  rows.amplitudes = planes_of(amplitudes, lobes, block.count());
}

}  // namespace brdfit::cli
