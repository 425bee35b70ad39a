// Reading maps, checked.
#include "io/picture_maps.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "io/error.h"

namespace brdfit::io {
namespace {

void fail(const FrameImage& map, const PixelChoice& choice, int width, std::size_t pixel,
          const std::string& found) {
  const std::size_t texel =
      choice.texels.empty()
          ? static_cast<std::size_t>(choice.first_row) * static_cast<std::size_t>(width) + pixel
          : choice.texels[pixel];
  throw IoError(IoError::Side::kInput, map.name(),
                fmt::format("pixel ({}, {}) {}", texel % static_cast<std::size_t>(width),
                            texel / static_cast<std::size_t>(width), found),
                "values from 0 to 1");
}

}  // namespace

PictureMaps::PictureMaps(std::span<const std::optional<std::filesystem::path>> files, const FrameSize& size)
    : maps_(files.size()), width_(size.width) {
  for (std::size_t k = 0; k < files.size(); ++k) {
    if (!files[k]) continue;
    maps_[k].emplace(*files[k], Transfer{}, size);
    is_any_ = true;
  }
}

std::vector<float> PictureMaps::read(std::size_t picture, const PixelChoice& choice) {
  if (!maps_[picture]) return {};
  FrameImage& map = *maps_[picture];
  Unusable unusable;
  std::vector<float> values = map.values(choice, unusable);
  if (unusable.non_finite > 0) {
    // Integer codes are finite, so all that is unusable here is not.
    fail(map, choice, width_, unusable.pixels.front(), "is not finite");
  }
  values.resize(choice.count(width_));
  const auto outside =
      std::find_if(values.begin(), values.end(), [](float v) { return v < 0.0F || v > 1.0F; });
  if (outside != values.end()) {
    fail(map, choice, width_, static_cast<std::size_t>(outside - values.begin()),
         fmt::format("holds {:.4g}", *outside));
  }
  return values;
}

void PictureMaps::weigh(TexelBlock& block, const PixelChoice& choice) {
  if (!is_any_) return;
  if (block.weight.empty()) block.weight.assign(block.lights * block.count(), 1.0F);
  tbb::parallel_for(std::size_t{0}, maps_.size(), [&](std::size_t light) {
    const std::vector<float> map = read(light, choice);
    for (std::size_t k = 0; k < map.size(); ++k) block.weight[light * block.count() + k] *= map[k];
  });
}

}  // namespace brdfit::io
