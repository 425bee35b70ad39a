// brdfit slice: the picture of a BRDF slice.
#include <fmt/format.h>

#include "cli/single_picture.h"
#include "render/figure.h"

namespace brdfit::cli {
namespace {

struct Arguments {
  SinglePicture single{512};
  SliceArguments slice;
};

int run(const Arguments& a) {
  const render::SliceOptions options = slice_options_of(a.slice, a.single.picture.size);
  Drawing drawing;
  drawing.kind = "slice";
  drawing.what = fmt::format("BRDF slice at phi_d = {:g} deg, {}, theta_h axis {}, {} sampling",
                             options.phi_d_deg, a.slice.quantity, a.slice.axis, a.slice.sampling);
  drawing.units = "sr^-1";
  drawing.facts["phi_d_deg"] = options.phi_d_deg;
  drawing.draw = [&options](const render::Subject& subject) { return render::draw_slice(subject, options); };
  drawing.figure = [&](const render::Image& image, const std::string& title) {
    render::FigureOptions figure;
    figure.title = title;
    figure.view = view_options_of(a.single.picture);
    figure.regions = a.slice.regions;
    return render::slice_figure(image, options, figure);
  };
  return draw_single(a.single, drawing);
}

}  // namespace

Command add_slice_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("slice", "picture of a BRDF slice of a table or a material");
  app->footer(
      "Example: brdfit slice blue-fabric.binary --regions -o blue-fabric.slice.png\n"
      "theta_h runs from left to right, theta_d from bottom to top. Hatched: no measurement.");
  add_single_picture(*app, a->single);
  add_slice_arguments(*app, a->slice);
  return {app, [a](const std::string&) { return run(*a); }};
}

}  // namespace brdfit::cli
