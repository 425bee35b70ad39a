// brdfit cost: what accuracy costs in time, for a table or a folder of them.
#include "cli/cost/cost_command.h"

#include <fmt/format.h>

#include <cstdio>

#include "cli/cost/cost_database.h"
#include "cli/cost/cost_page.h"
#include "cli/cost/table_cost.h"
#include "cli/table_input.h"
#include "cli/threads.h"
#include "io/sha256.h"

namespace brdfit::cli {
namespace {

struct Arguments {
  CommonOptions common;
  FitArguments fit;
  std::string input;
  std::string output = ".";
  std::string device;
  std::string error = kTableLeadingError;
  bool quick = false;
  int repeats = TableSweepOptions().repeats;
  int folds = TableSweepOptions().folds;
  Limits limits;
};

// What --quick makes of what was not given.
constexpr int kQuickRepeats = 3;
constexpr int kQuickFolds = 2;

bool is_stack(const std::string& input) {
  return std::filesystem::path(input).extension() == ".json";
}

TableCostRequest request_from(const Arguments& a, const std::string& command_line) {
  TableCostRequest request;
  request.common = a.common;
  request.sweep = {a.fit, a.quick, a.repeats, a.folds, a.error, a.device};
  request.limits = a.limits;
  request.output = a.output;
  request.command = command_line;
  const std::vector<std::string> keys = table_error_keys(a.folds);
  if (std::ranges::find(keys, a.error) == keys.end()) {
    throw UsageError(fmt::format("--error is \"{}\", not one of {}", a.error, fmt::join(keys, ", ")));
  }
  return request;
}

void print_text(const Arguments& a, const std::string& file, const TableCost& cost) {
  fmt::print("{}\n", fronts_text(cost.run));
  for (const Finding& finding : cost.findings) fmt::print("{}\n", finding.text);
  for (const std::string& note : cost.run.notes) fmt::print("note: {}\n", note);
  if (cost.budget) fmt::print("\n{}\n", budget_text(*cost.budget, a.limits, cost.run));
  // What is said goes to another stream.
  std::fflush(stdout);
  const CostPaths paths = cost_paths(a.output, base_name(file));
  say(a.common, fmt::format("wrote {}, .html and .json", paths.csv.string()));
  if (!cost.material.empty()) say(a.common, "wrote " + cost.material.string());
}

bool is_over_budget(const TableCost& cost) {
  return cost.budget && !cost.budget->point;
}

int run_one(const Arguments& a, const TableCostRequest& request) {
  prepare_table_cost(request, a.input);
  const TableCost cost = measure_table_cost(request, a.input, run_time_evaluators(a.device));
  if (a.common.json) {
    fmt::print("{}\n", cost.json.dump(2));
  } else {
    print_text(a, a.input, cost);
  }
  return is_over_budget(cost) ? kNotAllDone : kDone;
}

// A table's run: the one that is there if it was asked for like this one and needs nothing else, or a new
// one.
class Database {
 public:
  Database(const Arguments& a, const TableCostRequest& request)
      : a_(a), request_(request), wanted_(request_of(request)), files_(table_files({a.input})) {
    prepare_output(output("csv"), true);
    for (const std::string& file : files_) {
      if (!is_finished(file)) prepare_table_cost(request_, file);
    }
  }

  int go() {
    const Evaluators evaluators = run_time_evaluators(a_.device);
    for (std::size_t k = 0; k < files_.size(); ++k) {
      stop_if_interrupted();
      const bool is_there = is_finished(files_[k]);
      say(a_.common, fmt::format("[{}/{}] {}{}", k + 1, files_.size(), base_name(files_[k]),
                                 is_there ? ": finished before" : ""));
      try {
        if (is_there) {
          runs_.push_back(read_cost_run(json_of(files_[k]), nullptr));
        } else {
          measure(files_[k], evaluators);
        }
      } catch (const io::IoError& error) {
        if (error.side() == io::IoError::Side::kOutput) throw;
        fail(files_[k], error.what());
      } catch (const std::invalid_argument& error) {
        fail(files_[k], error.what());
      }
    }
    if (runs_.empty()) return kUnusableInput;
    write();
    return failures_.empty() && over_budget_ == 0 ? kDone : kNotAllDone;
  }

 private:
  std::filesystem::path output(const char* ending) const {
    return std::filesystem::path(a_.output) / fmt::format("cost.{}", ending);
  }

  std::filesystem::path json_of(const std::string& file) const {
    return cost_paths(a_.output, base_name(file)).json;
  }

  // A budget is spent anew, as its second measurement is what it is about.
  bool is_finished(const std::string& file) const {
    if (request_.limits.any() || a_.common.force || !std::filesystem::exists(json_of(file))) return false;
    try {
      CostProvenance provenance;
      read_cost_run(json_of(file), &provenance);
      return provenance.request == wanted_ && provenance.sha256 == io::sha256_of_file(file);
    } catch (const io::IoError&) {
      return false;
    }
  }

  void measure(const std::string& file, const Evaluators& evaluators) {
    const TableCost cost = measure_table_cost(request_, file, evaluators);
    if (is_over_budget(cost)) ++over_budget_;
    if (cost.budget) say(a_.common, budget_text(*cost.budget, request_.limits, cost.run));
    runs_.push_back(cost.run);
  }

