// brdfit synth: tables with known answers from recipes.
#include <fmt/format.h>

#include "cli/common.h"
#include "cli/threads.h"
#include "data/synthetic/generate.h"

namespace brdfit::cli {
namespace {

struct Arguments {
  CommonOptions common;
  std::vector<std::string> recipes;
  std::string output = ".";
};

int run(const Arguments& a) {
  const ThreadLimit threads(a.common.threads);
  std::vector<synthetic::Recipe> recipes;
  std::vector<std::filesystem::path> files;
  for (const std::string& file : a.recipes) {
    recipes.push_back(synthetic::read_recipe(file));
    files.push_back(std::filesystem::path(a.output) / (recipes.back().name + ".binary"));
    prepare_output(files.back(), a.common.force);
  }
  io::Json json = io::Json::array();
  for (std::size_t k = 0; k < recipes.size(); ++k) {
    if (interrupted()) throw std::runtime_error("interrupted; the files before are complete");
    const synthetic::GenerateReport report = synthetic::generate(recipes[k], files[k]);
    if (a.common.json) {
      json.push_back({{"file", files[k].string()},
                      {"cells", report.cells},
                      {"valid", report.valid},
                      {"dropped", report.dropped},
                      {"floored_at_zero", report.floored_at_zero},
                      {"seed", report.seed}});
    } else if (!a.common.quiet) {
      fmt::print("{}: {} of {} cells measured, {} dropped, {} noisy values below 0 stored as 0, seed {}\n",
                 files[k].string(), report.valid, report.cells, report.dropped, report.floored_at_zero,
                 report.seed);
    }
  }
  if (a.common.json) fmt::print("{}\n", json.dump(2));
  return kDone;
}

}  // namespace

Command add_synth_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("synth", "MERL-format files with known answers");
  app->footer(
      "Example: brdfit synth data/synthetic/recipes/blue-fabric.callisto.json -o tables\n"
      "writes tables/blue-fabric.callisto.binary.");
  app->add_option("recipes", a->recipes, "recipe JSON files")->required();
  app->add_option("-o,--output", a->output, "folder for the tables, which are named after their recipes")
      ->capture_default_str()
      ->take_last();
  add_common_options(*app, a->common, true);
  return {app, [a](const std::string&) { return run(*a); }};
}

}  // namespace brdfit::cli
