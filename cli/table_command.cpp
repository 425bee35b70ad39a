// brdfit table: errors over many tables and models, fitted here or given as files.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "cli/common.h"
#include "cli/database_run.h"
#include "cli/fit_options.h"
#include "cli/fit_request.h"
#include "cli/measure_names.h"
#include "cli/result_json.h"
#include "cli/result_text.h"
#include "cli/sphere_judge.h"
#include "cli/table_input.h"
#include "cli/table_merge.h"
#include "cli/table_output.h"
#include "cli/threads.h"
#include "fit/fit.h"
#include "io/material_json.h"

namespace brdfit::cli {
namespace {

struct Arguments {
  CommonOptions common;
  FitArguments fit;
  std::vector<std::string> inputs;
  std::vector<std::string> against;
  std::string output;
  std::string shard;
  bool merge = false;
  bool published = false;
  bool timings = false;
  std::function<std::string()> fit_options;  // as typed
};

// One line of the result: a measured file and what was held against it.
struct Row {
  std::string file;
  std::string candidate;
  fit::Evaluation evaluation;
  render::SphereDeltaE sphere;
  double seconds = 0.0;
};

bool is_material_file(const std::string& file) {
  return std::filesystem::path(file).extension() == ".json";
}

void compare_given(const Arguments& a, const std::string& file, const MeasuredTable& reference,
                   std::vector<Row>& rows) {
  const TableJudge judge(reference, a.against.size());
  for (const std::string& candidate : a.against) {
    const Stopwatch watch;
    fit::Evaluation evaluation;
    render::SphereDeltaE sphere;
    if (is_material_file(candidate)) {
      const Material material = io::read_material(candidate);
      evaluation = fit::evaluate(material, reference, a.fit.max_theta_deg);
      sphere = judge(material).delta_e;
    } else {
      const MeasuredTable table = load_table(candidate, make_read_options(a.fit), a.common).table;
      if (table.grid() != reference.grid())
        throw UsageError(candidate + " and " + file + " have different grids");
      evaluation = fit::evaluate(table, reference, a.fit.max_theta_deg);
      sphere = judge(table).delta_e;
    }
    rows.push_back({file, candidate, evaluation, sphere, watch.seconds()});
  }
}

void fit_models(const std::string& file, const MeasuredTable& reference,
                const std::vector<fit::FitOptions>& all_options, std::vector<Row>& rows) {
  const TableJudge judge(reference, all_options.size());
  for (const fit::FitOptions& options : all_options) {
    if (interrupted()) return;
    const JudgedFit judged = fit_and_judge(reference, options, judge);
    rows.push_back({file, std::string(name_of(options.model)), judged.fit.evaluation, judged.sphere.delta_e,
                    judged.total_seconds()});
  }
}

fit::Measures mean_of(const std::vector<fit::Measures>& all) {
  fit::Measures mean;
  const auto n = static_cast<double>(all.size());
  for (const fit::Measures& m : all) {
    mean.log_ratio_pct += m.log_ratio_pct / n;
    mean.slice_pct += m.slice_pct / n;
    mean.relative += m.relative / n;
    mean.cube_root += m.cube_root / n;
    mean.srgb += m.srgb / n;
    mean.cosine_l2 += m.cosine_l2 / n;
    mean.cells += m.cells;
  }
  return mean;
}

render::SphereDeltaE mean_of(const std::vector<render::SphereDeltaE>& all) {
  render::SphereDeltaE mean;
  const auto n = static_cast<double>(all.size());
  for (const render::SphereDeltaE& sphere : all) {
    mean.mean += sphere.mean / n;
    for (std::size_t k = 0; k < mean.by_light.size(); ++k) mean.by_light[k] += sphere.by_light[k] / n;
    mean.pixels += sphere.pixels;
    mean.skipped += sphere.skipped;
  }
  return mean;
}

// The mean over files for each candidate, where there are several files.
std::vector<Row> means(const std::vector<Row>& rows) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<const Row*>> by_candidate;
  for (const Row& row : rows) {
    if (!by_candidate.contains(row.candidate)) order.push_back(row.candidate);
    by_candidate[row.candidate].push_back(&row);
  }
  std::vector<Row> result;
  for (const std::string& candidate : order) {
    const std::vector<const Row*>& group = by_candidate[candidate];
    if (group.size() < 2) continue;
    Row mean = {fmt::format("mean of {}", group.size()), candidate, {}, {}, 0.0};
    std::vector<fit::Measures> slices;
    std::vector<fit::Measures> tables;
    std::vector<render::SphereDeltaE> spheres;
    for (const Row* row : group) {
      slices.push_back(row->evaluation.slice);
      tables.push_back(row->evaluation.table);
      spheres.push_back(row->sphere);
      mean.seconds += row->seconds / static_cast<double>(group.size());
      mean.evaluation.reciprocity_gap_pct +=
          row->evaluation.reciprocity_gap_pct / static_cast<double>(group.size());
    }
    mean.evaluation.slice = mean_of(slices);
    mean.evaluation.table = mean_of(tables);
    mean.sphere = mean_of(spheres);
    result.push_back(std::move(mean));
  }
  return result;
}

void print_rows(const CommonOptions& common, const std::vector<Row>& rows,
                const std::map<std::string, std::string>& failures) {
  const std::vector<Row> mean_rows = means(rows);
  if (common.json) {
    io::Json json = {
        {"rows", io::Json::array()}, {"means", io::Json::array()}, {"failures", io::Json::object()}};
    for (const auto* group : {&rows, &mean_rows}) {
      for (const Row& row : *group) {
        io::Json entry = {{"file", row.file}, {"candidate", row.candidate}};
        entry.update(evaluation_to_json(row.evaluation, row.sphere));
        entry["timings_seconds"] = {{"fit", row.seconds}};
        json[group == &rows ? "rows" : "means"].push_back(entry);
      }
    }
    for (const auto& [file, why] : failures) json["failures"][file] = why;
    fmt::print("{}\n", json.dump(2));
    return;
  }
  std::vector<std::string> heading = {"file", "candidate"};
  std::ranges::copy(measure_heading(), std::back_inserter(heading));
  heading.emplace_back(kGapTitle);
  heading.emplace_back("seconds");
  std::vector<std::vector<std::string>> cells;
  for (const auto* group : {&rows, &mean_rows}) {
    for (const Row& row : *group) {
      std::vector<std::string> line = {group == &rows ? base_name(row.file) : row.file, row.candidate};
      std::ranges::copy(measure_cells(row.evaluation, row.sphere), std::back_inserter(line));
      line.push_back(gap_text(row.evaluation.reciprocity_gap_pct));
      line.push_back(fmt::format("{:.3f}", row.seconds));
      cells.push_back(std::move(line));
    }
  }
  fmt::print("{}", format_table(heading, cells));
}

// Options that need each other, or do not go together.
void check(const Arguments& a) {
  if (a.output.empty()) {
    if (!a.shard.empty()) throw UsageError("--shard needs -o");
    if (a.merge) throw UsageError("--merge needs -o");
    if (a.timings) throw UsageError("--timings needs -o");
    if (a.published) throw UsageError("--published needs -o");
  }
  if (!a.output.empty() && !a.against.empty()) {
    throw UsageError("--against compares what is there, and -o is for fits");
  }
  if (a.output.empty() && a.fit.held_out_folds > 0) {
    throw UsageError("--held-out writes into results: give -o, or ask fit for one table");
  }
  if (a.merge && !a.shard.empty()) throw UsageError("--merge joins shards, so it has none itself");
}

int run_into_folder(const Arguments& a) {
  DatabaseRun run = {
      a.common,  a.fit,          {}, a.output, a.shard.empty() ? Shard{} : parse_shard(a.shard), a.published,
      a.timings, a.fit_options()};
  run.files = table_files(a.inputs);
  const ThreadLimit threads(a.common.threads);
  return run_database(run);
}

int merge(const Arguments& a) {
  const ResultTable table = merge_runs(a.inputs, a.output, a.common.force);
  if (a.common.json) {
    fmt::print("{}\n", table_json(table, {}).dump(2));
  } else {
    fmt::print("{}\n{}", table_text(table), timings_text(table));
  }
  return table.failures.empty() ? kDone : kNotAllDone;
}

int run(const Arguments& a) {
  check(a);
  if (a.merge) return merge(a);
  if (!a.output.empty()) return run_into_folder(a);
  const std::vector<fit::FitOptions> all_options = make_fit_options(a.fit);
  const std::vector<std::string> files = table_files(a.inputs);
  const ThreadLimit threads(a.common.threads);
  std::vector<Row> rows;
  std::map<std::string, std::string> failures;
  for (std::size_t k = 0; k < files.size() && !interrupted(); ++k) {
    say(a.common, fmt::format("[{}/{}] {}", k + 1, files.size(), files[k]));
    try {
      const LoadedTable loaded = load_table(files[k], make_read_options(a.fit), a.common);
      if (a.against.empty()) {
        fit_models(files[k], loaded.table, all_options, rows);
      } else {
        compare_given(a, files[k], loaded.table, rows);
      }
    } catch (const io::IoError& error) {
      fmt::print(stderr, "brdfit table: {}\n", error.what());
      failures[files[k]] = error.what();
    }
  }
  if (failures.size() == files.size()) return kUnusableInput;
  print_rows(a.common, rows, failures);
  if (interrupted()) {
    fmt::print(stderr, "brdfit table: interrupted; the rows above are complete\n");
    return kFailed;
  }
  return failures.empty() ? kDone : kNotAllDone;
}

}  // namespace

