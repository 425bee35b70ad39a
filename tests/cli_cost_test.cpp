// brdfit cost from outside: files, sentences against their own CSV, budgets that are kept, resumed folders.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "cli/cost/cost_files.h"
#include "cli/cost/error_keys.h"
#include "cli/cost/findings.h"
#include "cli/cost/table_sweep.h"
#include "fit/metrics.h"
#include "io/material_json.h"
#include "io/merl.h"
#include "tests/cli_fixture.h"
#include "tests/cost_csv.h"
#include "tests/schema_tools.h"

namespace brdfit::cli {
namespace {

using io::Json;
using testing::HasSubstr;
using tests::JsonSchema;
using tests::ProgramResult;

JsonSchema schema(const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path(BRDFIT_SOURCE_DIR) / "docs/schema";
  std::map<std::string, JsonSchema> others;
  for (const char* other : {"material.schema.json", "table.schema.json", "cost.schema.json"}) {
    if (name != other) others.emplace(other, JsonSchema(io::read_json(folder / other), others));
  }
  return JsonSchema(io::read_json(folder / name), others);
}

RepeatedTime time_in(const Row& row, const std::string& key) {
  if (row.at(key).empty()) return {};
  return {number(row, key), number(row, key + "_low"), number(row, key + "_high"),
          std::stoi(row.at(key + "_repeats")), number(row, key + "_units")};
}

// The run as far as its CSV tells it.
CostRun run_of(const std::vector<Row>& rows) {
  CostRun run;
  run.kind = rows.front().at("kind");
  run.input = rows.front().at("input");
  run.leading_error = rows.front().at("leading_error");
  for (const Row& row : rows) {
    CostPoint& point = run.points.emplace_back();
    point.name = row.at("name");
    point.sweep = row.at("sweep");
    for (const char* key :
         {"model", "tier", "effects", "on", "phi-d", "samples", "loss", "starts", "scalar", "device"}) {
      if (!row.at(key).empty()) point.settings.emplace_back(key, row.at(key));
    }
    for (const std::string& key : table_error_keys(2)) {
      if (!row.at(key).empty()) point.errors.emplace_back(key, number(row, key));
    }
    point.make_seconds = time_in(row, "make_seconds");
    point.evaluation_ns = time_in(row, "evaluation_ns");
    point.on_make_front = row.at("on_make_front") == "1";
    point.on_run_front = row.at("on_run_front") == "1";
  }
  return run;
}

// The steady part of points: what is no time, no memory and no front; without errors held out, which not
// every run here asks for.
Json steady(const Json& points) {
  Json result = points;
  for (Json& point : result) {
    for (const char* key : {"make_seconds", "evaluation_ns", "peak_mib", "on_make_front", "on_run_front"}) {
      point.erase(key);
    }
    for (const std::string& key : table_error_keys(2)) {
      if (key.starts_with("held_out_")) point["errors"].erase(key);
    }
  }
  return result;
}

// One table, swept once for all tests that only look at the result.
class CliCost : public tests::CliFixture {
 protected:
  static void SetUpTestSuite() {
    shared_ = new CliCost::Shared;
    shared_->make_table("amber", Model::kCallisto, 2);
    shared_->result =
        shared_->run("cost --json --budget-bytes 40 --threads 1 --quick --repeats 2 --held-out 2 -q " +
                     shared_->quoted("amber.binary") + " -o " + shared_->quoted("out"));
  }
  static void TearDownTestSuite() { delete shared_; }

  static std::filesystem::path made(const std::string& name) { return shared_->path("out/" + name); }
  static Json document() { return io::read_json(made("amber.cost.json")); }
  static std::vector<Row> rows() { return read_csv(made("amber.cost.csv")); }

