// A baked Realis asset: what its files mean, and what must be known to put them back on a render.
#ifndef BRDFIT_BRDF_REALIS_ASSET_H_
#define BRDFIT_BRDF_REALIS_ASSET_H_

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/material.h"
#include "brdf/realis.h"

namespace brdfit {

// How amplitudes carry colour.
enum class RealisColour {
  kLuminance,     // one amplitude per lobe, the same in all channels
  kScaledChroma,  // one per lobe, and three factors per texel that give it its colour
  kRgb,           // one per lobe and channel
};
// "luminance", "scaled-chroma", "rgb".
std::string_view name_of(RealisColour colour);
std::optional<RealisColour> realis_colour_by_name(std::string_view name);

// Amplitudes as whole numbers of few bits.
struct RealisPacking {
  int bits = 8;      // 4 or 8
  int dominant = 0;  // amplitudes kept per texel and channel; as many as lobes: all
  // Per plane (lobes, for kRgb [lobe][channel]): the precision multipliers, and where 0 is.
  std::vector<RealisRange> ranges;
};

// Where the correction ends: the distance in linear albedo and the angle between normals at which it is gone.
struct RealisFade {
  double albedo_range = 0.25;
  double normal_range_deg = 30.0;
};

// One directional light at run time. intensity: linear RGB; a white Lambert surface that faces a light of 1
// has radiance 1.
struct RealisLight {
  Vec3 direction;  // unit, towards the light
  Rgb intensity{1.0, 1.0, 1.0};
};

// Names of the asset's files, in the folder of its JSON. Those that are empty were not written.
struct RealisFiles {
  std::string amplitudes;           // EXR, channels realis_channel_names(); before any rounding to codes
  std::vector<std::string> packed;  // PNG, RGBA codes
  std::string dominant;  // PNG, one bit per lobe, low bytes first; only where not all lobes are kept
  std::string chroma;    // EXR R, G, B: factors of kScaledChroma
  std::string surface;   // EXR: albedo.R, .G, .B and normal.X, .Y, .Z as the bake used them
  std::string albedo;    // PNG sRGB and PNG n * 0.5 + 0.5: the thin properties that the fade compares with
  std::string normals;
  std::string confidence;  // PNG, 255: all of the error taken away
};

struct RealisAsset {
  std::string name;
  int width = 0;
  int height = 0;
  RealisColour colour = RealisColour::kLuminance;
  bool albedo_in_modulation =
      false;  // whether the modulation is irradiance x cos_i x albedo, or without albedo
  LobeSet lobes;
  // What held amplitudes back: the number on the diagonal of each texel's normal equations. Nothing: not
  // known, as in files of earlier versions.
  std::optional<double> penalty;
  // The material whose render is corrected, with each texel's albedo as its base colour; nothing: Lambert.
  std::optional<Material> base;
  Vec3 view{0.0, 0.0, 1.0};
  RealisPacking packing;
  RealisFade fade;
  RealisFiles files;

  std::size_t texel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  // Amplitudes per texel: lobes, times three for kRgb.
  std::size_t plane_count() const { return lobes.size() * static_cast<std::size_t>(channels()); }
  // Amplitudes of a lobe: 3 for kRgb.
  int channels() const { return colour == RealisColour::kRgb ? 3 : 1; }
  // Bytes per texel of what is needed at run time: codes and the mask of dominant lobes; for kScaledChroma
  // its factors (3 halves) too. Properties that the renderer has anyway are not counted.
  double bytes_per_texel() const;
  // Whether all parts agree; if not, *why (when not null) names the first that does not.
  bool is_valid(std::string* why) const;
};

// Channels of the amplitudes' EXR, in the order of planes: "lobe00.Y" or "lobe00.R", "lobe00.G", "lobe00.B".
std::vector<std::string> realis_channel_names(const RealisAsset& asset);

}  // namespace brdfit

#endif  // BRDFIT_BRDF_REALIS_ASSET_H_
