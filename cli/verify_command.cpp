// brdfit verify: does a Vulkan device compute what the processor computes?
#include "cli/common.h"
#include "cli/verify_run.h"

namespace brdfit::cli {
namespace {

int run(const VerifyRequest& request) {
  if (request.file.empty() && !request.list_devices)
    throw UsageError("a material .json or NAME.realis.json is needed");
  if (request.pairs == 0) throw UsageError("--pairs is 0");
  return verify(request);
}

}  // namespace

Command add_verify_command(CLI::App& program) {
  auto a = std::make_shared<VerifyRequest>();
  CLI::App* app =
      program.add_subcommand("verify", "whether a Vulkan device computes a material as the processor does");
  app->footer(
      "Example: brdfit verify blue-fabric.callisto.json --pairs 5000000\n"
      "The reference is the processor in double, on directions and parameters rounded to float. Allowed is a "
      "relative error of 1e-5 + 4e-7 / roughness^2 where f cos_i is above 1e-4, and an absolute one of 1e-6 "
      "elsewhere; exit code 4 says that a value was further off. Exit code 1: no Vulkan device, or it "
      "failed.");
  app->add_option("file", a->file, "material .json, or a baked asset (NAME.realis.json)");
  app->add_option("--pairs", a->pairs, "pairs of directions, random and adversarial")->capture_default_str();
  app->add_option("--seed", a->seed, "seed of the pairs")->capture_default_str();
  app->add_option("--pair", a->pair, "this pair alone: wi_x,wi_y,wi_z,wo_x,wo_y,wo_z (unit, z = normal)")
      ->expected(6)
      ->delimiter(',');
  app->add_option("--device", a->device, "index of the device or part of its name; the first if not given");
  app->add_flag("--list-devices", a->list_devices, "print the devices of this machine and end");
  app->add_flag("--validation", a->validation,
                "with Vulkan's validation layers; their messages go to stderr and end in exit code 1");
  app->add_option("--picture", a->picture,
                  "PNG: a slice and spheres by the processor, by the device, and their difference times 1000")
      ->take_last();
  app->add_flag("--timings", a->timings, "time every effect on the device and on the processor too");
  app->add_option("--shader", a->shader,
                  "SPIR-V file to verify in place of the built-in shader, with the interface of "
                  "gpu/shaders/material.glsl");
  add_common_options(*app, a->common, true);
  return {app, [a](const std::string&) { return run(*a); }};
}

}  // namespace brdfit::cli
