// brdfit export: a material in the form of others.
#include <fmt/format.h>

#include "brdf/shader/material_shader.h"
#include "cli/common.h"
#include "cli/threads.h"
#include "cli/version.h"
#include "data/synthetic/generate.h"
#include "io/atomic_file.h"
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
  std::string parameters = "baked";
  std::string prefix = "brdf";
};

std::filesystem::path output_of(const Arguments& a, const std::string& ending) {
  std::filesystem::path output = a.output.empty() ? base_name(a.file) + ending : a.output;
  prepare_output(output, a.common.force);
  return output;
}

// A table of a material is what a recipe without noise makes: each cell the mean of both orders of its
// directions.
int export_table(const Arguments& a) {
  synthetic::Recipe recipe;
  recipe.name = base_name(a.file);
  recipe.material = io::read_material(a.file);
  recipe.grid.n_theta_h = a.grid[0];
  recipe.grid.n_theta_d = a.grid[1];
  recipe.grid.n_phi_d = a.grid[2];
  recipe.grid.anchor = a.cell == "centre" ? CellAnchor::kCentre : CellAnchor::kLowerEdge;
  std::string why;
  if (!recipe.is_valid(&why)) throw UsageError(why);
  const std::filesystem::path output = output_of(a, ".binary");
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

int export_shader(const Arguments& a) {
  shader::ShaderOptions options;
  options.language = a.to == "glsl" ? shader::Language::kGlsl : shader::Language::kHlsl;
  options.baked = a.parameters == "baked";
  options.prefix = a.prefix;
  options.source = std::filesystem::path(a.file).filename().string();
  options.made_by = fmt::format("brdfit {}", kVersion);
  std::string why;
  if (!options.is_valid(&why)) throw UsageError("--prefix: " + why);
  const Material material = io::read_material(a.file);
  const std::filesystem::path output = output_of(a, "." + a.to);
  io::AtomicFile file(output);
  file.write(shader::material_shader(material, options));
  file.commit();
  if (a.common.json) {
    fmt::print("{}\n", io::Json{{"file", output.string()}, {"function", a.prefix + "_eval_cos"}}.dump(2));
  } else {
    say(a.common, fmt::format("wrote {}: {}_eval_cos", output.string(), a.prefix));
  }
  return kDone;
}

}  // namespace

Command add_export_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("export", "a fitted material for other programs");
  app->footer(
      "Example: brdfit export blue-fabric.callisto.json --to merl -o blue-fabric.fitted.binary\n"
      "         brdfit export blue-fabric.callisto.json --to glsl --prefix blue_fabric\n"
      "A shader holds the material's own effects alone, needs no other file, and says at its top how it "
      "compiles.");
  app->add_option("file", a->file, "material .json")->required();
  app->add_option("--to", a->to, "a MERL-format table, or the source of a shader")
      ->check(CLI::IsMember({"merl", "glsl", "hlsl"}))
      ->capture_default_str();
  app->add_option("-o,--output", a->output,
                  "file to write; the material's name with .binary, .glsl or .hlsl if not given")
      ->take_last();
  app->add_option("--grid", a->grid, "of a table: cells in theta_h, theta_d and phi_d")
      ->expected(3)
      ->delimiter(',')
      ->capture_default_str();
  app->add_option("--cell", a->cell, "of a table: where in its cell a value belongs")
      ->check(CLI::IsMember({"lower-edge", "centre"}))
      ->capture_default_str();
  app->add_option("--parameters", a->parameters, "of a shader: constants in it, or a struct to fill in")
      ->check(CLI::IsMember({"baked", "struct"}))
      ->capture_default_str();
  app->add_option("--prefix", a->prefix, "of a shader: what every name starts with")->capture_default_str();
  add_common_options(*app, a->common, true);
  return {app, [a](const std::string&) {
            const ThreadLimit threads(a->common.threads);
            return a->to == "merl" ? export_table(*a) : export_shader(*a);
          }};
}

}  // namespace brdfit::cli
