// The course of a run over a database.
#include "cli/database_run.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <optional>

#include "cli/fit_request.h"
#include "cli/load_floor.h"
#include "cli/progress.h"
#include "cli/published.h"
#include "cli/result_json.h"
#include "cli/result_table.h"
#include "cli/result_text.h"
#include "cli/run_scaling.h"
#include "cli/sphere_judge.h"
#include "cli/table_input.h"
#include "cli/table_output.h"
#include "cli/threads.h"
#include "cli/version.h"
#include "io/material_json.h"
#include "io/sha256.h"

namespace brdfit::cli {
namespace {

using io::Json;
namespace fs = std::filesystem;

// A result that a run makes, and how it is known when it is there.
struct Wanted {
  fs::path file;
  std::string request;
  const fit::FitOptions* options = nullptr;  // of a fit
  std::optional<Material> published;         // or a material to compare
};

// One table and its results.
struct Job {
  std::string input;
  std::vector<Wanted> results;
};

enum class Found { kAbsent, kOther, kFinished };

const Json& evidence_of(const Json& document) {
  return document.is_object() && document.contains("fit") ? document["fit"] : document;
}

bool says(const Json& json, const char* key, const std::string& text) {
  return json.is_object() && json.contains(key) && json[key] == text;
}

// Whether a result is there that was asked for like this one; sha256 (of the input) is not held against it if
// empty.
Found look_for(const Wanted& wanted, const std::string& sha256) {
  if (!fs::exists(wanted.file)) return Found::kAbsent;
  try {
    const Json document = io::read_json(wanted.file);
    const Json& evidence = evidence_of(document);
    if (!says(evidence, "version", kVersion) || !says(evidence, "request", wanted.request)) {
      return Found::kOther;
    }
    const bool same_input =
        sha256.empty() || (evidence.contains("input") && says(evidence["input"], "sha256", sha256));
    return same_input ? Found::kFinished : Found::kOther;
  } catch (const io::IoError&) {
    return Found::kOther;
  }
}

// What a killed run was writing. Young ones may be another run's, which needs a moment for each.
void remove_old_temporaries(const fs::path& folder) {
  constexpr auto kOld = std::chrono::minutes(10);
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (!name.starts_with(".brdfit-") || !name.ends_with(".tmp")) continue;
    std::error_code ignored;
    if (fs::file_time_type::clock::now() - fs::last_write_time(at->path(), ignored) > kOld) {
      fs::remove(at->path(), ignored);
    }
  }
}

class Database {
 public:
  explicit Database(const DatabaseRun& run)
      : run_(run), options_(make_fit_options(run.fit)), workers_(worker_count()), jobs_(make_jobs()) {
    require_own_tables(run.output, run.common.force);
    prepare_output(run.output / "table.json", true);
    refuse_other_results();
    remove_old_temporaries(run.output);
  }

  int go() {
    {
      Progress progress(jobs_.size(), run_.common.quiet);
      run_jobs(jobs_.size(), workers_, [&](std::size_t k) { do_job(jobs_[k], progress); });
    }
    if (interrupted()) {
      throw std::runtime_error(
          fmt::format("interrupted; the results in {} are complete, and the same command goes on from there",
                      run_.output.string()));
    }
    const std::size_t peak_bytes = peak_memory_bytes();
    read_rows();
    write_tables(run_.output, table_, run_.shard);
    print();
    if (run_.timings) print_timings(peak_bytes);
    if (table_.failures.empty()) return kDone;
    return table_.failures.size() == jobs_.size() ? kUnusableInput : kNotAllDone;
  }

 private:
  int worker_count() const {
    return run_.common.threads > 0 ? run_.common.threads : tbb::info::default_concurrency();
  }

  std::vector<Job> make_jobs() const {
    std::vector<std::string> files = run_.files;
    std::ranges::stable_sort(files, {}, base_name);
    const auto twice = std::ranges::adjacent_find(files, {}, base_name);
    if (twice != files.end()) {
      throw UsageError(fmt::format("{} and {} have one name, and would write the same results", *twice,
                                   *std::next(twice)));
    }
    std::vector<Job> jobs;
    for (const std::string& file : files_of_shard(files, run_.shard)) {
      jobs.push_back({file, {}});
      const std::string name = base_name(file);
      for (const fit::FitOptions& options : options_) {
        jobs.back().results.push_back({run_.output / fmt::format("{}.{}.json", name, name_of(options.model)),
                                       request_of(options, run_.fit),
                                       &options,
                                       {}});
      }
      if (run_.published) add_published(name, jobs.back());
    }
    return jobs;
  }

