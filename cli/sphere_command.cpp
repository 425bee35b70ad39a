// brdfit sphere: a sphere or a patch under a light, or a sphere under an environment.
#include <fmt/format.h>

#include "cli/single_picture.h"
#include "render/figure.h"
#include "render/sphere.h"

namespace brdfit::cli {
namespace {

struct Arguments {
  SinglePicture single{256};
  double light_deg = 0.0;
  std::string shape = "sphere";
  std::string environment = "none";
};

render::Image draw_in_environment(const Arguments& a, const render::Subject& subject, io::Json& facts) {
  const auto environment =
      a.environment == "gradient" ? render::Environment::kGradient : render::Environment::kUniform;
  render::EnvironmentImage drawn = render::draw_environment(subject, environment, a.single.picture.size);
  facts["quadrature_error_8bit_steps"] = drawn.error_steps;
  facts["quadrature_converged"] = drawn.converged;
  facts["quadrature_evaluations"] = drawn.evaluations;
  if (drawn.unmeasured_fraction > 0.0) facts["unmeasured_fraction"] = drawn.unmeasured_fraction;
  if (!drawn.converged) {
    say(a.single.common,
        fmt::format("the environment's quadrature did not converge: error {:.2g} of an 8-bit step",
                    drawn.error_steps));
  }
  return std::move(drawn.image);
}

int run(const Arguments& a) {
  const bool in_environment = a.environment != "none";
  if (in_environment && a.shape == "patch") throw UsageError("a patch is drawn under --light only");
  const render::Shape shape = a.shape == "patch" ? render::Shape::kPatch : render::Shape::kSphere;
  Drawing drawing;
  drawing.kind = in_environment ? a.environment : fmt::format("{}{:g}", a.shape, a.light_deg);
  const std::string light = in_environment
                                ? fmt::format("{} environment", a.environment)
                                : fmt::format("directional light at {:g} deg, irradiance pi", a.light_deg);
  drawing.what = fmt::format("{} under a {}", a.shape, light);
  drawing.units = "radiance; 1 is a white Lambert surface facing the light";
  if (in_environment) drawing.units = "radiance; the environment's largest is 1";
  drawing.draw = [&](const render::Subject& subject) {
    if (in_environment) return draw_in_environment(a, subject, drawing.facts);
    return render::draw_lit(subject, shape, a.light_deg, a.single.picture.size);
  };
  drawing.figure = [&](const render::Image& image, const std::string& title) {
    render::FigureOptions figure;
    figure.title = title;
    figure.view = view_options_of(a.single.picture);
    std::string caption = light;
    if (in_environment) {
      caption += fmt::format(", quadrature error {:.2g} of an 8-bit step",
                             drawing.facts["quadrature_error_8bit_steps"].get<double>());
    }
    return render::plain_figure(image, caption, figure);
  };
  return draw_single(a.single, drawing);
}

}  // namespace

Command add_sphere_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("sphere", "picture of a sphere or a patch of a table or a material");
  app->footer(
      "Example: brdfit sphere blue-fabric.binary --light 120 -o blue-fabric.sphere120.png\n"
      "The light's angle is that between light and camera: 0 from the camera, 90 from the right, 140 from "
      "behind.");
  app->add_option("--light", a->light_deg, "angle of the light in degrees; the talk has 0, 90, 120, 140")
      ->check(CLI::Range(0.0, 179.0))
      ->capture_default_str();
  app->add_option("--shape", a->shape, "sphere, or patch: a flat square turned half-way to the light")
      ->check(CLI::IsMember({"sphere", "patch"}))
      ->capture_default_str();
  app->add_option("--environment", a->environment,
                  "light from everywhere instead: uniform, or a gradient from "
                  "black below to white above")
      ->check(CLI::IsMember({"none", "uniform", "gradient"}))
      ->capture_default_str();
  add_single_picture(*app, a->single);
  return {app, [a](const std::string&) { return run(*a); }};
}

}  // namespace brdfit::cli
