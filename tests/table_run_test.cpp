// Runs over a database from outside: resumed, killed, split and merged, they end as one that was left alone.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/cli_fixture.h"

namespace brdfit {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;
using tests::ProgramResult;
using Contents = std::map<std::string, std::string>;

// What changes from run to run is left out.
std::string steady(const std::filesystem::path& file) {
  const std::string text = tests::read_text(file);
  if (file.extension() != ".json") return text;
  ordered_json json = ordered_json::parse(text);
  json.erase("timings_seconds");
  if (json.contains("fit")) json["fit"].erase("timings_seconds");
  return json.dump();
}

class TableRun : public tests::CliFixture {
 protected:
  // Three tables, of materials that no two models fit alike.
  void make_tables() {
    make_table("in/amber", Model::kLambertGgx, 1);
    make_table("in/blue-fabric", Model::kCallisto, 2);
    make_table("in/clay", Model::kBurley, 3);
  }
  void SetUp() override { std::filesystem::create_directories(path("in")); }

  std::string table(const std::string& out, const std::string& more = "") const {
    return "table " + quoted("in") + " --samples 800 --starts 2 -o " + quoted(out) + " " + more;
  }

  Contents contents(const std::string& folder) const {
    Contents result;
    for (const auto& entry : std::filesystem::directory_iterator(path(folder))) {
      const std::string name = entry.path().filename().string();
      if (name != "timings.csv" && !name.starts_with(".")) result[name] = steady(entry.path());
    }
    return result;
  }

  // As below, in a folder whose name begins like that, until a run was not done before the signal came (as on
  // a busy machine it can be). Returns the folder.
  std::string broken_off(const std::string& out, int signal, int* status) {
    std::string folder;
    for (int attempt = 0; attempt < 20; ++attempt) {
      folder = out + "-" + std::to_string(attempt);
      *status = signalled(folder, signal);
      if (!std::filesystem::exists(path(folder + "/table.json"))) break;
    }
    return folder;
  }

  // Begins a run, sends it a signal once there are so many results, and returns its exit status as wait()
  // says.
  int signalled(const std::string& out, int signal, std::size_t results = 2, const char* threads = "1") {
    const pid_t child = fork();
    if (child == 0) {
      const int nowhere = open("/dev/null", O_WRONLY);
      dup2(nowhere, STDOUT_FILENO);
      dup2(nowhere, STDERR_FILENO);
      const std::string in = path("in").string();
      const std::string folder = path(out).string();
      execl(BRDFIT_PROGRAM, "brdfit", "table", in.c_str(), "--samples", "800", "--starts", "2", "--threads",
            threads, "-o", folder.c_str(), nullptr);
      _exit(127);
    }
    int status = 0;
    while (results_in(out) < results && waitpid(child, &status, WNOHANG) == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    kill(child, signal);
    waitpid(child, &status, 0);
    return status;
  }

  std::size_t results_in(const std::string& folder) const {
    return std::filesystem::exists(path(folder)) ? times(folder).size() : 0;
  }

  std::map<std::string, std::filesystem::file_time_type> times(const std::string& folder) const {
    std::map<std::string, std::filesystem::file_time_type> result;
    for (const auto& entry : std::filesystem::directory_iterator(path(folder))) {
      if (entry.path().extension() == ".json") result[entry.path().filename()] = entry.last_write_time();
    }
    return result;
  }
};

std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells(1);
    for (const char c : line) {
      if (c == ',') {
        cells.emplace_back();
      } else {
        cells.back() += c;
      }
    }
    rows.push_back(std::move(cells));
  }
  return rows;
}

