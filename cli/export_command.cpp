// brdfit export: a material in the form of others.
#include <fmt/format.h>

#include "cli/common.h"
#include "cli/threads.h"
#include "data/synthetic/generate.h"
#include "io/material_json.h"

namespace brdfit::cli {
namespace {

struct Arguments {
  CommonOptions common;
  std::string file;
  std::string to = "merl";
  std::string output;
  std::string cell = "lower-edge";
  std::vector<int> grid = {90, 90, 180};
};

int run(const Arguments& a) {
  const ThreadLimit threads(a.common.threads);
  // A table of a material is what a recipe without noise makes: each cell the mean of both orders of its
  // directions.
  synthetic::Recipe recipe;
  recipe.name = base_name(a.file);
  recipe.material = io::read_material(a.file);
  recipe.grid.n_theta_h = a.grid[0];
  recipe.grid.n_theta_d = a.grid[1];
  recipe.grid.n_phi_d = a.grid[2];
  recipe.grid.anchor = a.cell == "centre" ? CellAnchor::kCentre : CellAnchor::kLowerEdge;
  std::string why;
  if (!recipe.is_valid(&why)) throw UsageError(why);
  const std::filesystem::path output = a.output.empty() ? recipe.name + ".binary" : a.output;
  prepare_output(output, a.common.force);
  const synthetic::GenerateReport report = synthetic::generate(recipe, output);
  if (a.common.json) {
    fmt::print("{}\n",
               io::Json{{"file", output.string()}, {"cells", report.cells}, {"valid", report.valid}}.dump(2));
  } else {
    say(a.common, fmt::format("wrote {}: {} of {} cells above the horizon", output.string(), report.valid,
                              report.cells));
  }
  return kDone;
}

}  // namespace

Command add_export_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("export", "a fitted material for other programs");
  app->footer("Example: brdfit export blue-fabric.callisto.json --to merl -o blue-fabric.fitted.binary");
  app->add_option("file", a->file, "material .json")->required();
  app->add_option("--to", a->to, "format")->check(CLI::IsMember({"merl"}))->capture_default_str();
  app->add_option("-o,--output", a->output, "file to write; the material's name with .binary if not given")
      ->take_last();
  app->add_option("--grid", a->grid, "cells in theta_h, theta_d and phi_d")
      ->expected(3)
      ->delimiter(',')
      ->capture_default_str();
  app->add_option("--cell", a->cell, "where in its cell a value belongs")
      ->check(CLI::IsMember({"lower-edge", "centre"}))
      ->capture_default_str();
  add_common_options(*app, a->common, true);
  return {app, [a](const std::string&) { return run(*a); }};
}

}  // namespace brdfit::cli
