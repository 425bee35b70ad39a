// docs/schema/table.schema.json and output.schema.json: what `fit` and `table` print and write as a whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "fit/groups.h"
#include "tests/cli_fixture.h"
#include "tests/schema_tools.h"

namespace brdfit {
namespace {

using io::Json;
using tests::complaint_with;
using tests::expect_all_members_are_described;
using tests::expect_all_numbers_are_bounded;
using tests::JsonSchema;
using tests::ProgramResult;

Json schema_file(const std::string& name) {
  return io::read_json(std::filesystem::path(BRDFIT_SOURCE_DIR) / "docs/schema" / name);
}

JsonSchema material_schema() {
  return JsonSchema(schema_file("material.schema.json"));
}

JsonSchema table_schema() {
  return JsonSchema(schema_file("table.schema.json"), {{"material.schema.json", material_schema()}});
}

JsonSchema output_schema() {
  return JsonSchema(schema_file("output.schema.json"),
                    {{"material.schema.json", material_schema()}, {"table.schema.json", table_schema()}});
}

class OutputSchema : public tests::CliFixture {
 protected:
  // Two tables, one of a name with published parameters, and a file that is none.
  void SetUp() override {
    std::filesystem::create_directories(path("in"));
    make_table("in/amber", Model::kBurley, 1);
    make_table("in/blue-fabric", Model::kCallisto, 2);
    write_bytes("in/bad.binary", "not a table");
  }

  // What a command prints, which must end with the exit code.
  Json printed(const std::string& command, int exit_code) {
    const ProgramResult result = run(command + " --samples 500 --starts 1 -q --json");
    EXPECT_EQ(result.exit_code, exit_code) << command << "\n" << result.err;
    return Json::parse(result.out);
  }

  std::string output(const std::string& folder) const { return " -o " + quoted(folder); }

  const JsonSchema table_ = table_schema();
  const JsonSchema output_ = output_schema();
};

TEST_F(OutputSchema, TheTableOfARunIsValidWithNoMemberLeftUndescribed) {
  const Json text = printed("table --published " + quoted("in") + output("out"), 4);
  const Json table = io::read_json(path("out/table.json"));
  EXPECT_EQ(table_.complaint(table), "") << table.dump(2);
  ASSERT_TRUE(table["summary"].contains("callisto (published)"));
  ASSERT_EQ(table["failures"].size(), 1U);
  expect_all_members_are_described(table_, table, "/failures");
  expect_all_numbers_are_bounded(table_, table);
  EXPECT_EQ(text, table);
  EXPECT_EQ(output_.complaint(text), "");
}

TEST_F(OutputSchema, TablesOfShardsAndOfWhatTheyMergeToAreValid) {
  for (const std::string shard : {"1", "2", "3"}) {
    run("table -q --model lambert-ggx --samples 500 --starts 1 --shard " + shard + "/3 " + quoted("in") +
        output(shard));
    const Json table = io::read_json(path(shard + "/table.json"));
    EXPECT_EQ(table_.complaint(table), "") << table.dump(2);
    EXPECT_EQ(table["shard"]["count"], 3);
    expect_all_members_are_described(table_, table, "/failures");
  }
  const ProgramResult merged =
      run("table -q --merge --json " + quoted("1") + " " + quoted("2") + " " + quoted("3") + output("all"));
  EXPECT_EQ(merged.exit_code, 4) << merged.err;
  EXPECT_EQ(output_.complaint(Json::parse(merged.out)), "");
  EXPECT_EQ(table_.complaint(io::read_json(path("all/table.json"))), "");
}

TEST_F(OutputSchema, WhatFitPrintsIsValidWithNoMemberLeftUndescribed) {
  for (const std::string options : {"", " --timings", " --effects none", " --on slices"}) {
    const Json json =
        printed("fit " + quoted("in/blue-fabric.binary") + " --force" + options + output("."), 0);
    EXPECT_EQ(output_.complaint(json), "") << options << json.dump(2);
    EXPECT_EQ(json["models"].size(), 3U);
    expect_all_members_are_described(output_, json);
    expect_all_numbers_are_bounded(output_, json);
  }
}

TEST_F(OutputSchema, WhatTablePrintsWithoutAFolderIsValidWithNoMemberLeftUndescribed) {
  for (const std::string options : {" --model lambert-ggx", " --against "}) {
    std::string command = "table ";
    command += quoted("in") + options;
    if (options == " --against ") command += quoted("in/amber.binary");
    const Json json = printed(command, 4);
    EXPECT_EQ(output_.complaint(json), "") << options << json.dump(2);
    EXPECT_EQ(json["rows"].size(), 2U);
    EXPECT_EQ(json["means"].size(), 1U);
    expect_all_members_are_described(output_, json, "/failures");
    expect_all_numbers_are_bounded(output_, json);
  }
}

TEST_F(OutputSchema, GroupsAreThoseOfTheModel) {
  const Json table = [&] {
    printed("table " + quoted("in") + output("out"), 4);
    return io::read_json(path("out/table.json"));
  }();
  ASSERT_EQ(table["rows"].size(), 6U);
  for (std::size_t k = 0; k < table["rows"].size(); ++k) {
    const std::string candidate = table["rows"][k]["candidate"];
    for (const Model other : all_models()) {
      for (const fit::Group& group : fit::groups_of(other)) {
        const std::string name(group.name);
        const bool is_own = candidate == name_of(other);
        const std::string row = "/rows/" + std::to_string(k) + "/effects";
        EXPECT_EQ(complaint_with(table_, table, row, Json::array({name})).empty(), is_own)
            << candidate << name;
        const std::string summary = "/summary/" + candidate + "/effects/" + name;
        EXPECT_EQ(complaint_with(table_, table, summary, 1).empty(), is_own) << candidate << name;
      }
    }
  }
}

}  // namespace
}  // namespace brdfit
