// The same inputs give the same bytes, but for timings: whatever the threads, the locale, the time zone, the
// working directory, and however paths are written.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <clocale>
#include <filesystem>
#include <locale>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/shader/material_shader.h"
#include "data/synthetic/recipe.h"
#include "io/json.h"
#include "io/material_json.h"
#include "io/merl.h"
#include "io/stack_source.h"
#include "render/svg.h"
#include "tests/cli_stack_fixture.h"

namespace brdfit {
namespace {

namespace fs = std::filesystem;

// Where and how all commands are run.
struct Surroundings {
  std::string name;    // of the folder with all files
  std::string before;  // variables of the environment
  int threads = 1;
  bool is_absolute = false;  // paths from the root, and another working directory
};

struct Step {
  const char* name;
  const char* arguments;  // paths begin with @
};

// Every command that writes, each with small inputs.
constexpr std::array<Step, 13> kSteps{{
    {"synth", "synth -o @made @table.json @stack.json"},
    {"info", "info @made/clay.binary"},
    {"fit", "fit @made/clay.binary --model burley --tier base --samples 300 --held-out=2 -o @fits"},
    {"slice", "slice @fits/clay.burley.json --size 64 -o @slice.png"},
    {"sphere", "sphere @made/clay.binary --minus @fits/clay.burley.json --size 32 --plain -o @sphere.exr"},
    {"compare",
     "compare @made/clay.binary @fits/clay.burley.json --pictures slices,lobes --size 64 -o @pictures"},
    {"merl", "export @fits/clay.burley.json --grid 6 6 6 -o @again.binary"},
    {"glsl", "export @fits/clay.burley.json --to glsl -o @clay.glsl"},
    {"table", "table @made --model lambert-ggx --tier base --samples 300 -o @tables"},
    {"bake", "bake @made/bumps.olat.json --lobes 2 --base lambert --gains -o @baked"},
    {"relight", "relight @baked/bumps.realis.json --light 0.3 0 0.9 -o @relit.png"},
    {"unpacked", "relight @baked/bumps.realis.json --unpacked -o @relit.exr"},
    {"lights", "info @made/bumps.olat.json --lights @lights.svg"},
}};

void erase_timings(io::Json& json) {
  if (json.is_object()) json.erase("timings_seconds");
  for (auto& member : json) {
    if (member.is_structured()) erase_timings(member);
  }
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

using Contents = std::map<std::string, std::string>;

class Determinism : public tests::CliStackFixture {
 protected:
  // Runs everything in a folder of its own.
  void run_all(const Surroundings& s) {
    fs::create_directories(path(s.name));
    fs::create_directories(path(s.name + "-streams"));
    synthetic::Recipe recipe;
    recipe.name = "clay";
    recipe.material = synthetic::random_material(Model::kCallisto, Tier::kBase, {}, {}, 3);
    recipe.grid.n_theta_h = recipe.grid.n_theta_d = recipe.grid.n_phi_d = 12;
    recipe.noise.multiplicative = 0.05;
    synthetic::write_recipe(path(s.name) / "table.json", recipe);
    io::write_json(path(s.name) / "stack.json", synthetic::stack_recipe_to_json(matte_bumps(16, 12, 14)));
    for (const Step& step : kSteps) run_step(s, step.name, step.arguments);
  }

  void run_step(const Surroundings& s, const std::string& name, const std::string& arguments) {
    const std::string folder = path(s.name).string();
    std::string before = "cd '";
    before += s.is_absolute ? path("").string() : folder;
    before += "' && " + s.before;
    const std::string prefix = s.is_absolute ? folder + "/" : "";
    const std::string threads = " --json --threads " + std::to_string(s.threads);
    const tests::ProgramResult result =
        tests::run_brdfit(replaced(arguments, "@", prefix) + threads, path(s.name + "-streams"), before);
    ASSERT_EQ(result.exit_code, 0) << name << ": " << result.err;
    tests::write_text(path(s.name) / (name + ".out.json"), result.out);
  }

  // All files, without timings, paths and the number of threads.
  Contents contents(const Surroundings& s) const {
    Contents files;
    for (const auto& entry : fs::recursive_directory_iterator(path(s.name))) {
      const std::string name = fs::relative(entry.path(), path(s.name)).string();
      if (!entry.is_regular_file() || name == "tables/timings.csv") continue;
      std::string text = tests::read_text(entry.path());
      if (name.ends_with(".json")) {
        io::Json json = io::Json::parse(text);
        erase_timings(json);
        text = json.dump(1);
      }
      text = replaced(text, path(s.name).string() + "/", "");
      for (const char* threads : {"1", "2", "3"}) {
        text = replaced(text, std::string("--threads ") + threads, "--threads N");
      }
      files[name] = text;
    }
    return files;
  }

  static void expect_same(const Contents& a, const Contents& b) {
    EXPECT_EQ(a.size(), b.size());
    for (const auto& [name, text] : a) {
      ASSERT_TRUE(b.contains(name)) << name;
      EXPECT_TRUE(b.at(name) == text) << name;
    }
  }
};

const Surroundings kPlain = {"plain", "LC_ALL=C TZ=UTC", 1, false};

TEST_F(Determinism, NothingButTimingsDependsOnWhereAndHowItIsRun) {
  const Surroundings other = {"other", "LC_ALL=de_DE.UTF-8 LANG=de_DE.UTF-8 TZ=Asia/Tokyo COLUMNS=40", 2,
                              false};
  const Surroundings absolute = {"absolute", "TZ=America/New_York", 3, true};
  run_all(kPlain);
  ASSERT_FALSE(HasFatalFailure());
  const Contents expected = contents(kPlain);
  // Streams, pictures, textures, tables: if this shrinks, the test has lost what it looks at.
  EXPECT_GT(expected.size(), 50U);
  for (const Surroundings& s : {other, absolute}) {
    SCOPED_TRACE(s.name);
    run_all(s);
    ASSERT_FALSE(HasFatalFailure());
    expect_same(expected, contents(s));
  }
  for (const auto& entry : fs::recursive_directory_iterator(path(kPlain.name))) {
    if (!entry.is_regular_file()) continue;
    EXPECT_EQ(tests::read_text(entry.path()).find(path("").string()), std::string::npos)
        << entry.path() << " holds a path that nobody gave";
  }
  // A report holds the timings of the files that it shows: of the same files it is the same.
  fs::remove_all(path("other/fits"));
  fs::copy(path("plain/fits"), path("other/fits"));
  for (const Surroundings& s : {kPlain, other}) run_step(s, "report", "report @fits --size 64");
  EXPECT_TRUE(contents(kPlain).at("fits/report.html") == contents(other).at("fits/report.html"));
}

// As many languages write numbers: 1.234.567,5.
class CommaNumbers : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

// For a program that uses the libraries and has set its locale.
class LocaleOfCommas {
 public:
  LocaleOfCommas() : before_(std::locale::global(std::locale(std::locale::classic(), new CommaNumbers))) {
    // The C library's too, where the machine has such a locale.
    for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8"}) {
      if (std::setlocale(LC_ALL, name) != nullptr) break;
    }
  }
  LocaleOfCommas(const LocaleOfCommas&) = delete;
  LocaleOfCommas& operator=(const LocaleOfCommas&) = delete;
  ~LocaleOfCommas() {
    std::locale::global(before_);
    std::setlocale(LC_ALL, "C");
  }

 private:
  std::locale before_;
};

class LocaleTest : public testing::Test {
 protected:
  // What the libraries write of one material, stack and picture.
  Contents written(const std::string& name) {
    const fs::path where = folder_ / name;
    fs::create_directories(where);
    const Material material =
        synthetic::random_material(Model::kCallisto, Tier::kFull, effects_of(Model::kCallisto), {}, 5);
    io::write_material(where / "material.json", material, {{"samples", 1234567}, {"error", 1234.5}});
    io::write_merl(where / "table.binary", {3, 2, 1}, [](int h, int d, int) {
      return Rgb{0.5 * h, 0.25 * d, 1.5};
    });
    tests::write_text(where / "material.glsl", shader::material_shader(material, {}));
    render::Svg svg(1234.5, 2000.25, "title", "description");
    svg.text({1234.5, 0.125}, "1234.5", "");
    tests::write_text(where / "picture.svg", svg.finish());
    EXPECT_EQ(io::read_material(where / "material.json"), material);
    Contents files;
    for (const auto& entry : fs::directory_iterator(where)) {
      files[entry.path().filename()] = tests::read_text(entry.path());
    }
    return files;
  }

  tests::TempFolder folder_;
};

TEST_F(LocaleTest, LibrariesWriteAndReadNumbersTheSameInAnyLocale) {
  const Contents plain = written("plain");
  tests::write_text(folder_ / "a.png", "");
  tests::write_text(folder_ / "lights.lp", "1\na.png 0.6 0 0.8\n");
  const LocaleOfCommas commas;
  std::ostringstream shown;
  shown << 1234.5;
  ASSERT_EQ(shown.str(), "1.234,5");
  EXPECT_EQ(written("commas"), plain);
  EXPECT_EQ(io::read_light_positions(folder_ / "lights.lp").pictures[0].light.direction.z, 0.8);
}

}  // namespace
}  // namespace brdfit
