// brdfit demo: the main job on data that it makes itself.
#include <fmt/format.h>

#include <array>

#include "cli/common.h"
#include "cli/result_json.h"
#include "cli/result_text.h"
#include "cli/table_input.h"
#include "cli/threads.h"
#include "cli/version.h"
#include "data/synthetic/generate.h"
#include "fit/fit.h"
#include "io/material_json.h"
#include "io/sha256.h"

namespace brdfit::cli {
namespace {

struct Arguments {
  CommonOptions common;
  std::string output = "demo";
};

// Two made-up materials, each with effects that Lambert + GGX lacks, measured with 1% noise.
std::vector<synthetic::Recipe> demo_recipes() {
  std::vector<synthetic::Recipe> recipes(2);
  Material cloth(Model::kCallisto);
  cloth.set_effects(Effects().with(Effect::kDiffuseFresnel).with(Effect::kRetroreflection));
  cloth.set("base_color", Rgb{0.05, 0.09, 0.25});
  cloth.set("roughness", 0.7);
  cloth.set("specular", 0.2);
  cloth.set("diffuse_fresnel", 6.0);
  cloth.set("diffuse_fresnel_tint", Rgb{1.0, 0.8, 0.6});
  cloth.set("retroreflection", 2.5);
  recipes[0].name = "cloth";
  recipes[0].material = cloth;
  Material lacquer(Model::kCallisto);
  lacquer.set_effects(Effects().with(Effect::kDualSpecular).with(Effect::kSpecularFresnelFalloff));
  lacquer.set("base_color", Rgb{0.35, 0.06, 0.03});
  lacquer.set("roughness", 0.12);
  lacquer.set("specular_fresnel_falloff", 0.4);
  lacquer.set("dual_specular_roughness_scale", 3.5);
  lacquer.set("dual_specular_opacity", 0.3);
  recipes[1].name = "lacquer";
  recipes[1].material = lacquer;
  for (synthetic::Recipe& recipe : recipes) {
    recipe.source = "made up for the demo";
    recipe.noise.multiplicative = 0.01;
  }
  return recipes;
}

std::filesystem::path in(const Arguments& a, const std::string& name) {
  return std::filesystem::path(a.output) / name;
}

// Every file that the demo writes, so that none is overwritten unasked.
void prepare_outputs(const Arguments& a, const std::vector<synthetic::Recipe>& recipes) {
  for (const synthetic::Recipe& recipe : recipes) {
    for (const char* ending : {".recipe.json", ".binary", ".fitted.binary"}) {
      prepare_output(in(a, recipe.name + ending), a.common.force);
    }
    for (const Model model : all_models()) {
      prepare_output(in(a, fmt::format("{}.{}.json", recipe.name, name_of(model))), a.common.force);
    }
  }
}

// Fits all models to one table and writes their materials.
std::vector<fit::FitResult> fit_all(const Arguments& a, const std::string& name, const MeasuredTable& table) {
  const Provenance provenance = {
      name + ".binary", io::sha256_of_file(in(a, name + ".binary")), kVersion, false, 0, "lower-edge"};
  std::vector<fit::FitResult> results;
  for (const Model model : all_models()) {
    if (interrupted()) throw std::runtime_error("interrupted; the files before are complete");
    fit::FitOptions options;
    options.model = model;
    results.push_back(fit::fit(table, options));
    const auto file = in(a, fmt::format("{}.{}.json", name, name_of(model)));
    io::write_material(file, results.back().material, evidence_to_json(results.back(), provenance));
  }
  return results;
}

// Writes the fitted Callisto material as a table, reads it back and compares it with the measured one.
fit::Evaluation round_trip(const Arguments& a, const std::string& name, const Material& material,
                           const MeasuredTable& reference) {
  synthetic::Recipe recipe;
  recipe.name = name;
  recipe.material = material;
  synthetic::generate(recipe, in(a, name + ".fitted.binary"));
  return fit::evaluate(load_table(in(a, name + ".fitted.binary").string(), {}, a.common).table, reference);
}

int run(const Arguments& a) {
  const ThreadLimit threads(a.common.threads);
  const std::vector<synthetic::Recipe> recipes = demo_recipes();
  prepare_outputs(a, recipes);
  io::Json json;
  for (const synthetic::Recipe& recipe : recipes) {
    say(a.common,
        fmt::format("{}: making {}, with 1% noise", recipe.name, in(a, recipe.name + ".binary").string()));
    synthetic::write_recipe(in(a, recipe.name + ".recipe.json"), recipe);
    synthetic::generate(recipe, in(a, recipe.name + ".binary"));
    const LoadedTable loaded = load_table(in(a, recipe.name + ".binary").string(), {}, a.common);
    const std::vector<fit::FitResult> results = fit_all(a, recipe.name, loaded.table);
    const fit::FitResult& callisto = results.back();
    const fit::Evaluation again = round_trip(a, recipe.name, callisto.material, loaded.table);
    if (a.common.json) {
      for (const fit::FitResult& result : results) {
        json[recipe.name][std::string(name_of(result.options.model))] = evaluation_to_json(result.evaluation);
      }
      json[recipe.name]["exported"] = evaluation_to_json(again);
      continue;
    }
    fmt::print("{}, fitted:\n{}\n{}\n", recipe.name, format_errors(results), format_parameters(callisto));
    fmt::print(
        "the fitted Callisto material exported as a table and read back: log-ratio {:.2f}% on the table\n\n",
        again.table.log_ratio_pct);
  }
  if (a.common.json) fmt::print("{}\n", json.dump(2));
  say(a.common, "everything is in " + a.output);
  return kDone;
}

}  // namespace

Command add_demo_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("demo", "the main job on synthetic data");
  app->footer("Example: brdfit demo -o demo");
  app->add_option("-o,--output", a->output, "folder for everything that the demo writes")
      ->capture_default_str()
      ->take_last();
  add_common_options(*app, a->common, true);
  return {app, [a] { return run(*a); }};
}

}  // namespace brdfit::cli