TEST_F(TableRun, WritesAResultForEachAndTablesThatAgree) {
  make_tables();
  const ProgramResult run_result = run(table("out", "--published"));
  ASSERT_EQ(run_result.exit_code, 0) << run_result.err;
  EXPECT_THAT(run_result.err, HasSubstr("[3/3]"));
  const Contents files = contents("out");
  // Three materials by three models, two published ones of the name, four tables.
  EXPECT_EQ(files.size(), 9U + 2U + 4U);
  const auto json = ordered_json::parse(files.at("table.json"));
  const auto rows = parse_csv(files.at("table.csv"));
  std::size_t results = 0;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    ASSERT_EQ(rows[k].size(), rows[0].size());
    const bool is_result = rows[k][0] == "result";
    const auto& entry = is_result ? json["rows"][results++] : json["summary"][rows[k][2]][rows[k][0]];
    for (std::size_t c = 3; c + 1 < rows[0].size(); ++c) {
      if (rows[k][c].empty()) continue;
      EXPECT_EQ(std::stod(rows[k][c]), entry[rows[0][c]].get<double>()) << rows[0][c];
    }
  }
  EXPECT_EQ(results, 11U);
  // The measures are those of the result files.
  const auto material = ordered_json::parse(files.at("clay.burley.json"));
  for (const auto& row : json["rows"]) {
    if (row["file"] != "clay.burley.json") continue;
    EXPECT_EQ(row["table_srgb"], material["fit"]["table"]["srgb"]);
    EXPECT_EQ(row["sphere_delta_e"], material["fit"]["sphere_delta_e"]);
  }
  // Every material is won by someone, and its own model wins it.
  for (const auto& [measure, wins] : json["summary"]["burley"]["wins"].items()) {
    int all = 0;
    for (const auto& [candidate, summary] : json["summary"].items())
      all += summary["wins"][measure].get<int>();
    EXPECT_GE(all, 3) << measure;
  }
  EXPECT_GE(json["summary"]["callisto"]["wins"]["table_log_ratio_pct"], 1);
  EXPECT_THAT(files.at("table.md"), HasSubstr("| blue-fabric | callisto (published) | 0 |"));
  EXPECT_THAT(files.at("table.txt"), HasSubstr("mean of 3"));
}

TEST_F(TableRun, ThreadsAndFoldersDoNotChangeAByte) {
  make_tables();
  ASSERT_EQ(run(table("one", "--threads 1 -q")).exit_code, 0);
  ASSERT_EQ(run(table("two", "--threads 2 -q")).exit_code, 0);
  EXPECT_EQ(contents("one"), contents("two"));
  // Where the loss is chosen too, by rendered spheres.
  const std::string loss = "-q --model burley --loss auto --threads ";
  ASSERT_EQ(run(table("loss-one", loss + "1")).exit_code, 0);
  ASSERT_EQ(run(table("loss-two", loss + "2")).exit_code, 0);
  EXPECT_EQ(contents("loss-one"), contents("loss-two"));
}

TEST_F(TableRun, AFinishedResultIsNotFittedAgain) {
  make_tables();
  ASSERT_EQ(run(table("out", "-q --model burley")).exit_code, 0);
  const auto before = times("out");
  const Contents bytes = contents("out");
  const ProgramResult again = run(table("out", "--model burley"));
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.err, HasSubstr("finished before"));
  auto after = times("out");
  EXPECT_EQ(contents("out"), bytes);
  // The table is made anew from the results.
  after["table.json"] = before.at("table.json");
  EXPECT_EQ(after, before);
  // With one more model, only that is fitted.
  ASSERT_EQ(run(table("out", "-q --model burley,lambert-ggx")).exit_code, 0);
  EXPECT_EQ(times("out").at("clay.burley.json"), before.at("clay.burley.json"));
  EXPECT_EQ(contents("out").size(), 6U + 4U);
}

TEST_F(TableRun, HeldOutErrorsAreInEveryTableWhereAskedFor) {
  make_tables();
  ASSERT_EQ(run(table("plain", "-q --model lambert-ggx")).exit_code, 0);
  ASSERT_EQ(run(table("out", "-q --model lambert-ggx --held-out=2")).exit_code, 0);
  const auto json = ordered_json::parse(tests::read_text(path("out/table.json")));
  const auto result = ordered_json::parse(tests::read_text(path("out/clay.lambert-ggx.json")));
  const auto& held_out = result["fit"]["held_out"]["table"]["log_ratio_pct"];
  EXPECT_EQ(json["rows"][2]["held_out_log_ratio_pct"], held_out["mean"]);
  EXPECT_EQ(json["rows"][2]["held_out_deviation_pct"], held_out["deviation"]);
  for (const char* file : {"out/table.txt", "out/table.md"}) {
    EXPECT_THAT(tests::read_text(path(file)), HasSubstr("blocks of angles that nothing saw"));
  }
  const auto rows = parse_csv(tests::read_text(path("out/table.csv")));
  EXPECT_EQ(rows[0].back(), "held_out_log_ratio_pct");
  EXPECT_EQ(std::stod(rows[3].back()), held_out["mean"].get<double>());
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  EXPECT_THAT(tests::read_text(path("plain/table.txt")), testing::Not(HasSubstr("nothing saw")));
  // The line that makes a result alone.
  EXPECT_THAT(result["fit"]["command"].get<std::string>(), HasSubstr("--held-out=2"));
}

