// brdfit fit: a MERL file in, one material per model and their errors out.
#include <fmt/format.h>

#include "cli/common.h"
#include "cli/fit_options.h"
#include "cli/fit_request.h"
#include "cli/load_floor.h"
#include "cli/result_json.h"
#include "cli/result_text.h"
#include "cli/sphere_judge.h"
#include "cli/table_input.h"
#include "cli/threads.h"
#include "cli/version.h"
#include "io/material_json.h"
#include "io/sha256.h"

namespace brdfit::cli {
namespace {

struct Arguments {
  CommonOptions common;
  FitArguments fit;
  std::string file;
  std::string output = ".";
  bool timings = false;
};

std::filesystem::path material_path(const Arguments& a, const fit::FitOptions& options) {
  return std::filesystem::path(a.output) /
         fmt::format("{}.{}.json", base_name(a.file), name_of(options.model));
}

io::Json result_json(const Arguments& a, const JudgedFit& judged, double load_seconds) {
  const fit::FitResult& result = judged.fit;
  io::Json json;
  json["material"] = material_path(a, result.options).string();
  json.update(evaluation_to_json(result.evaluation, judged.sphere.delta_e));
  json["free_parameters"] = result.free_parameters;
  add_choices(judged, json);
  json["converged"] = result.converged;
  json["notes"] = result.notes;
  io::Json timings = {{"load", load_seconds}};
  timings.update(evidence_to_json(judged, {})["timings_seconds"]);
  json["timings_seconds"] = timings;
  return json;
}

void print_result(const Arguments& a, const std::vector<JudgedFit>& results, const LoadedTable& loaded) {
  const double floor_seconds = a.timings ? load_floor_seconds(a.file) : 0.0;
  if (a.common.json) {
    io::Json json;
    for (const JudgedFit& judged : results) {
      json["models"][std::string(name_of(judged.fit.options.model))] = result_json(a, judged, loaded.seconds);
    }
    if (a.timings) {
      json["timings_seconds"] = {{"load_floor", floor_seconds}};
      json["peak_memory_bytes"] = peak_memory_bytes();
    }
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}\n", format_errors(results));
  for (const JudgedFit& judged : results) {
    fmt::print("{}{}\n", format_parameters(judged.fit), format_evidence(judged));
    if (judged.fit.selection) fmt::print("{}\n", format_ladder(judged.fit));
  }
  if (a.timings)
    fmt::print("{}\n", format_timings(results, loaded.seconds, floor_seconds, peak_memory_bytes()));
  for (const JudgedFit& judged : results)
    say(a.common, "wrote " + material_path(a, judged.fit.options).string());
}

int run(const Arguments& a, const std::string& command_line) {
  const std::vector<fit::FitOptions> all_options = make_fit_options(a.fit);
  for (const fit::FitOptions& options : all_options)
    prepare_output(material_path(a, options), a.common.force);
  const ThreadLimit threads(a.common.threads);
  const LoadedTable loaded = load_table(a.file, make_read_options(a.fit), a.common);
  const TableJudge judge(loaded.table, all_options.size());
  std::vector<JudgedFit> results;
  for (const fit::FitOptions& options : all_options) {
    if (interrupted()) throw std::runtime_error("interrupted; nothing was written");
    say(a.common, fmt::format("fitting {} to {}", title_of(options.model), base_name(a.file)));
    results.push_back(fit_and_judge(loaded.table, options, judge));
  }
  Provenance provenance = {std::filesystem::path(a.file).filename().string(),
                           io::sha256_of_file(a.file),
                           kVersion,
                           a.fit.lenient,
                           loaded.report.non_finite_values,
                           a.fit.cell,
                           path_from(a.output, a.file),
                           command_line};
  for (const JudgedFit& judged : results) {
    provenance.request = request_of(judged.fit.options, a.fit);
    io::write_material(material_path(a, judged.fit.options), judged.fit.material,
                       evidence_to_json(judged, provenance));
  }
  print_result(a, results, loaded);
  return kDone;
}

}  // namespace

Command add_fit_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("fit", "fit materials to a measured table");
  app->footer(
      "Example: brdfit fit blue-fabric.binary --model all -o fits\n"
      "writes fits/blue-fabric.callisto.json and one file for every other model.");
  app->add_option("file", a->file, "MERL-format .binary file")->required();
  app->add_option("-o,--output", a->output, "folder for the material files")
      ->capture_default_str()
      ->take_last();
  app->add_flag("--timings", a->timings,
                "print the time of each phase in units of the load floor, and peak memory");
  add_fit_arguments(*app, a->fit);
  add_common_options(*app, a->common, true);
  return {app, [a](const std::string& command_line) { return run(*a, command_line); }};
}

}  // namespace brdfit::cli