Command add_table_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("table", "error tables over many measured tables and models");
  app->footer(
      "Example: brdfit table merl/ --model all\n"
      "Example: brdfit table merl/ --model all -o out\n"
      "writes a result for each file and model and the tables; started again, it goes on where it stopped.\n"
      "Example: brdfit table merl/ --shard 2/8 -o out/2\n"
      "does the second eighth of the files; brdfit table --merge out/* -o whole joins them.\n"
      "Example: brdfit table blue-fabric.binary --against fit.json exported.binary\n"
      "holds materials or tables that exist against the measured one, without fitting.");
  app->add_option("inputs", a->inputs, "MERL-format files, or folders of them (--merge: folders of runs)")
      ->required();
  app->add_option("--against", a->against,
                  "material JSON or MERL-format files to compare instead of fitting");
  app->add_option("-o,--output", a->output, "folder for a file per result and for the tables")->take_last();
  app->add_option("--shard", a->shard, "I/N: do only the I-th of N parts of the files");
  app->add_flag("--merge", a->merge, "join the folders of shards into one");
  app->add_flag(
      "--published", a->published,
      "compare the parameters that the Callisto talk set by hand too, for the materials of that name");
  app->add_flag("--timings", a->timings,
                "tell times in units of the load floor, memory per worker, and how the run scales beside a "
                "plain loop (fits some tables again)");
  add_fit_arguments(*app, a->fit);
  add_common_options(*app, a->common, true);
  a->fit_options = [app] { return given_fit_options(*app); };
  return {app, [a](const std::string&) { return run(*a); }};
}

}  // namespace brdfit::cli
