// What `slice` and `sphere` have in common: one picture, or the difference of two, to a PNG or EXR file.
#ifndef BRDFIT_CLI_SINGLE_PICTURE_H_
#define BRDFIT_CLI_SINGLE_PICTURE_H_

#include <functional>
#include <string>

#include "cli/common.h"
#include "cli/picture_options.h"
#include "cli/subject_input.h"
#include "render/difference.h"
#include "render/image.h"

namespace brdfit::cli {

struct SinglePicture {
  explicit SinglePicture(int default_size) : picture(default_size) {}

  CommonOptions common;
  PictureArguments picture;
  TableReading reading;
  std::string file;
  std::string output;
  std::string minus;  // file of a reference; empty: no difference
  std::string difference = "signed";
  double range = 0.0;
  bool plain = false;
};

void add_single_picture(CLI::App& app, SinglePicture& a);

// How one command draws.
struct Drawing {
  std::string kind;   // "slice": part of the default file name
  std::string what;   // for people and metadata: "BRDF slice at phi_d = 90 deg, f"
  std::string units;  // "sr^-1"
  std::string title;  // of a figure, in place of the file's name; may be empty
  std::function<render::Image(const render::Subject&)> draw;
  // A picture with its surroundings, of a title.
  std::function<render::Picture(const render::Image&, const std::string& title)> figure;
  io::Json facts = io::Json::object();  // filled by draw; go into --json and into the metadata
};

// Loads, draws, writes and says what was written. Returns an ExitCode; throws UsageError and IoError.
int draw_single(const SinglePicture& a, Drawing& drawing);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_SINGLE_PICTURE_H_
