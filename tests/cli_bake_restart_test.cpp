// A bake that is interrupted, in each of its phases, ends as one that was not.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "io/realis_json.h"
#include "tests/cli_stack_fixture.h"

namespace brdfit::cli {
namespace {

namespace fs = std::filesystem;

using testing::HasSubstr;

class CliBakeRestart : public tests::CliStackFixture {
 protected:
  void SetUp() override {
    // Two strips of rows in the least memory.
    synthetic::StackRecipe recipe = matte_bumps(96, 80, 20);
    recipe.materials[0].set("base_color", Rgb{0.6, 0.4, 0.2});
    synth(recipe);
  }

  std::string command(const std::string& options) const {
    return "bake --lobes 2 --uniform --base lambert --folds 3 --sample 200 --memory 16 --colour rgb -o " +
           quoted("baked") + " " + options + " " + quoted("stack/bumps.olat.json");
  }
  tests::ProgramResult bake(const std::string& options) { return run(command(options)); }

  // Every file of the asset; of its description what does not tell of time or of how it was asked for.
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> found;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path("baked"))) {
      if (!entry.is_regular_file()) continue;
      const std::string name = entry.path().lexically_relative(path("baked")).string();
      found[name] = tests::read_text(entry.path());
      if (!name.ends_with(".json")) continue;
      io::Json json = io::read_json(entry.path());
      if (!json.contains("bake")) continue;
      for (const char* key : {"timings_seconds", "command"}) json["bake"].erase(key);
      found[name] = json.dump();
    }
    return found;
  }

  void expect_files(const std::map<std::string, std::string>& expected) const {
    const std::map<std::string, std::string> found = files();
    for (const auto& [name, bytes] : expected) {
      ASSERT_TRUE(found.contains(name)) << name;
      EXPECT_TRUE(found.at(name) == bytes) << name;
    }
    for (const auto& [name, bytes] : found) EXPECT_TRUE(expected.contains(name)) << name;
  }

  std::map<std::string, std::string> uninterrupted(const std::string& options) {
    const tests::ProgramResult baked = bake(options);
    EXPECT_EQ(baked.exit_code, 0) << baked.err;
    std::map<std::string, std::string> found = files();
    fs::remove_all(path("baked"));
    return found;
  }
};

TEST_F(CliBakeRestart, EndsAsAnUninterruptedOneFromEveryPhase) {
  const std::map<std::string, std::string> expected = uninterrupted("");
  ASSERT_TRUE(expected.contains("bumps.benefit.png"));
  const std::vector<std::pair<std::string, std::string>> phases = {
      {"plan", "continuing: plan\n"},
      {"fold", "continuing: plan, 1 of 3 folds\n"},
      {"evidence", "continuing: plan, evidence\n"},
      {"strip", "continuing: plan, evidence, "},
      {"textures", "continuing: plan, evidence, 80 of 80 rows\n"}};
  for (const auto& [phase, line] : phases) {
    const tests::ProgramResult stopped = bake("--stop-after " + phase);
    EXPECT_EQ(stopped.exit_code, 1);
    EXPECT_THAT(stopped.err, HasSubstr("interrupted; the same command goes on from"));
    EXPECT_FALSE(fs::exists(path("baked/bumps.realis.json")));
    const tests::ProgramResult done = bake("");
    EXPECT_EQ(done.exit_code, 0) << phase << done.err;
    EXPECT_THAT(done.err, HasSubstr(line));
    expect_files(expected);
    fs::remove_all(path("baked"));
  }
}

TEST_F(CliBakeRestart, GoesOnFromOneInterruptionAfterTheOther) {
  const std::string options = "--no-panels --bits 4 --dominant 1 ";
  const std::map<std::string, std::string> expected = uninterrupted(options);
  int stops = 0;
  for (const std::string phase : {"plan", "fold", "fold", "evidence", "strip", "strip", "textures"}) {
    const tests::ProgramResult stopped = bake(options + "--stop-after " + phase);
    EXPECT_EQ(stopped.exit_code, 1) << phase << stopped.err;
    ++stops;
  }
  EXPECT_EQ(stops, 7);
  // Without the ranges, the last strip cut short: what is there is used, what is not is made.
  const fs::path part = path("baked/bumps.realis.part");
  fs::resize_file(part / "rows", fs::file_size(part / "rows") - 1);
  fs::remove(part / "ranges");
  const tests::ProgramResult done = bake(options);
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("continuing: plan, evidence, "));
  EXPECT_THAT(done.err, testing::Not(HasSubstr("80 of 80")));
  expect_files(expected);
}

