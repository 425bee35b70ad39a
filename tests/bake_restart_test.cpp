// What an interrupted bake leaves: taken over whole, or not at all.
#include "cli/bake_restart.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "cli/bake_key.h"
#include "cli/left_files.h"
#include "io/realis_json.h"
#include "tests/temp_folder.h"

namespace brdfit::cli {
namespace {

namespace fs = std::filesystem;

using testing::HasSubstr;

// Changes a byte of a file, counted from its beginning, or from its end where negative.
void damage(const fs::path& file, std::ptrdiff_t place) {
  std::string bytes = tests::read_text(file);
  const auto at =
      static_cast<std::size_t>(place < 0 ? static_cast<std::ptrdiff_t>(bytes.size()) + place : place);
  bytes.at(at) = static_cast<char>(bytes.at(at) ^ 1);
  tests::write_text(file, bytes);
}

KeptStrip strip_of(int rows, float value) {
  KeptStrip strip;
  const auto texels = static_cast<std::size_t>(rows) * 4;
  strip.rows.amplitudes.assign(2 * texels, value);
  strip.rows.surface.albedo.assign(3 * texels, value + 1.0F);
  strip.rows.surface.normals.assign(3 * texels, value + 2.0F);
  strip.rows.confidence.assign(texels, value + 3.0F);
  strip.rows.packed.textures = {std::vector<std::uint8_t>(4 * texels, 7),
                                std::vector<std::uint8_t>(4 * texels, 9)};
  strip.rows.packed.mask.assign(texels, 5);
  strip.pixels.saturated = static_cast<std::size_t>(rows);
  strip.cut_codes = 11;
  return strip;
}

void expect_same(const KeptStrip& a, const KeptStrip& b) {
  EXPECT_EQ(a.rows.amplitudes, b.rows.amplitudes);
  EXPECT_EQ(a.rows.chroma, b.rows.chroma);
  EXPECT_EQ(a.rows.surface.albedo, b.rows.surface.albedo);
  EXPECT_EQ(a.rows.surface.normals, b.rows.surface.normals);
  EXPECT_EQ(a.rows.confidence, b.rows.confidence);
  EXPECT_EQ(a.rows.packed.textures, b.rows.packed.textures);
  EXPECT_EQ(a.rows.packed.mask, b.rows.packed.mask);
  EXPECT_EQ(a.pixels.saturated, b.pixels.saturated);
  EXPECT_EQ(a.cut_codes, b.cut_codes);
}

class BakeRestartTest : public testing::Test {
 protected:
  static io::Json key(const std::string& lobes = "8") {
    io::Json key;
    key["version"] = "1";
    key["instructions"] = "baseline";
    key["stack"] = "0123";
    key["lobe_set"] = "";
    key["options"] = {{"--bits", "8"}, {"--lobes", lobes}};
    key["inputs"] = {{"a.jpg", "10 bytes"}, {"b.jpg", "12 bytes"}};
    return key;
  }

  // As if a bake had been interrupted after four of ten rows and one fold of three.
  void leave_all() const {
    BakeRestart restart(part(), key(), false);
    EXPECT_EQ(restart.found(10, 3), "");
    EXPECT_EQ(restart.how_to_go_on(), "nothing is written");
    EXPECT_FALSE(fs::exists(part()));
    bake::BakePlan plan;
    plan.gains = {1.0, 1.0 / 3.0};
    restart.keep_plan(plan);
    restart.keep_ranges({{0.1, 3}});
    bake::FoldEvidence fold;
    fold.plan = plan;
    fold.sums.push_back({"realis", {{0.1, 0.2}, {3.0, 4.0}, 0.7, 2.0}, {{0.3, 0.4}, {9.0, 12.0}, 0.9, 6.0}});
    restart.keep_fold(1, fold);
    restart.keep_strip(0, 2, strip_of(2, 0.5F));
    restart.keep_strip(6, 2, strip_of(2, 0.25F));
    EXPECT_THAT(restart.how_to_go_on(), HasSubstr("asset.realis.part"));
  }