  void fail(const std::string& file, const std::string& why) {
    fmt::print(stderr, "brdfit cost: {}\n", why);
    failures_[std::filesystem::path(file).filename().string()] = why;
  }

  void write() const {
    CostDatabase database = database_of(runs_);
    database.failures = failures_;
    const std::vector<std::string> sentences = database_sentences(database, runs_);
    const io::Json json = database_json(database, sentences);
    write_whole(output("csv"), database_csv(database));
    write_whole(output("html"), cost_page(runs_, sentences));
    io::write_json(output("json"), json);
    if (a_.common.json) {
      fmt::print("{}\n", json.dump(2));
      return;
    }
    for (const std::string& sentence : sentences) fmt::print("{}\n", sentence);
    say(a_.common, fmt::format("wrote {}, .html and .json", output("csv").string()));
  }

  const Arguments& a_;
  const TableCostRequest& request_;
  std::string wanted_;
  std::vector<std::string> files_;
  std::vector<CostRun> runs_;
  std::map<std::string, std::string> failures_;
  int over_budget_ = 0;
};

int run(const Arguments& a, const std::string& command_line) {
  if (is_stack(a.input)) throw UsageError(a.input + " is a light stack, which cost does not measure yet");
  const TableCostRequest request = request_from(a, command_line);
  const ThreadLimit threads(a.common.threads);
  if (std::filesystem::is_directory(a.input)) return Database(a, request).go();
  return run_one(a, request);
}

void add_limit(CLI::App& app, const char* name, std::optional<double>& limit, const char* help) {
  app.add_option_function<double>(
         name, [&limit](double value) { limit = value; }, help)
      ->check(CLI::NonNegativeNumber);
}

}  // namespace

Command add_cost_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app = program.add_subcommand("cost", "accuracy against time: what each choice of a fit buys");
  app->footer(
      "Accuracy is the inverse of the error that leads (--error): \"A reaches 94% of the accuracy of B\" "
      "says that\n"
      "100 x (error of B) / (error of A) is 94. Times are medians of repeats that were taken in turns, "
      "beside a\n"
      "reference workload; limits of time are held against upper quartiles, of the sweep and of a second\n"
      "measurement of the material that is written.\n"
      "Exit code 4: no point keeps the limits; the nearest one is named.\n"
      "Example: brdfit cost blue-fabric.binary -o out\n"
      "writes out/blue-fabric.cost.csv, .html and .json.\n"
      "Example: brdfit cost blue-fabric.binary --budget-ns 20 -o out\n"
      "writes out/blue-fabric.MODEL.json too, the most accurate material that is evaluated in 20 ns.\n"
      "Example: brdfit cost merl/ --quick -o out\n"
      "writes those files for each table, and out/cost.csv, .html and .json with quantiles over materials; "
      "started\n"
      "again, it goes on where it stopped.");
  app->add_option("input", a->input, "MERL-format .binary file, or a folder of them")->required();
  app->add_option("-o,--output", a->output, "folder for the files")->capture_default_str()->take_last();
  app->add_option("--error", a->error,
                  "the error that decides: slice_, table_ or held_out_ with a measure, or sphere_delta_e")
      ->capture_default_str();
  add_limit(*app, "--budget-ns", a->limits.evaluation_ns, "most nanoseconds of an evaluation");
  add_limit(*app, "--budget-bytes", a->limits.bytes, "most bytes of a material");
  add_limit(*app, "--budget-seconds", a->limits.make_seconds, "most seconds of a fit");
  add_limit(*app, "--max-error", a->limits.error, "most of the error that decides");
  CLI::Option* repeats =
      app->add_option("--repeats", a->repeats,
                      fmt::format("repeats of every time ({} with --quick)", kQuickRepeats))
          ->check(CLI::Range(1, 1000))
          ->capture_default_str();
  CLI::Option* folds =
      app->add_option(
             "--held-out", a->folds,
             fmt::format("folds of blocks of angles for held-out errors, 0 for none ({} with --quick)",
                         kQuickFolds))
          ->check(CLI::IsMember({0, 2, 3, 4, 5, 6, 7, 8, 9, 10}))
          ->capture_default_str();
  app->add_flag("--quick", a->quick, "a third of the points, fewer repeats");
  app->add_option("--device", a->device,
                  "Vulkan device: its index or a part of its name; the first where not given");
  app->add_option("--max-theta", a->fit.max_theta_deg,
                  "leave out directions further from the normal, in degrees")
      ->capture_default_str();
  app->add_option("--seed", a->fit.seed, "of samples, starts and folds")->capture_default_str();
  app->add_option("--cell", a->fit.cell, "where in its cell a stored value belongs")
      ->check(CLI::IsMember({"lower-edge", "centre"}))
      ->capture_default_str();
  app->add_flag("--lenient", a->fit.lenient, "count values that are not finite as unmeasured");
  add_common_options(*app, a->common, true);
  return {app, [a, repeats, folds](const std::string& command_line) {
            if (a->quick && repeats->count() == 0) a->repeats = kQuickRepeats;
            if (a->quick && folds->count() == 0) a->folds = kQuickFolds;
            return run(*a, command_line);
          }};
}

}  // namespace brdfit::cli
