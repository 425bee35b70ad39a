// What `brdfit info` says of a stack of photographs.
#ifndef BRDFIT_CLI_STACK_INFO_H_
#define BRDFIT_CLI_STACK_INFO_H_

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "brdf/vec3.h"
#include "cli/common.h"
#include "io/transfer.h"

namespace brdfit::cli {

struct StackInfoRequest {
  std::filesystem::path file;
  std::optional<io::Transfer> transfer;
  std::filesystem::path lights;  // the picture of the lights; empty: none
};

// Whether a file is a light file (.lp) or a manifest: JSON with images.
bool is_stack_file(const std::filesystem::path& file);

// Condition number of the Gram matrix of K lobes on Fibonacci's points of the hemisphere, each of half its
// height where it meets its neighbours; nothing where the lights cannot tell the lobes apart at all.
std::optional<double> lobe_condition(int lobes, std::span<const Vec3> directions);

// Reads the whole stack once, and prints text or JSON. Returns an ExitCode.
int describe_stack(const StackInfoRequest& request, const CommonOptions& common);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_STACK_INFO_H_