  // Those of the models that are fitted.
  void add_published(const std::string& name, Job& job) const {
    for (const Material& material : published_materials(name)) {
      if (std::ranges::find(options_, material.model(), &fit::FitOptions::model) == options_.end()) continue;
      const Json asked = {{"material", io::material_to_json(material)},
                          {"max_theta_deg", run_.fit.max_theta_deg},
                          {"cell", run_.fit.cell},
                          {"lenient", run_.fit.lenient}};
      job.results.push_back(
          {run_.output / fmt::format("{}.{}.published.json", name, name_of(material.model())),
           io::sha256_of_text(asked.dump()), nullptr, material});
    }
  }

  // Before the work begins, so that nobody waits for it in vain. Inputs are looked at later.
  void refuse_other_results() const {
    if (run_.common.force) return;
    for (const Job& job : jobs_) {
      for (const Wanted& wanted : job.results) {
        if (look_for(wanted, "") != Found::kOther) continue;
        throw UsageError(wanted.file.string() +
                         " exists and was made with other options or by another version; give --force to "
                         "overwrite such results");
      }
    }
  }

  void do_job(const Job& job, Progress& progress) {
    if (interrupted()) return;
    const std::string name = base_name(job.input);
    try {
      progress.step(fmt::format("{}: {}", name, make_results(job, progress)));
    } catch (const io::IoError& error) {
      if (error.side() == io::IoError::Side::kOutput) throw;
      fail(job, error.what(), progress);
    } catch (const std::invalid_argument& error) {
      fail(job, fmt::format("{}: {}", job.input, error.what()), progress);
    }
  }

  void fail(const Job& job, const std::string& why, Progress& progress) {
    progress.error("brdfit table: " + why);
    progress.step(base_name(job.input) + ": failed");
    const std::lock_guard lock(mutex_);
    table_.failures[fs::path(job.input).filename().string()] = why;
  }

  std::vector<const Wanted*> missing(const Job& job, const std::string& sha256) const {
    std::vector<const Wanted*> result;
    for (const Wanted& wanted : job.results) {
      const Found found = look_for(wanted, sha256);
      if (found == Found::kFinished) continue;
      if (found == Found::kOther && !run_.common.force) {
        throw io::IoError(io::IoError::Side::kInput, job.input,
                          "is not what " + wanted.file.string() + " was made from",
                          "the same table as before", "give --force to overwrite the result");
      }
      result.push_back(&wanted);
    }
    return result;
  }

  // Makes what is not there yet; says in words what was done.
  std::string make_results(const Job& job, Progress& progress) {
    const std::string sha256 = io::sha256_of_file(job.input);
    const std::vector<const Wanted*> todo = missing(job, sha256);
    if (todo.empty()) return "finished before";
    CommonOptions silent = run_.common;
    silent.quiet = true;
    const LoadedTable loaded = load_table(job.input, make_read_options(run_.fit), silent);
    if (loaded.report.non_finite_values > 0) {
      progress.note(fmt::format("{}: {} values are not finite and count as unmeasured", job.input,
                                loaded.report.non_finite_values));
    }
    const TableJudge judge(loaded.table, todo.size());
    const Provenance provenance = provenance_of(job, sha256, loaded);
    std::size_t made = 0;
    for (const Wanted* wanted : todo) {
      if (interrupted()) break;
      make_result(*wanted, loaded.table, judge, provenance);
      ++made;
    }
    return made == job.results.size() ? fmt::format("{} done", made)
                                      : fmt::format("{} of {} done here", made, job.results.size());
  }

  Provenance provenance_of(const Job& job, const std::string& sha256, const LoadedTable& loaded) const {
    const std::string name = fs::path(job.input).filename().string();
    return {name, sha256, kVersion, run_.fit.lenient, loaded.report.non_finite_values, run_.fit.cell,
            path_from(run_.output, job.input),
            // The same in every shard and on every machine.
            fmt::format("brdfit fit {}{}", quoted_word(name), run_.fit_options), ""};
  }

