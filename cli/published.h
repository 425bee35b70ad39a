// The parameters that the Callisto talk set by hand, as candidates beside the fits.
#ifndef BRDFIT_CLI_PUBLISHED_H_
#define BRDFIT_CLI_PUBLISHED_H_

#include <string>
#include <vector>

#include "brdf/material.h"

namespace brdfit::cli {

// Those of a measured material ("blue-fabric"), in the order of all_models(); none for most. They are part of
// the program (data/synthetic/recipes when it was built), so that it finds them wherever it is installed.
std::vector<Material> published_materials(const std::string& name);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_PUBLISHED_H_
