// In builds without Vulkan.
#include "cli/cost/stack_device.h"

namespace brdfit::cli {

std::unique_ptr<StackDevice> open_stack_device(const std::string&, std::string& why) {
  why = "this build has no Vulkan";
  return nullptr;
}

}  // namespace brdfit::cli