TEST_F(CliBakeRestart, GoesOnAfterBeingKilled) {
  const std::map<std::string, std::string> expected = uninterrupted("");
  // A pipe with room for the line of the first fold and for no other: the bake waits at the next.
  const std::string first = "bumps: 20 lights, 96 x 80 texels\n[1/3] held-out lights\n";
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const int room = fcntl(ends[1], F_SETPIPE_SZ, 4096);
  ASSERT_GT(room, 0);
  const std::string filling(static_cast<std::size_t>(room) - first.size() - 10, '.');
  ASSERT_EQ(write(ends[1], filling.data(), filling.size()), static_cast<ssize_t>(filling.size()));
  const std::string line = std::string("exec ") + BRDFIT_PROGRAM + " " + command("");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);
    execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    _exit(127);
  }
  close(ends[1]);
  int status = 0;
  int waiting = 0;
  while (waiting < static_cast<int>(filling.size() + first.size()) && waitpid(child, &status, WNOHANG) == 0) {
    usleep(2000);
    ASSERT_EQ(ioctl(ends[0], FIONREAD, &waiting), 0);
  }
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  close(ends[0]);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_FALSE(fs::exists(path("baked/bumps.realis.json")));
  const tests::ProgramResult done = bake("");
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("continuing: plan"));
  expect_files(expected);
}

TEST_F(CliBakeRestart, BeginsAnewForAnotherOptionInputOrWhenTold) {
  const std::string options = "--no-evidence ";
  ASSERT_EQ(bake(options + "--stop-after plan").exit_code, 1);
  const tests::ProgramResult other = bake(options + "--bits 4 --stop-after strip");
  EXPECT_THAT(other.err, HasSubstr("--bits is 4 and was 8: beginning anew"));
  const tests::ProgramResult fresh = bake(options + "--bits 4 --fresh --stop-after plan");
  EXPECT_THAT(fresh.err, testing::Not(HasSubstr("continuing")));
  fs::last_write_time(path("stack/bumps.0003.exr"), fs::file_time_type::clock::now());
  const tests::ProgramResult touched = bake(options + "--bits 4 --stop-after plan");
  EXPECT_THAT(touched.err, HasSubstr("bumps.0003.exr has changed: beginning anew"));
  // How it is done changes nothing, so it goes on.
  const tests::ProgramResult same = bake(options + "--bits 4 --threads 1 --memory 64 --spill off --force");
  EXPECT_THAT(same.err, HasSubstr("continuing: plan"));
  EXPECT_EQ(same.exit_code, 0);
  EXPECT_FALSE(fs::exists(path("baked/bumps.realis.part")));
}

TEST_F(CliBakeRestart, RemovesThePanelsOfTheAssetThatItOverwrites) {
  ASSERT_EQ(bake("--no-evidence --panels 1 --panels 4").exit_code, 0);
  write_bytes("baked/bumps.panels/mine.png", "mine");
  ASSERT_EQ(bake("--no-evidence --panels 4 --panels 7 --force").exit_code, 0);
  EXPECT_EQ(files_in("baked/bumps.panels"), 3U);
  EXPECT_FALSE(fs::exists(path("baked/bumps.panels/bumps.0001.png")));
  ASSERT_EQ(bake("--no-evidence --force --colour luminance").exit_code, 0);
  EXPECT_FALSE(fs::exists(path("baked/bumps.benefit.png")));
  EXPECT_FALSE(fs::exists(path("baked/bumps.codes1.png")));
  EXPECT_EQ(tests::read_text(path("baked/bumps.panels/mine.png")), "mine");
}

}  // namespace
}  // namespace brdfit::cli
