// What can go wrong with a Vulkan device, by kind, with a sentence that says what to do.
#ifndef BRDFIT_GPU_ERROR_H_
#define BRDFIT_GPU_ERROR_H_

#include <stdexcept>
#include <string>

namespace brdfit {

class GpuError : public std::runtime_error {
 public:
  enum class Kind {
    kNoDriver,      // no Vulkan loader, no driver or no device at all
    kNoSuchDevice,  // none of that name or index, or one that cannot do what is needed
    kNoValidation,  // validation was asked for and its layer is not installed
    kOutOfMemory,   // of the device or of the machine
    kDeviceLost,    // the driver gave up: crashed, reset or unplugged
    kFailed,        // anything else that a driver reports
  };

  GpuError(Kind kind, const std::string& sentence) : std::runtime_error(sentence), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

}  // namespace brdfit

#endif  // BRDFIT_GPU_ERROR_H_
