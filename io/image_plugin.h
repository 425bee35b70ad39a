// The calls between the program and the module that links OpenImageIO. Plain functions and no exceptions, so
// that nothing depends on types being one and the same on both sides.
#ifndef BRDFIT_IO_IMAGE_PLUGIN_H_
#define BRDFIT_IO_IMAGE_PLUGIN_H_

#include <string>

#include "io/image_reader.h"

namespace brdfit::io {

struct ImagePluginCalls {
  // A handle, or null with the reason in error.
  void* (*open)(const std::string& file, ImageHeader& header, std::string& error);
  // Rows as samples of that type. False with the reason in error.
  bool (*read)(void* image, int first_row, int rows, SampleType type, void* out, std::string& error);
  void (*close)(void* image);
  bool (*write)(const std::string& file, const ImagePixels& pixels, const ImageWriteOptions& options,
                std::string& error);
};

// The name under which the module exports `const ImagePluginCalls* ()`. It changes with the calls, so that a
// module of another version is refused rather than called wrongly.
inline constexpr const char* kImagePluginSymbol = "brdfit_image_plugin_1";
inline constexpr const char* kImagePluginFile = "brdfit_images.so";

}  // namespace brdfit::io

#endif  // BRDFIT_IO_IMAGE_PLUGIN_H_
