// Hard sets of lobes, on the processor and on a device.
#ifndef BRDFIT_TESTS_STABILITY_REALIS_H_
#define BRDFIT_TESTS_STABILITY_REALIS_H_

#include "bake/reconstruct.h"
#include "brdf/realis_asset.h"

namespace brdfit::stability {

LobeSet coinciding_lobes();  // each twice
LobeSet blunt_lobes();       // of sharpness 0: their windows alone
LobeSet sharp_lobes();       // of sharpness 1e6

// Two lobes that almost coincide, with amplitudes up to 500 of opposite signs, as codes of 8 bits store them.
RealisAsset cancelling_asset();
bake::RunTimeTexels cancelling_texels(const RealisAsset& asset);

}  // namespace brdfit::stability

#endif  // BRDFIT_TESTS_STABILITY_REALIS_H_
