// What `brdfit verify` does once its arguments are read. Two files define it: one with the gpu room, one
// without.
#ifndef BRDFIT_CLI_VERIFY_RUN_H_
#define BRDFIT_CLI_VERIFY_RUN_H_

#include <cstdint>
#include <string>
#include <vector>

#include "cli/common.h"

namespace brdfit::cli {

struct VerifyRequest {
  CommonOptions common;
  std::string file;  // a material; may be empty with list_devices
  std::uint64_t pairs = 2'000'000;
  std::uint64_t seed = 1;
  std::vector<double> pair;  // wi and wo, to look at one pair alone; empty: none
  std::string device;        // index, part of a name, or empty for the first
  std::string shader;        // SPIR-V in place of the built-in one; empty: none
  std::string picture;       // PNG of slices and spheres to write; empty: none
  bool validation = false;
  bool timings = false;
  bool list_devices = false;
};

// Returns an ExitCode. Throws UsageError, IoError, and std::runtime_error where there is no device.
int verify(const VerifyRequest& request);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_VERIFY_RUN_H_
