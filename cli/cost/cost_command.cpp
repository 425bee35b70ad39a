// brdfit cost: what accuracy costs in time, for a table, a folder of them, or a light stack.
#include "cli/cost/cost_command.h"

#include <fmt/format.h>

#include <cstdio>

#include "cli/cost/cost_database.h"
#include "cli/cost/cost_page.h"
#include "cli/cost/stack_cost.h"
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
  BakeArguments bake;
  std::string error;  // empty: the usual one
  bool quick = false;
  int repeats = TableSweepOptions().repeats;
  int folds = TableSweepOptions().folds;
  Limits limits;
};

// What --quick makes of what was not given.
constexpr int kQuickRepeats = 3;
constexpr int kQuickFolds = 2;

bool is_stack(const std::string& input) {
  const std::filesystem::path ending = std::filesystem::path(input).extension();
  return ending == ".json" || ending == ".lp";
}

// The error that decides, one of these.
std::string leading_error(const Arguments& a, const char* usual, const std::vector<std::string>& keys) {
  if (a.error.empty()) return usual;
  if (std::ranges::find(keys, a.error) != keys.end()) return a.error;
  throw UsageError(fmt::format("--error is \"{}\", not one of {}", a.error, fmt::join(keys, ", ")));
}

TableCostRequest request_from(const Arguments& a, const std::string& command_line) {
  TableCostRequest request;
  request.common = a.common;
  request.sweep = {
      a.fit,   a.quick, a.repeats, a.folds, leading_error(a, kTableLeadingError, table_error_keys(a.folds)),
      a.device};
  request.limits = a.limits;
  request.output = a.output;
  request.command = command_line;
  return request;
}

// name: of the files. made: what a budget was spent on; empty: nothing.
template <class Cost>
void print_text(const Arguments& a, const std::string& name, const Cost& cost,
                const std::filesystem::path& made) {
  fmt::print("{}\n", fronts_text(cost.run));
  for (const Finding& finding : cost.findings) fmt::print("{}\n", finding.text);
  for (const std::string& note : cost.run.notes) fmt::print("note: {}\n", note);
  if (cost.budget) fmt::print("\n{}\n", budget_text(*cost.budget, a.limits, cost.run));
  // What is said goes to another stream.
  std::fflush(stdout);
  const CostPaths paths = cost_paths(a.output, name);
  say(a.common, fmt::format("wrote {}, .html and .json", paths.csv.string()));
  if (!made.empty()) say(a.common, "wrote " + made.string());
}

template <class Cost>
bool is_over_budget(const Cost& cost) {
  return cost.budget && !cost.budget->point;
}

int run_one(const Arguments& a, const TableCostRequest& request) {
  prepare_table_cost(request, a.input);
  const TableCost cost = measure_table_cost(request, a.input, run_time_evaluators(a.device));
  if (a.common.json) {
    fmt::print("{}\n", cost.json.dump(2));
  } else {
    print_text(a, base_name(a.input), cost, cost.material);
  }
  return is_over_budget(cost) ? kNotAllDone : kDone;
}

int run_stack(const Arguments& a, const std::string& command_line) {
  StackCostRequest request;
  request.sweep.bake = a.bake;
  request.sweep.bake.stack = a.input;
  request.sweep.bake.common = a.common;
  request.sweep.bake.seed = a.fit.seed;
  request.sweep.quick = a.quick;
  request.sweep.repeats = a.repeats;
  request.sweep.device = a.device;
  request.leading_error = leading_error(a, kStackLeadingError, stack_error_keys());
  request.limits = a.limits;
  request.output = a.output;
  request.command = command_line;
  const ThreadLimit threads(a.common.threads);
  prepare_stack_cost(request);
  const StackCost cost = measure_stack_cost(request);
  if (a.common.json) {
    fmt::print("{}\n", cost.json.dump(2));
  } else {
    print_text(a, request.name(), cost, cost.asset);
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
  const TableCostRequest request = request_from(a, command_line);
  const ThreadLimit threads(a.common.threads);
  if (std::filesystem::is_directory(a.input)) return Database(a, request).go();
  return run_one(a, request);
}

// What only one kind of input knows is no choice for the other.
void refuse(const std::vector<CLI::Option*>& options, const char* input) {
  for (const CLI::Option* option : options) {
    if (option->count() > 0) throw UsageError(fmt::format("{} is not for {}", option->get_name(), input));
  }
}

std::vector<CLI::Option*> add_stack_options(CLI::App& app, BakeArguments& bake) {
  return {app.add_option("--transfer", bake.transfer,
                         "light stacks: how pixels are encoded: linear, srgb or gamma-EXPONENT")
              ->take_last(),
          app.add_option("--base", bake.base,
                         "light stacks: base model around which choices lie; auto: the better one held out")
              ->check(CLI::IsMember({"auto", "lambert", "material"}))
              ->capture_default_str()
              ->take_last(),
          app.add_option("--model", bake.model, "light stacks: the model that is fitted to all texels")
              ->capture_default_str()
              ->take_last(),
          app.add_flag("--gains", bake.gains, "light stacks: estimate a gain of each light"),
          app.add_option("--folds", bake.folds,
                         "light stacks: folds of lights for held-out errors; 0: as bake has it")
              ->check(CLI::Range(0, 10000))
              ->capture_default_str()
              ->take_last(),
          app.add_option("--sample", bake.sample_texels, "light stacks: texels that are baked and compared")
              ->check(CLI::Range(64, 10000000))
              ->capture_default_str()
              ->take_last(),
          app.add_option("--memory", bake.memory_mib, "light stacks: MiB that pictures may take")
              ->check(CLI::Range(16, 1 << 20))
              ->capture_default_str()
              ->take_last()};
}

void add_limit(CLI::App& app, const char* name, std::optional<double>& limit, const char* help) {
  app.add_option_function<double>(
         name, [&limit](double value) { limit = value; }, help)
      ->check(CLI::NonNegativeNumber);
}

}  // namespace

