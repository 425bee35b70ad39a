// brdfit verify in a build without the gpu room.
#include <stdexcept>

#include "cli/verify_run.h"

namespace brdfit::cli {

int verify(const VerifyRequest&) {
  throw std::runtime_error(
      "this brdfit was built without Vulkan. On Debian: apt-get install libvulkan-dev mesa-vulkan-drivers, "
      "then "
      "configure and build again");
}

}  // namespace brdfit::cli
