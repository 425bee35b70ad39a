// Names, sizes and checks of baked assets.
#include "brdf/realis_asset.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace brdfit {
namespace {

// As many as a bake makes; a mask of dominant lobes has room for a few more.
constexpr std::size_t kMostLobes = 16;
constexpr std::array<std::string_view, 3> kColours{"luminance", "scaled-chroma", "rgb"};

bool is_unit(const Vec3& v) {
  return std::abs(v.x * v.x + v.y * v.y + v.z * v.z - 1.0) < 1e-6;
}

std::string complaint_about(const Lobe& lobe) {
  if (!is_unit(lobe.axis)) return "the axis of a lobe is not a unit vector";
  if (!(lobe.sharpness >= 0.0 && lobe.sharpness <= kLargestSharpness))
    return "the sharpness of a lobe is outside [0, 1e30]";
  if (!(lobe.cos_cut_off >= -1.0 && lobe.cos_cut_off < 1.0))
    return "the cut-off of a lobe is outside [-1, 1)";
  return "";
}

// Of the folder that the asset lies in, and no other.
bool is_plain_file_name(std::string_view name) {
  const bool has_odd = std::any_of(name.begin(), name.end(),
                                   [](char c) { return c == '/' || (static_cast<unsigned char>(c) < 0x20); });
  return !has_odd && name != "." && name != "..";
}

std::string complaint_about(const RealisFiles& files) {
  std::vector<std::string> names = files.packed;
  for (const std::string* name : {&files.amplitudes, &files.dominant, &files.chroma, &files.surface,
                                  &files.albedo, &files.normals, &files.confidence}) {
    names.push_back(*name);
  }
  const auto odd = std::find_if_not(names.begin(), names.end(), is_plain_file_name);
  return odd == names.end() ? "" : "\"" + *odd + "\" is no plain name of a file";
}

std::string complaint_about(const RealisAsset& asset) {
  if (asset.width <= 0 || asset.height <= 0) return "the picture has no texels";
  if (!is_unit(asset.view)) return "the view is not a unit vector";
  if (asset.lobes.size() > kMostLobes) return "there are more than 16 lobes";
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
  if (std::string complaint = complaint_about(asset.files); !complaint.empty()) return complaint;
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
