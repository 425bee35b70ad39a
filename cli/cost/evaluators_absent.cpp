// A build without the gpu room.
#include "cli/cost/evaluators.h"

namespace brdfit::cli {

void add_gpu_evaluators(const std::string&, Evaluators& evaluators) {
  evaluators.notes.emplace_back(
      "neither float nor a Vulkan device was timed: this brdfit was built without Vulkan");
}

}  // namespace brdfit::cli