  class Shared : public tests::CliFixture {
   public:
    void TestBody() override {}
    using CliFixture::make_table;
    using CliFixture::path;
    using CliFixture::quoted;
    using CliFixture::run;
    ProgramResult result;
  };
  static Shared* shared_;
};

CliCost::Shared* CliCost::shared_ = nullptr;

TEST_F(CliCost, WhatIsPrintedIsTheFileAndTheFileIsValidWithNoMemberUndescribed) {
  ASSERT_EQ(shared_->result.exit_code, 0) << shared_->result.err;
  Json json = document();
  EXPECT_EQ(Json::parse(shared_->result.out), json);
  const JsonSchema described = schema("cost.schema.json");
  EXPECT_EQ(described.complaint(json), "");
  // The others are alike.
  for (const char* list : {"points", "sentences"}) json[list] = Json::array({json[list][0]});
  tests::expect_all_numbers_are_bounded(described, json);
  for (const char* place :
       {"/points/0", "/sentences/0", "/budget", "/budget/trials/0", "/reference_seconds", "/input", ""}) {
    Json wrong = json;
    wrong[Json::json_pointer(place)]["extra"] = 1;
    EXPECT_NE(described.complaint(wrong), "") << place;
  }
}

TEST_F(CliCost, TheCsvHoldsAllThatTheSentencesSay) {
  const Json json = document();
  std::vector<std::string> written;
  for (const Json& sentence : json["sentences"]) written.push_back(sentence["text"]);
  EXPECT_GT(written.size(), 10U);
  EXPECT_EQ(sentences_of(findings_of(run_of(rows()))), written);
}

TEST_F(CliCost, EveryComparisonFollowsFromTheCsv) {
  EXPECT_GE(expect_comparisons_follow(rows(), document()), 6);
}

TEST_F(CliCost, PlateausFollowFromTheCsv) {
  const std::regex plateau(R"(After ([0-9,]+) (samples|starts) nothing improves by more than 1%.*)");
  const std::vector<Row> table = rows();
  const Json json = document();
  for (const Json& sentence : json["sentences"]) {
    std::smatch found;
    const std::string text = sentence["text"];
    if (!std::regex_match(text, found, plateau)) continue;
    std::string digits = found[1];
    std::erase(digits, ',');
    std::optional<double> at;
    for (const Row& row : table) {
      if (row.at("sweep") != found[2] && row.at("sweep") != "default") continue;
      if (row.at(found[2]) == digits) at = number(row, row.at("leading_error"));
    }
    ASSERT_TRUE(at) << text;
    for (const Row& row : table) {
      if (row.at("sweep") != found[2] && row.at("sweep") != "default") continue;
      if (row.at(found[2]) == "auto" || std::stod(row.at(found[2])) <= std::stod(digits)) continue;
      EXPECT_GE(number(row, row.at("leading_error")), 0.99 * *at) << text;
    }
  }
}

TEST_F(CliCost, TheAnswerToABudgetIsOnTheFrontAndItsMaterialKeepsTheLimitAsWritten) {
  const Json budget = document()["budget"];
  ASSERT_EQ(budget["kept"], true);
  const std::string answer = budget["point"];
  const std::vector<Row> table = rows();
  const auto row_of = [&](const std::string& name) {
    return *std::ranges::find_if(table, [&](const Row& row) { return row.at("name") == name; });
  };
  const Row chosen = row_of(answer);
  for (const Row& row : table) {
    if (row.at("sweep") == "device" || number(row, "bytes") > number(chosen, "bytes")) continue;
    EXPECT_GE(number(row, "table_log_ratio_pct"), number(chosen, "table_log_ratio_pct")) << row.at("name");
  }
  const Material material = io::read_material(made(budget["material"].get<std::string>()));
  EXPECT_LE(stored_bytes(material), 40.0);
  EXPECT_EQ(stored_bytes(material), number(chosen, "bytes"));
  const MeasuredTable measured = io::read_merl(shared_->path("amber.binary"), {}, nullptr);
  const double again = fit::evaluate(material, measured).table.log_ratio_pct;
  EXPECT_EQ(again, budget["trials"].back()["again"]["errors"]["table_log_ratio_pct"]);
  EXPECT_NEAR(again, number(chosen, "table_log_ratio_pct"), 1e-9);
}

TEST_F(CliCost, AFolderSaysWhatFailedAndWhatNoPointKeepsAndGoesOnWhereItStopped) {
  std::filesystem::create_directories(path("in"));
  std::filesystem::copy(shared_->path("amber.binary"), path("in/amber.binary"));
  write_bytes("in/bad.binary", "not a table");
  const std::string command =
      "cost --quick --repeats 1 --held-out 0 " + quoted("in") + " -o " + quoted("out");
  const ProgramResult first = run(command + " --threads 3 --max-error 1e-9 --json");
  EXPECT_EQ(first.exit_code, 4) << first.err;
  EXPECT_THAT(first.err, HasSubstr("No point keeps the limits. Nearest is "));
  const Json json = io::read_json(path("out/cost.json"));
  EXPECT_EQ(Json::parse(first.out), json);
  EXPECT_EQ(schema("cost_database.schema.json").complaint(json), "");
  EXPECT_TRUE(json["failures"].contains("bad.binary"));
  // Of one material every quantile is its own figure.
  for (const Json& point : json["points"]) EXPECT_EQ(point["error"]["p10"], point["error"]["p90"]);

  // The table's own files: no material, and for any number of threads the same points.
  EXPECT_EQ(files_in("out"), 6U);
  const Json table = io::read_json(path("out/amber.cost.json"));
  EXPECT_EQ(schema("cost.schema.json").complaint(table), "");
  EXPECT_EQ(table["budget"]["kept"], false);
  EXPECT_EQ(steady(table["points"]), steady(document()["points"]));

  const std::string before = tests::read_text(path("out/amber.cost.json"));
  const ProgramResult second = run(command);
  EXPECT_EQ(second.exit_code, 4);
  EXPECT_THAT(second.err, HasSubstr("amber: finished before"));
  EXPECT_EQ(tests::read_text(path("out/amber.cost.json")), before);
  EXPECT_EQ(io::read_json(path("out/cost.json")), json);
  const ProgramResult other = run(command + " --seed 2");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("--force"));
}

TEST_F(CliCost, InterruptedItLeavesNoFile) {
  // The folder is made before the work begins.
  const std::string command = std::string(BRDFIT_PROGRAM) + " cost " + shared_->quoted("amber.binary") +
                              " -o " + quoted("none") + " 2> " + quoted("err") + " & p=$!; while [ ! -d " +
                              quoted("none") + " ]; do sleep 0.05; done; sleep 0.2; kill -TERM $p; wait $p";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_EQ(files_in("none"), 0U);
  EXPECT_THAT(tests::read_text(path("err")), HasSubstr("interrupted"));
}

TEST_F(CliCost, WhatCannotBeMeantIsRefusedBeforeAnyWork) {
  const std::string table = shared_->quoted("amber.binary");
  const auto refused = [&](const std::string& arguments) {
    const ProgramResult result = run("cost " + arguments + " -o " + quoted("none"));
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(files_in("none"), 0U);
    return result.err;
  };
  EXPECT_THAT(refused(table + " --error log_ratio"), HasSubstr("table_log_ratio_pct"));
  EXPECT_THAT(refused(table + " --error held_out_srgb --held-out 0"), HasSubstr("--error"));
  EXPECT_THAT(refused(table + " --budget-ns -1"), HasSubstr("budget-ns"));
  EXPECT_THAT(refused(table + " --repeats 0"), HasSubstr("repeats"));
  EXPECT_THAT(run("cost " + table + " -o " + shared_->quoted("out")).err, HasSubstr("--force"));
  EXPECT_EQ(run("cost " + quoted("absent.binary") + " -o " + quoted("none")).exit_code, 3);
}

}  // namespace
}  // namespace brdfit::cli
