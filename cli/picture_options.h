// The options of every command that draws.
#ifndef BRDFIT_CLI_PICTURE_OPTIONS_H_
#define BRDFIT_CLI_PICTURE_OPTIONS_H_

#include <string>

#include "cli/common.h"
#include "render/slice.h"
#include "render/view.h"

namespace brdfit::cli {

struct PictureArguments {
  explicit PictureArguments(int default_size) : size(default_size) {}

  int size;
  double exposure_stops = 0.0;
  std::string view = "srgb";
  std::string channel = "rgb";
};

// Adds --size, --exposure, --view and --channel.
void add_picture_arguments(CLI::App& app, PictureArguments& arguments);
render::ViewOptions view_options_of(const PictureArguments& arguments);

// How a slice is laid out.
struct SliceArguments {
  double phi_d_deg = 90.0;
  std::string axis = "linear";
  std::string quantity = "f";
  std::string sampling = "smooth";
  bool regions = false;
};

// Adds --phi-d, --axis, --quantity, --sampling and --regions.
void add_slice_arguments(CLI::App& app, SliceArguments& arguments);
// Throws UsageError.
render::SliceOptions slice_options_of(const SliceArguments& arguments, int size);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_PICTURE_OPTIONS_H_