  void make_result(const Wanted& wanted, const MeasuredTable& table, const TableJudge& judge,
                   Provenance provenance) const {
    provenance.request = wanted.request;
    if (wanted.published) {
      io::write_json(wanted.file, compare_published(*wanted.published, table, judge, provenance));
      return;
    }
    const JudgedFit judged = fit_and_judge(table, *wanted.options, judge);
    io::write_material(wanted.file, judged.fit.material, evidence_to_json(judged, provenance));
  }

  Json compare_published(const Material& material, const MeasuredTable& table, const TableJudge& judge,
                         const Provenance& provenance) const {
    const Stopwatch watch;
    const fit::Evaluation evaluation = fit::evaluate(material, table, run_.fit.max_theta_deg);
    const JudgedSphere sphere = judge(material);
    Json json = {{"brdfit_published", 1},
                 {"version", provenance.version},
                 {"request", provenance.request},
                 {"input", {{"name", provenance.input}, {"sha256", provenance.sha256}}},
                 {"material", io::material_to_json(material)}};
    json.update(evaluation_to_json(evaluation, sphere.delta_e));
    json["timings_seconds"] = {{"compare", watch.seconds()}};
    return json;
  }

  // From the files, so that a run that was resumed tells what an uninterrupted one does.
  void read_rows() {
    for (const Job& job : jobs_) {
      if (table_.failures.contains(fs::path(job.input).filename().string())) continue;
      for (const Wanted& wanted : job.results) {
        table_.rows.push_back(row_of_result(io::read_json(wanted.file), wanted.file));
      }
    }
    sort_rows(table_.rows);
  }

  void print() const {
    if (run_.common.json) {
      fmt::print("{}\n", table_json(table_, run_.shard).dump(2));
      return;
    }
    fmt::print("{}\n{}", table_text(table_), timings_text(table_));
    say(run_.common, "wrote " + (run_.output / "table.txt").string() + " and .csv, .json, .md");
  }

  // To stderr, as standard output is the result.
  void print_timings(std::size_t peak_bytes) const {
    std::fflush(stdout);
    std::vector<const Job*> good;
    for (const Job& job : jobs_) {
      if (!table_.failures.contains(fs::path(job.input).filename().string())) good.push_back(&job);
    }
    if (good.empty()) return;
    // By all workers at once, as the fits were.
    std::vector<double> floors(static_cast<std::size_t>(5 * workers_));
    run_jobs(floors.size(), workers_,
             [&](std::size_t k) { floors[k] = load_floor_seconds(good[k % good.size()]->input); });
    std::ranges::sort(floors);
    fmt::print(stderr, "{}", floors_text(table_, floors[floors.size() / 2]));
    const int used = std::min(workers_, static_cast<int>(jobs_.size()));
    fmt::print(stderr, "peak memory {:.0f} MB, {:.0f} MB per worker\n", static_cast<double>(peak_bytes) / 1e6,
               static_cast<double>(peak_bytes) / 1e6 / used);
    if (workers_ > 1) print_scaling(good);
  }

  // Fits some of the tables again, and writes nothing.
  void print_scaling(const std::vector<const Job*>& good) const {
    // As many as divide evenly among the workers, so that none waits at the end.
    const std::size_t whole = good.size() / static_cast<std::size_t>(workers_);
    if (whole == 0) {
      fmt::print(stderr, "scaling: not measured, as there are fewer tables than workers\n");
      return;
    }
    const std::size_t count = std::min<std::size_t>(whole, 3) * static_cast<std::size_t>(workers_);
    const Scaling scaling = measure_scaling(count, workers_, 2, [&](std::size_t k) {
      const LoadedTable loaded = load_table(good[k]->input, make_read_options(run_.fit), run_.common);
      const TableJudge judge(loaded.table, options_.size());
      for (const fit::FitOptions& options : options_) {
        if (!interrupted()) fit_and_judge(loaded.table, options, judge);
      }
    });
    fmt::print(stderr,
               "scaling: {} workers do {} tables {:.2f}x as fast as one, and a plain loop {:.2f}x: {:.0f}%\n",
               workers_, count, scaling.jobs, scaling.loop, 100.0 * scaling.jobs / scaling.loop);
  }

  const DatabaseRun& run_;
  std::vector<fit::FitOptions> options_;
  int workers_;
  std::vector<Job> jobs_;
  std::mutex mutex_;
  ResultTable table_;
};

}  // namespace

int run_database(const DatabaseRun& run) {
  return Database(run).go();
}

}  // namespace brdfit::cli
