// brdfit demo: the main job on data that it makes itself.
#include <fmt/format.h>

#include <array>

#include "cli/common.h"
#include "cli/fit_request.h"
#include "cli/report_data.h"
#include "cli/result_json.h"
#include "cli/result_text.h"
#include "cli/sphere_judge.h"
#include "cli/table_input.h"
#include "cli/threads.h"
#include "cli/version.h"
#include "data/synthetic/generate.h"
#include "fit/fit.h"
#include "io/image_file.h"
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
  prepare_output(in(a, "report.html"), a.common.force);
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
std::vector<JudgedFit> fit_all(const Arguments& a, const std::string& name, const MeasuredTable& table,
                               const TableJudge& judge, const std::string& command_line) {
  const std::string input = name + ".binary";
  Provenance provenance = {
      input, io::sha256_of_file(in(a, input)), kVersion, false, 0, "lower-edge", input, command_line};
  std::vector<JudgedFit> results;
  for (const Model model : all_models()) {
    if (interrupted()) throw std::runtime_error("interrupted; the files before are complete");
    fit::FitOptions options;
    options.model = model;
    options.choose_groups = true;  // as `fit` does
    options.choose_samples = true;
    provenance.request = request_of(options, {});
    results.push_back(fit_and_judge(table, options, judge));
    const auto file = in(a, fmt::format("{}.{}.json", name, name_of(model)));
    io::write_material(file, results.back().fit.material, evidence_to_json(results.back(), provenance));
  }
  return results;
}

struct RoundTrip {
  fit::Evaluation evaluation;
  render::SphereDeltaE sphere;
};

// Writes the fitted Callisto material as a table, reads it back and compares it with the measured one.
RoundTrip round_trip(const Arguments& a, const std::string& name, const Material& material,
                     const MeasuredTable& reference, const TableJudge& judge) {
  synthetic::Recipe recipe;
  recipe.name = name;
  recipe.material = material;
  synthetic::generate(recipe, in(a, name + ".fitted.binary"));
  const LoadedTable again = load_table(in(a, name + ".fitted.binary").string(), {}, a.common);
  return {fit::evaluate(again.table, reference), judge(again.table).delta_e};
}

// Everything that was fitted, as one HTML file.
std::filesystem::path write_report(const Arguments& a, const std::string& command_line) {
  const std::filesystem::path file = in(a, "report.html");
  io::write_text(file, render::report_html(make_report(a.output, {}, command_line, a.common)));
  return file;
}

int run(const Arguments& a, const std::string& command_line) {
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
    const TableJudge judge(loaded.table, all_models().size() + 1);
    const std::vector<JudgedFit> results = fit_all(a, recipe.name, loaded.table, judge, command_line);
    const fit::FitResult& callisto = results.back().fit;
    const RoundTrip again = round_trip(a, recipe.name, callisto.material, loaded.table, judge);
    if (a.common.json) {
      for (const JudgedFit& judged : results) {
        json[recipe.name][std::string(name_of(judged.fit.options.model))] =
            evaluation_to_json(judged.fit.evaluation, judged.sphere.delta_e);
      }
      json[recipe.name]["exported"] = evaluation_to_json(again.evaluation, again.sphere);
      continue;
    }
    fmt::print("{}, fitted:\n{}\n{}\n", recipe.name, format_errors(results), format_parameters(callisto));
    fmt::print(
        "the fitted Callisto material exported as a table and read back: log-ratio {:.2f}% on the "
        "table, sphere dE {:.2f}\n\n",
        again.evaluation.table.log_ratio_pct, again.sphere.mean);
  }
  const std::filesystem::path report = write_report(a, command_line);
  if (a.common.json) {
    json["report"] = report.string();
    fmt::print("{}\n", json.dump(2));
  }
  say(a.common, fmt::format("everything is in {}; look at {}", a.output, report.string()));
  return kDone;
}

}  // namespace

Command add_demo_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("demo", "the main job on synthetic data, ending in a report");
  app->footer("Example: brdfit demo -o demo");
  app->add_option("-o,--output", a->output, "folder for everything that the demo writes")
      ->capture_default_str()
      ->take_last();
  add_common_options(*app, a->common, true);
  return {app, [a](const std::string& command_line) { return run(*a, command_line); }};
}

}  // namespace brdfit::cli
