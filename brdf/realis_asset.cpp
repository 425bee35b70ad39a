// Names, sizes and checks of baked assets.
#include "brdf/realis_asset.h"

#include <array>
#include <cmath>

namespace brdfit {
namespace {

constexpr std::array<std::string_view, 3> kColours{"luminance", "scaled-chroma", "rgb"};

std::string complaint_about(const Lobe& lobe) {
  const double squared = lobe.axis.x * lobe.axis.x + lobe.axis.y * lobe.axis.y + lobe.axis.z * lobe.axis.z;
  if (!(std::abs(squared - 1.0) < 1e-6)) return "the axis of a lobe is not a unit vector";
  if (!(lobe.sharpness >= 0.0 && std::isfinite(lobe.sharpness))) return "the sharpness of a lobe is negative";
  if (!(lobe.cos_cut_off >= -1.0 && lobe.cos_cut_off < 1.0))
    return "the cut-off of a lobe is outside [-1, 1)";
  return "";
}

std::string complaint_about(const RealisAsset& asset) {
  if (asset.width <= 0 || asset.height <= 0) return "the picture has no texels";
  for (const Lobe& lobe : asset.lobes) {
    if (std::string complaint = complaint_about(lobe); !complaint.empty()) return complaint;
  }
  if (asset.packing.bits != 4 && asset.packing.bits != 8) return "codes have neither 4 nor 8 bits";
  if (asset.packing.ranges.size() != asset.plane_count()) return "not every amplitude has a step and a zero";
  for (const RealisRange& range : asset.packing.ranges) {
    if (!(range.step >= 0.0 && std::isfinite(range.step))) return "the step of a code is negative";
    if (range.zero < 0 || range.zero > realis_top_code(asset.packing.bits)) return "a zero is not a code";
  }
  if (asset.packing.dominant < 0 || asset.packing.dominant > static_cast<int>(asset.lobes.size())) {
    return "more dominant lobes than lobes";
  }
  if (!(asset.fade.albedo_range > 0.0)) return "the fade's albedo range is not above 0";
  if (!(asset.fade.normal_range_deg > 0.0 && asset.fade.normal_range_deg <= 180.0)) {
    return "the fade's angle is outside (0, 180]";
  }
  std::string why;
  if (asset.base && !asset.base->is_valid(&why)) return "material: " + why;
  return "";
}

}  // namespace

std::string_view name_of(RealisColour colour) {
  return kColours[static_cast<std::size_t>(colour)];
}

std::optional<RealisColour> realis_colour_by_name(std::string_view name) {
  for (std::size_t k = 0; k < kColours.size(); ++k) {
    if (kColours[k] == name) return static_cast<RealisColour>(k);
  }
  return std::nullopt;
}

double RealisAsset::bytes_per_texel() const {
  const double channels = colour == RealisColour::kRgb ? 3.0 : 1.0;
  const bool all = packing.dominant == static_cast<int>(lobes.size());
  const double mask = all ? 0.0 : std::ceil(static_cast<double>(lobes.size()) / 8.0);
  const double chroma = colour == RealisColour::kScaledChroma ? 6.0 : 0.0;
  return packing.dominant * channels * packing.bits / 8.0 + mask + chroma;
}

bool RealisAsset::is_valid(std::string* why) const {
  std::string complaint = complaint_about(*this);
  if (complaint.empty()) return true;
  if (why != nullptr) *why = std::move(complaint);
  return false;
}

std::vector<std::string> realis_channel_names(const RealisAsset& asset) {
  std::vector<std::string> names;
  for (std::size_t lobe = 0; lobe < asset.lobes.size(); ++lobe) {
    std::string stem = "lobe";
    stem += static_cast<char>('0' + lobe / 10);
    stem += static_cast<char>('0' + lobe % 10);
    stem += '.';
    if (asset.colour == RealisColour::kRgb) {
      for (const char channel : {'R', 'G', 'B'}) names.push_back(stem + channel);
    } else {
      names.push_back(stem + 'Y');
    }
  }
  return names;
}

}  // namespace brdfit
