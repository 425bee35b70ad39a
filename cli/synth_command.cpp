// brdfit synth: tables and light stacks with known answers from recipes.
#include <fmt/format.h>

#include <optional>

#include "cli/common.h"
#include "cli/progress.h"
#include "cli/threads.h"
#include "data/synthetic/generate.h"
#include "data/synthetic/stack_files.h"

namespace brdfit::cli {
namespace {

struct Arguments {
  CommonOptions common;
  std::vector<std::string> recipes;
  std::string output = ".";
};

// A recipe of either kind, and the files that it makes.
struct Job {
  std::optional<synthetic::Recipe> table;
  std::optional<synthetic::StackRecipe> stack;
  std::vector<std::filesystem::path> files;
};

Job job_of(const std::string& file, const Arguments& a) {
  Job job;
  const io::Json json = io::read_json(file);
  if (synthetic::is_stack_recipe(json)) {
    job.stack = synthetic::stack_recipe_from_json(json, file);
    job.files = synthetic::stack_paths(*job.stack, a.output);
  } else {
    job.table = synthetic::recipe_from_json(json, file);
    job.files = {std::filesystem::path(a.output) / (job.table->name + ".binary")};
  }
  for (const std::filesystem::path& path : job.files) prepare_output(path, a.common.force);
  return job;
}

io::Json make_table(const synthetic::Recipe& recipe, const std::filesystem::path& file, const Arguments& a) {
  const synthetic::GenerateReport report = synthetic::generate(recipe, file);
  if (!a.common.json && !a.common.quiet) {
    fmt::print("{}: {} of {} cells measured, {} dropped, {} noisy values below 0 stored as 0, seed {}\n",
               file.string(), report.valid, report.cells, report.dropped, report.floored_at_zero,
               report.seed);
  }
  return {{"file", file.string()},
          {"cells", report.cells},
          {"valid", report.valid},
          {"dropped", report.dropped},
          {"floored_at_zero", report.floored_at_zero},
          {"seed", report.seed}};
}

io::Json make_stack(const Job& job, const Arguments& a) {
  const synthetic::StackRecipe& recipe = *job.stack;
  Progress progress(static_cast<std::size_t>(recipe.lights.count), a.common.quiet || a.common.json);
  synthetic::write_stack(recipe, a.output, [&](std::size_t) {
    if (interrupted()) throw std::runtime_error("interrupted; the stack has no manifest");
    progress.step("photographs");
  });
  const std::string manifest = job.files.back().string();
  if (!a.common.json && !a.common.quiet) {
    fmt::print("{}: {} lights, {} x {} texels, seed {}\n", manifest, recipe.lights.count, recipe.width,
               recipe.height, recipe.seed);
  }
  return {{"file", manifest},
          {"lights", recipe.lights.count},
          {"width", recipe.width},
          {"height", recipe.height},
          {"seed", recipe.seed}};
}

int run(const Arguments& a) {
  const ThreadLimit threads(a.common.threads);
  std::vector<Job> jobs;
  for (const std::string& file : a.recipes) jobs.push_back(job_of(file, a));
  io::Json json = io::Json::array();
  for (const Job& job : jobs) {
    if (interrupted()) throw std::runtime_error("interrupted; the files before are complete");
    json.push_back(job.stack ? make_stack(job, a) : make_table(*job.table, job.files[0], a));
  }
  if (a.common.json) fmt::print("{}\n", json.dump(2));
  return kDone;
}

}  // namespace

Command add_synth_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("synth", "MERL-format files and light stacks with known answers");
  app->footer(
      "Example: brdfit synth data/synthetic/recipes/blue-fabric.callisto.json -o tables\n"
      "writes tables/blue-fabric.callisto.binary.");
  app->add_option("recipes", a->recipes, "recipe JSON files")->required();
  app->add_option("-o,--output", a->output, "folder for the files, which are named after their recipes")
      ->capture_default_str()
      ->take_last();
  add_common_options(*app, a->common, true);
  return {app, [a](const std::string&) { return run(*a); }};
}

}  // namespace brdfit::cli
