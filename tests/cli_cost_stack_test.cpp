// brdfit cost of light stacks from outside: files, sentences against their own CSV, a budget that is kept.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "cli/cost/cost_files.h"
#include "io/realis_json.h"
#include "tests/cli_stack_fixture.h"
#include "tests/cost_csv.h"
#include "tests/schema_tools.h"

namespace brdfit::cli {
namespace {

using io::Json;
using testing::HasSubstr;

constexpr int kWidth = 14;
constexpr int kHeight = 10;

class CliCostStack : public tests::CliStackFixture {
 protected:
  tests::ProgramResult cost(const std::string& folder, const std::string& options) {
    return run("cost -q --quick --base lambert --model lambert-ggx --folds 3 " + options + " -o " +
               quoted(folder) + " " + quoted("stack/bumps.olat.json"));
  }
  Json document(const std::string& folder) { return io::read_json(path(folder + "/bumps.cost.json")); }
};

TEST_F(CliCostStack, SaysWhatItsCsvSaysAndSpendsABudget) {
  synth(matte_bumps(kWidth, kHeight, 20));
  const tests::ProgramResult result = cost("out", "--budget-bytes 4");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json json = document("out");
  EXPECT_EQ(json["kind"], "stack");
  const std::filesystem::path schemas = std::filesystem::path(BRDFIT_SOURCE_DIR) / "docs/schema";
  const std::map<std::string, tests::JsonSchema> others = {
      {"material.schema.json", tests::JsonSchema(io::read_json(schemas / "material.schema.json"))}};
  EXPECT_EQ(tests::JsonSchema(io::read_json(schemas / "cost.schema.json"), others).complaint(json), "");
  const std::vector<Row> rows = read_csv(path("out/bumps.cost.csv"));
  EXPECT_GE(expect_comparisons_follow(rows, json), 6);
  EXPECT_THAT(tests::read_text(path("out/bumps.cost.html")), HasSubstr("<svg"));

  const Json& budget = json["budget"];
  ASSERT_EQ(budget["kept"], true);
  // No point of as few bytes has a lower error.
  for (const Row& row : rows) {
    if (row.at("sweep") == "device" || number(row, "bytes") > 4.0) continue;
    const auto chosen = std::ranges::find_if(
        rows, [&](const Row& other) { return other.at("name") == budget["point"].get<std::string>(); });
    ASSERT_NE(chosen, rows.end());
    EXPECT_LE(number(*chosen, "held_out_rgb_rmse_255"), number(row, "held_out_rgb_rmse_255"));
  }
  EXPECT_EQ(budget["material"], "bumps.realis.json");
  const RealisAsset asset = io::read_realis(path("out/bumps.realis.json"));
  // Of the pictures' texels, which a smaller texture has fewer of.
  EXPECT_LE(asset.bytes_per_texel() * static_cast<double>(asset.texel_count()), 4.0 * kWidth * kHeight);
  EXPECT_TRUE(std::filesystem::exists(path("out/" + asset.files.packed.at(0))));
}

TEST_F(CliCostStack, NamesTheNearestPointWhereNothingKeepsTheLimits) {
  synth(matte_bumps(kWidth, kHeight, 20));
  EXPECT_EQ(cost("out", "--budget-bytes 0.01").exit_code, 4);
  const Json json = document("out");
  EXPECT_EQ(json["budget"]["kept"], false);
  EXPECT_TRUE(json["budget"].contains("nearest"));
  EXPECT_FALSE(std::filesystem::exists(path("out/bumps.realis.json")));
}

TEST_F(CliCostStack, RefusesOptionsOfTables) {
  synth(matte_bumps(kWidth, kHeight, 20));
  const tests::ProgramResult lenient = cost("out", "--lenient");
  EXPECT_EQ(lenient.exit_code, 2);
  EXPECT_THAT(lenient.err, HasSubstr("--lenient is not for light stacks"));
  EXPECT_EQ(cost("out", "--error table_log_ratio_pct").exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

}  // namespace
}  // namespace brdfit::cli