Command add_cost_command(CLI::App& program) {
  auto a = std::make_shared<Arguments>();
  CLI::App* app =
      program.add_subcommand("cost", "accuracy against time: what each choice of a fit or of a bake buys");
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
      "again, it goes on where it stopped.\n"
      "Example: brdfit cost lion/dirs.lp --transfer linear --budget-bytes 4 -o out\n"
      "writes out/dirs.cost.csv, .html and .json, and the best bake of at most 4 bytes a texel.");
  app->add_option("input", a->input,
                  "MERL-format .binary file, a folder of them, or a light stack (olat.json, .lp)")
      ->required();
  app->add_option("-o,--output", a->output, "folder for the files")->capture_default_str()->take_last();
  app->add_option("--error", a->error,
                  fmt::format("the error that decides: slice_, table_ or held_out_ with a measure, or "
                              "sphere_delta_e (the usual: {}); of light stacks held_out_ or train_ with a "
                              "measure (the usual: {})",
                              kTableLeadingError, kStackLeadingError));
  add_limit(*app, "--budget-ns", a->limits.evaluation_ns, "most nanoseconds of an evaluation");
  add_limit(*app, "--budget-bytes", a->limits.bytes, "most bytes of a material");
  add_limit(*app, "--budget-seconds", a->limits.make_seconds, "most seconds of a fit");
  add_limit(*app, "--max-error", a->limits.error, "most of the error that decides");
  CLI::Option* repeats =
      app->add_option("--repeats", a->repeats,
                      fmt::format("repeats of every time ({} with --quick; of light stacks {}, and 1 with "
                                  "--quick)",
                                  kQuickRepeats, StackSweepOptions().repeats))
          ->check(CLI::Range(1, 1000))
          ->capture_default_str();
  CLI::Option* folds =
      app->add_option(
             "--held-out", a->folds,
             fmt::format(
                 "tables: folds of blocks of angles for held-out errors, 0 for none ({} with --quick)",
                 kQuickFolds))
          ->check(CLI::IsMember({0, 2, 3, 4, 5, 6, 7, 8, 9, 10}))
          ->capture_default_str();
  app->add_flag("--quick", a->quick, "a third of the points, fewer repeats");
  app->add_option("--device", a->device,
                  "Vulkan device: its index or a part of its name; the first where not given");
  std::vector<CLI::Option*> of_tables = {
      folds,
      app->add_option("--max-theta", a->fit.max_theta_deg,
                      "tables: leave out directions further from the normal, in degrees")
          ->capture_default_str(),
      app->add_option("--cell", a->fit.cell, "tables: where in its cell a stored value belongs")
          ->check(CLI::IsMember({"lower-edge", "centre"}))
          ->capture_default_str(),
      app->add_flag("--lenient", a->fit.lenient, "tables: count values that are not finite as unmeasured")};
  std::vector<CLI::Option*> of_stacks = add_stack_options(*app, a->bake);
  app->add_option("--seed", a->fit.seed, "of samples, starts and folds")->capture_default_str();
  add_common_options(*app, a->common, true);
  return {app, [a, repeats, folds, of_tables, of_stacks](const std::string& command_line) {
            if (is_stack(a->input)) {
              refuse(of_tables, "light stacks");
              if (repeats->count() == 0) a->repeats = StackSweepOptions().repeats;
              return run_stack(*a, command_line);
            }
            refuse(of_stacks, "tables");
            if (a->quick && repeats->count() == 0) a->repeats = kQuickRepeats;
            if (a->quick && folds->count() == 0) a->folds = kQuickFolds;
            return run(*a, command_line);
          }};
}

}  // namespace brdfit::cli