TEST_F(TableRun, ResultsOfOtherOptionsOrInputsAreKeptUnlessForced) {
  make_tables();
  ASSERT_EQ(run(table("out", "-q --model lambert-ggx")).exit_code, 0);
  const Contents bytes = contents("out");
  const ProgramResult other = run(table("out", "-q --model lambert-ggx --seed 2"));
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("--force"));
  EXPECT_EQ(contents("out"), bytes);
  // Neither the choice of a size nor held-out errors are in what is there.
  for (const char* more : {"--held-out", "--held-out=3", "--samples auto"}) {
    EXPECT_EQ(run("table " + quoted("in") + " --starts 2 -q --model lambert-ggx -o " + quoted("out") +
                  (std::string(more).starts_with("--s") ? " " : " --samples 800 ") + more)
                  .exit_code,
              2)
        << more;
  }
  make_table("in/clay", Model::kBurley, 4);
  const ProgramResult changed = run(table("out", "-q --model lambert-ggx"));
  EXPECT_EQ(changed.exit_code, 4);
  EXPECT_THAT(changed.err, HasSubstr("clay.binary"));
  EXPECT_EQ(contents("out").at("clay.lambert-ggx.json"), bytes.at("clay.lambert-ggx.json"));
  EXPECT_EQ(run(table("out", "-q --model lambert-ggx --force")).exit_code, 0);
  EXPECT_NE(contents("out").at("clay.lambert-ggx.json"), bytes.at("clay.lambert-ggx.json"));
}

TEST_F(TableRun, KilledOrInterruptedItGoesOnToTheSameBytes) {
  make_tables();
  ASSERT_EQ(run(table("whole", "-q")).exit_code, 0);
  const Contents whole = contents("whole");
  for (const int signal : {SIGKILL, SIGINT}) {
    int status = 0;
    const std::string out = broken_off("out" + std::to_string(signal), signal, &status);
    ASSERT_FALSE(std::filesystem::exists(path(out + "/table.json"))) << "ended before it was told to";
    if (signal == SIGINT) {
      ASSERT_TRUE(WIFEXITED(status));
      EXPECT_EQ(WEXITSTATUS(status), 1);
    }
    // What is there is complete.
    const Contents half = contents(out);
    const auto before = times(out);
    EXPECT_FALSE(half.empty());
    EXPECT_LT(half.size(), 9U);
    for (const auto& [name, text] : half) EXPECT_EQ(text, whole.at(name)) << name;
    ASSERT_EQ(run(table(out, "-q")).exit_code, 0);
    EXPECT_EQ(contents(out), whole);
    for (const auto& [name, time] : before) EXPECT_EQ(times(out).at(name), time) << name;
  }
}

TEST_F(TableRun, KilledAgainAndAgainItMakesEachResultOnce) {
  make_tables();
  ASSERT_EQ(run(table("whole", "-q")).exit_code, 0);
  std::map<std::string, std::filesystem::file_time_type> first_seen;
  int kills = 0;
  while (!std::filesystem::exists(path("out/table.json")) && kills < 50) {
    if (WIFSIGNALED(signalled("out", SIGKILL, results_in("out") + 1, "2"))) ++kills;
    for (const auto& [name, time] : times("out")) {
      if (name == "table.json") continue;
      EXPECT_EQ(first_seen.try_emplace(name, time).first->second, time) << name << " after " << kills;
    }
  }
  EXPECT_GE(kills, 2);
  ASSERT_EQ(run(table("out", "-q")).exit_code, 0);
  for (const auto& [name, time] : first_seen) EXPECT_EQ(times("out").at(name), time) << name;
  EXPECT_EQ(contents("out"), contents("whole"));
}