  fs::path part() const { return folder_ / "asset.realis.part"; }

  tests::TempFolder folder_;
};

TEST_F(BakeRestartTest, TakesOverWhatWasKept) {
  leave_all();
  BakeRestart restart(part(), key(), false);
  EXPECT_EQ(restart.found(10, 3), "continuing: plan, 1 of 3 folds, 4 of 10 rows");
  ASSERT_TRUE(restart.plan());
  EXPECT_EQ(restart.plan()->gains, (std::vector<double>{1.0, 1.0 / 3.0}));
  ASSERT_TRUE(restart.ranges());
  EXPECT_EQ((*restart.ranges())[0], (RealisRange{0.1, 3}));
  EXPECT_FALSE(restart.evidence());
  EXPECT_FALSE(restart.has_fold(0));
  ASSERT_TRUE(restart.has_fold(1));
  EXPECT_EQ(restart.fold(1)->sums[0].luminance.lit_squares, 0.7);
  EXPECT_EQ(restart.fold(1)->sums[0].rgb.squares, (std::vector<double>{0.3, 0.4}));
  EXPECT_EQ(restart.rows_at(0), 2);
  EXPECT_EQ(restart.rows_at(1), 0);
  EXPECT_EQ(restart.next_kept(2, 10), 6);
  EXPECT_EQ(restart.next_kept(7, 10), 10);
  expect_same(restart.strip(0), strip_of(2, 0.5F));
  expect_same(restart.strip(6), strip_of(2, 0.25F));
  // What is added stands beside it.
  restart.keep_strip(2, 4, strip_of(4, 0.125F));
  expect_same(restart.strip(2), strip_of(4, 0.125F));
}

TEST_F(BakeRestartTest, MakesAFoldOnceAndThenReadsIt) {
  leave_all();
  int made = 0;
  const auto make = [&] {
    ++made;
    bake::FoldEvidence fold;
    fold.sums.push_back({"lambert", {{0.5}, {1.0}, 0.0, 0.0}, {}});
    return fold;
  };
  {
    BakeRestart restart(part(), key(), false);
    EXPECT_EQ(restart.fold_of(1, make).sums[0].name, "realis");
    EXPECT_EQ(restart.fold_of(2, make).sums[0].name, "lambert");
  }
  BakeRestart again(part(), key(), false);
  EXPECT_EQ(again.fold_of(2, make).sums[0].name, "lambert");
  EXPECT_EQ(made, 1);
}

TEST_F(BakeRestartTest, TrustsNothingThatIsDamaged) {
  leave_all();
  for (const char* name : {"plan", "ranges", "fold-1"}) {
    for (const std::ptrdiff_t place : {9, -1}) damage(part() / name, place);
  }
  fs::resize_file(part() / "ranges", 20);
  BakeRestart restart(part(), key(), false);
  EXPECT_FALSE(restart.plan());
  EXPECT_FALSE(restart.ranges());
  EXPECT_FALSE(restart.has_fold(1));
  const std::string found = restart.found(10, 3);
  EXPECT_THAT(found, HasSubstr("continuing: 4 of 10 rows; damaged, so made anew: plan, ranges, fold-1"));
}

TEST_F(BakeRestartTest, TrustsStripsUpToTheFirstThatIsNotWhole) {
  leave_all();
  const std::string whole = tests::read_text(part() / "rows");
  int seen[] = {0, 0, 0};  // how often none, one and both strips were left
  for (std::size_t place = 0; place < whole.size(); place += 13) {
    for (const bool cut : {false, true}) {
      tests::write_text(part() / "rows", cut ? whole.substr(0, place) : whole);
      if (!cut) damage(part() / "rows", static_cast<std::ptrdiff_t>(place));
      BakeRestart restart(part(), key(), false);
      const bool first = restart.rows_at(0) > 0;
      const bool second = restart.rows_at(6) > 0;
      ++seen[(first ? 1 : 0) + (second ? 1 : 0)];
      if (first) expect_same(restart.strip(0), strip_of(2, 0.5F));
      EXPECT_FALSE(second) << place;
    }
  }
  EXPECT_GT(seen[0], 0);
  EXPECT_GT(seen[1], 0);
  // What was cut off is written over.
  tests::write_text(part() / "rows", whole.substr(0, whole.size() - 1));
  {
    BakeRestart restart(part(), key(), false);
    restart.keep_strip(2, 1, strip_of(1, 4.0F));
  }
  BakeRestart restart(part(), key(), false);
  EXPECT_EQ(restart.found(10, 3), "continuing: plan, 1 of 3 folds, 3 of 10 rows");
  expect_same(restart.strip(2), strip_of(1, 4.0F));
}

TEST_F(BakeRestartTest, BeginsAnewWhereTheKeyDiffersAndSaysWhy) {
  leave_all();
  {
    BakeRestart restart(part(), key("4"), false);
    EXPECT_FALSE(restart.plan());
    EXPECT_FALSE(restart.has_fold(1));
    EXPECT_EQ(restart.rows_at(0), 0);
    EXPECT_THAT(restart.found(10, 3), HasSubstr("--lobes is 4 and was 8"));
    EXPECT_EQ(restart.how_to_go_on(), "nothing is written");
  }
  // Nothing is lost before there is something else to keep.
  EXPECT_TRUE(BakeRestart(part(), key(), false).plan());
  BakeRestart(part(), key("4"), false).keep_ranges({});
  BakeRestart restart(part(), key("4"), false);
  EXPECT_FALSE(restart.plan());
  EXPECT_TRUE(restart.ranges());
  EXPECT_EQ(restart.rows_at(0), 0);
}

TEST_F(BakeRestartTest, NamesTheDifference) {
  const auto changed = [](const char* group, const char* name, const char* value) {
    io::Json other = key();
    other[group][name] = value;
    return difference_of_keys(other, key());
  };
  EXPECT_EQ(difference_of_keys(key(), key()), "");
  EXPECT_EQ(changed("inputs", "b.jpg", "13 bytes"), "b.jpg has changed");
  EXPECT_EQ(changed("inputs", "c.jpg", "13 bytes"), "c.jpg has changed");
  EXPECT_EQ(changed("options", "--gains", "true"), "--gains is true and was not given");
  io::Json other = key();
  other["stack"] = "0124";
  EXPECT_EQ(difference_of_keys(other, key()), "the stack's description has changed");
  other["version"] = "2";
  EXPECT_EQ(difference_of_keys(other, key()), "brdfit is 2 and was 1");
  EXPECT_NE(difference_of_keys(key(), io::Json::array()), "");
}

TEST_F(BakeRestartTest, TakesNothingOverWithFreshOrADamagedKey) {
  leave_all();
  EXPECT_FALSE(BakeRestart(part(), key(), true).plan());
  tests::write_text(part() / "key.json", "{");
  BakeRestart restart(part(), key(), false);
  EXPECT_FALSE(restart.plan());
  EXPECT_THAT(restart.found(10, 3), HasSubstr("key.json is damaged"));
}

TEST_F(BakeRestartTest, TakesNamesOfAnyBytes) {
  io::Json odd = key();
  odd["inputs"]["\xff.jpg"] = "1 byte";
  BakeRestart(part(), odd, false).keep_ranges({});
  EXPECT_TRUE(BakeRestart(part(), odd, false).ranges());
}

TEST_F(BakeRestartTest, IsForOneBakeAtATime) {
  leave_all();
  const int other = open((part() / "lock").c_str(), O_RDWR);
  ASSERT_EQ(flock(other, LOCK_EX), 0);
  EXPECT_THROW(BakeRestart(part(), key(), false), UsageError);
  close(other);
  EXPECT_TRUE(BakeRestart(part(), key(), false).plan());
}

TEST_F(BakeRestartTest, RemovesTheTemporariesOfABakeThatWasKilled) {
  leave_all();
  const pid_t ended = fork();
  if (ended == 0) _exit(0);
  ASSERT_EQ(waitpid(ended, nullptr, 0), ended);
  tests::write_text(part() / "lock", std::to_string(ended));
  const std::string left = ".brdfit-" + std::to_string(ended) + "-0.tmp";
  const std::string of_others = ".brdfit-" + std::to_string(getpid()) + "-0.tmp";
  fs::create_directories(folder_ / "asset.panels");
  const std::vector<fs::path> gone = {folder_ / left, part() / left, folder_ / "asset.panels" / left};
  const std::vector<fs::path> stays = {folder_ / of_others, folder_ / ("x" + left)};
  for (const auto& files : {gone, stays}) {
    for (const fs::path& file : files) tests::write_text(file, "x");
  }
  EXPECT_TRUE(BakeRestart(part(), key(), false).plan());
  for (const fs::path& file : gone) EXPECT_FALSE(fs::exists(file)) << file;
  for (const fs::path& file : stays) EXPECT_TRUE(fs::exists(file)) << file;
}

TEST_F(BakeRestartTest, LeavesNothingWhenTheAssetIsComplete) {
  leave_all();
  tests::write_text(part() / "mine.txt", "not the bake's");
  {
    BakeRestart restart(part(), key(), false);
    restart.keep_outputs_begun();
    EXPECT_TRUE(restart.has_outputs_begun());
    restart.remove();
  }
  EXPECT_EQ(fs::directory_iterator(part())->path().filename(), "mine.txt");
  fs::remove_all(part());
  leave_all();
  BakeRestart(part(), key(), false).remove();
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(BakeRestartTest, GoesOnWithoutWhereNothingCanBeKept) {
  tests::write_text(part(), "a file where the folder would be");
  BakeRestart restart(part(), key(), false);
  restart.keep_strip(0, 2, strip_of(2, 0.5F));
  restart.keep_plan({});
  EXPECT_EQ(restart.rows_at(0), 0);
  EXPECT_EQ(restart.how_to_go_on(), "nothing is written");
  restart.remove();
  EXPECT_EQ(tests::read_text(part()), "a file where the folder would be");
}

TEST(LeftFiles, AreThoseThatTheNewAssetDoesNotName) {
  const tests::TempFolder folder;
  const fs::path json = folder / "a.realis.json";
  RealisAsset asset;
  asset.name = "a";
  asset.width = asset.height = 1;
  name_asset_files(asset);
  io::Json bake;
  bake["pictures"] = {{"benefit", {{"file", "a.benefit.png"}}},
                      {"panels",
                       {{{"file", "a.panels/1.png"}},
                        {{"file", "a.panels/2.png"}},
                        {{"file", "../a.outside.png"}},
                        {{"file", "a.panels/../other.png"}},
                        {{"file", "another.png"}}}}};
  io::write_realis(json, asset, bake);
  fs::create_directories(folder / "a.panels");
  for (const char* name : {"a.benefit.png", "a.panels/1.png", "a.panels/2.png", "other.png", "another.png",
                           "a.panels/mine.png", "a.albedo.png"}) {
    tests::write_text(folder / name, "x");
  }
  const std::vector<fs::path> before = files_named_by(json);
  bake["pictures"] = {{"panels", {{{"file", "a.panels/2.png"}}}}};
  io::write_realis(json, asset, bake);
  remove_left_files(json, before);
  EXPECT_FALSE(fs::exists(folder / "a.benefit.png"));
  EXPECT_FALSE(fs::exists(folder / "a.panels/1.png"));
  for (const char* name :
       {"a.panels/2.png", "a.panels/mine.png", "other.png", "another.png", "a.albedo.png"}) {
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  }
  // What is no asset names nothing.
  tests::write_text(json, "{}");
  EXPECT_TRUE(files_named_by(json).empty());
  EXPECT_TRUE(files_named_by(folder / "none.realis.json").empty());
}

}  // namespace
}  // namespace brdfit::cli
