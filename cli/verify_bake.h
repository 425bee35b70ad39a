// brdfit verify of a baked asset: does a Vulkan device correct texels as the processor does?
#ifndef BRDFIT_CLI_VERIFY_BAKE_H_
#define BRDFIT_CLI_VERIFY_BAKE_H_

#include "cli/verify_run.h"
#include "gpu/compute.h"

namespace brdfit::cli {

// Whether the request's file is NAME.realis.json.
bool is_baked_asset(const std::string& file);

// The corrections of all texels under some lights, from the packed textures as they are stored, against the
// reconstruction in double. Prints, and returns an ExitCode. Throws as verify().
int verify_bake(const VerifyRequest& request, ComputeDevice& device);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_VERIFY_BAKE_H_
