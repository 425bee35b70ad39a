// The sweep of a light stack: what each choice of a bake buys and costs.
#ifndef BRDFIT_CLI_COST_STACK_SWEEP_H_
#define BRDFIT_CLI_COST_STACK_SWEEP_H_

#include <filesystem>
#include <string>
#include <vector>

#include "cli/bake_options.h"
#include "cli/cost/cost_point.h"
#include "cli/cost/stack_choice.h"

namespace brdfit::cli {

// The three channels' errors together: what choices of colour differ in. That of luminance, which `brdfit
// bake` shows, is beside it.
inline constexpr const char* kStackLeadingError = "held_out_rgb_rmse_255";

struct StackSweepOptions {
  // The stack, and what holds for all points: transfer, gains, noise, contours, folds, sample, memory, seed,
  // model. Of its choices only the base is looked at: the points lie around it (auto: the one with the least
  // held-out error), and the other one, Lambert or the model, is a point of its own. No lobe set.
  BakeArguments bake;
  bool quick = false;  // a third of the points, 6 folds, each bake timed once
  int repeats = 3;     // of the time of each bake; evaluations are timed five times as often
  std::string device;  // for Vulkan, as DeviceRequest::device; empty: the first, if there is one
};

// The keys of CostPoint::errors of a stack, root-mean-square errors in 1/255 (a value of 1 is 255): held_out_
// and train_ with rgb_rmse_255 (the three channels together), rmse_255 (luminance), lit_rmse_255 (of it,
// where the texel faces the light) and worst_light_rmse_255 (of it, under the light where it is largest).
std::vector<std::string> stack_error_keys();

// Bakes a sample of texels for every point and measures errors, times, bytes and memory. For each fold of
// lights everything is planned and baked without them (bake/evidence.h); points share the plans, and what is
// solved, where theirs are the same. Seconds are CPU seconds of all threads for what `brdfit bake
// --no-evidence` does but writing files: decoding, the plan, the solve of all texels (from that of the
// sample). Nanoseconds are those of one thread for the render and the correction of one texel under one
// light. Errors of shrunk bakes are those in the size of the whole picture, textures magnified. All but times
// and memory is the same for any number of threads. Throws UsageError, io::IoError, and std::runtime_error
// when interrupted.
CostRun sweep_stack(const StackSweepOptions& options);

// Beside the choices there are points of sweep "device": the default relit in double precision, and on a
// Vulkan device (base material and correction; its errors are those of the default, see `brdfit verify`).
// They are no choices of a bake.

// A point measured again, by itself.
CostPoint measure_stack_choice(const CostPoint& point, const StackSweepOptions& options);

// `brdfit bake` with a point's choice, into a folder; its arguments, the program's name left out.
std::vector<std::string> bake_command_of(const CostPoint& point, const StackSweepOptions& options,
                                         const std::filesystem::path& folder);

// Bakes a point's choice of the whole stack into a folder, by the code of `brdfit bake`, without evidence and
// pictures. Returns its exit code. Throws as `brdfit bake`.
int write_stack_choice(const CostPoint& point, const StackSweepOptions& options,
                       const std::filesystem::path& folder);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_COST_STACK_SWEEP_H_
