// The inverse of a bake: render + modulation x sum over lobes, for a light from any direction, as at run
// time.
#ifndef BRDFIT_BAKE_RECONSTRUCT_H_
#define BRDFIT_BAKE_RECONSTRUCT_H_

#include <span>
#include <vector>

#include "bake/photometric_stereo.h"
#include "brdf/realis_asset.h"

namespace brdfit::bake {

// What the renderer has of some texels: its own surface, what the bake saw of it, and amplitudes.
struct RunTimeTexels {
  Surface surface;                // at run time: state is not looked at
  Surface baked;                  // of the same texels; compared with `surface` for the fade
  std::vector<float> amplitudes;  // [plane][texel], as RealisAsset counts planes
  std::vector<float> chroma;      // [channel][texel] for kScaledChroma, otherwise empty
};

struct Relit {
  std::vector<float> render;     // [channel][texel], the base model alone
  std::vector<float> corrected;  // with Realis. May be negative, where lobes take away more than there is
};

// What Realis adds to the render: modulation x fade x sum over lobes, [channel][texel]; 0 where a texel faces
// away. Throws std::invalid_argument where sizes disagree.
std::vector<double> correction(const RealisAsset& asset, const RunTimeTexels& texels,
                               const RealisLight& light);

// Every value is finite. Where nothing fades, the result is what the amplitudes were solved for. Throws
// std::invalid_argument where sizes disagree.
Relit relight(const RealisAsset& asset, const RunTimeTexels& texels, const RealisLight& light);

}  // namespace brdfit::bake

#endif  // BRDFIT_BAKE_RECONSTRUCT_H_