TEST_F(TableRun, OverwritesNoFilesThatNoRunWrote) {
  make_table("in/amber", Model::kLambertGgx, 1);
  std::filesystem::create_directories(path("out"));
  write_bytes("out/table.csv", "mine");
  EXPECT_EQ(run(table("out", "-q --model lambert-ggx")).exit_code, 2);
  EXPECT_EQ(tests::read_text(path("out/table.csv")), "mine");
  EXPECT_EQ(files_in("out"), 1U);
  // Killed after the first of the tables: it may go on.
  ASSERT_EQ(run(table("other", "-q --model lambert-ggx")).exit_code, 0);
  const Contents whole = contents("other");
  for (const char* name : {"other/table.csv", "other/table.txt", "other/table.md", "other/timings.csv"}) {
    std::filesystem::remove(path(name));
  }
  EXPECT_EQ(run(table("other", "-q --model lambert-ggx")).exit_code, 0);
  EXPECT_EQ(contents("other"), whole);
}

TEST_F(TableRun, TakesAwayWhatAKilledRunLeft) {
  make_table("in/amber", Model::kLambertGgx, 1);
  std::filesystem::create_directories(path("out"));
  write_bytes("out/.brdfit-1-0.tmp", "half of a file");
  write_bytes("out/.brdfit-2-0.tmp", "perhaps of a run that is at work");
  std::filesystem::last_write_time(path("out/.brdfit-1-0.tmp"),
                                   std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
  ASSERT_EQ(run(table("out", "-q --model lambert-ggx")).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(path("out/.brdfit-1-0.tmp")));
  EXPECT_TRUE(std::filesystem::exists(path("out/.brdfit-2-0.tmp")));
}

TEST_F(TableRun, ABadFileIsToldAndTheRestIsDone) {
  make_tables();
  write_bytes("in/bad.binary", "not a table");
  const ProgramResult result = run(table("out", "-q --model lambert-ggx"));
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.err, HasSubstr("bad.binary"));
  const auto json = ordered_json::parse(contents("out").at("table.json"));
  EXPECT_EQ(json["rows"].size(), 3U);
  EXPECT_EQ(json["failures"].size(), 1U);
  EXPECT_TRUE(json["failures"].contains("bad.binary"));
}

TEST_F(TableRun, ShardsMergeIntoTheWhole) {
  make_tables();
  write_bytes("in/bad.binary", "not a table");
  const std::string options = "-q --published --model burley,lambert-ggx ";
  ASSERT_EQ(run(table("whole", options)).exit_code, 4);
  // The fifth has nothing to do.
  for (const std::string k : {"1", "2", "3", "4", "5"}) {
    run(table("part" + k, options + "--shard " + k + "/5"));
    ASSERT_TRUE(std::filesystem::exists(path("part" + k + "/table.json"))) << k;
  }
  const std::string four =
      quoted("part1") + " " + quoted("part2") + " " + quoted("part3") + " " + quoted("part4") + " ";
  const ProgramResult missing = run("table --merge " + four + "-o " + quoted("merged"));
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("shard 5 of 5"));
  EXPECT_EQ(files_in("merged"), 0U);
  const ProgramResult merged =
      run("table --merge " + quoted("part5") + " " + four + "-q -o " + quoted("merged"));
  EXPECT_EQ(merged.exit_code, 4) << merged.err;
  EXPECT_EQ(contents("merged"), contents("whole"));
}

TEST_F(TableRun, AReportIsMadeOfItsFolder) {
  make_table("in/amber", Model::kLambertGgx, 1);
  ASSERT_EQ(run(table("out", "-q --published --model lambert-ggx")).exit_code, 0);
  const ProgramResult report = run("report -q " + quoted("out"));
  EXPECT_EQ(report.exit_code, 0) << report.err;
  EXPECT_TRUE(std::filesystem::exists(path("out/report.html")));
}

TEST_F(TableRun, WrongUsageExitsWith2) {
  make_table("in/amber", Model::kLambertGgx, 1);
  for (const std::string shard : {"0/2", "3/2", "1", "1/", "/2", "a/b", "1/2x", "-1/2"}) {
    EXPECT_EQ(run(table("out", "-q --shard=" + shard)).exit_code, 2) << shard;
  }
  for (const char* alone : {"--shard 1/2", "--merge", "--timings", "--published"}) {
    EXPECT_EQ(run("table -q " + quoted("in") + " " + alone).exit_code, 2) << alone;
  }
  std::filesystem::create_directories(path("other"));
  make_table("other/amber", Model::kLambertGgx, 1);
  EXPECT_EQ(run(table("out", "-q " + quoted("other"))).exit_code, 2);
  EXPECT_EQ(files_in("out"), 0U);
}

}  // namespace
}  // namespace brdfit
