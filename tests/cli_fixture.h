// A folder with small synthetic tables, and the program run in it.
#ifndef BRDFIT_TESTS_CLI_FIXTURE_H_
#define BRDFIT_TESTS_CLI_FIXTURE_H_

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "data/synthetic/generate.h"
#include "data/synthetic/random_material.h"
#include "tests/program.h"
#include "tests/temp_folder.h"

namespace brdfit::tests {

class CliFixture : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  std::string quoted(const std::string& name) const {
    std::string result = "'";
    result += path(name).string();
    return result += "'";
  }

  ProgramResult run(const std::string& arguments) {
    std::filesystem::create_directories(path("streams"));
    return run_brdfit(arguments, path("streams"));
  }

  // NAME.binary: a noise-free table of a random material with all effects.
  void make_table(const std::string& name, Model model, std::uint64_t seed) {
    synthetic::Recipe recipe;
    recipe.name = name;
    recipe.material = synthetic::random_material(model, Tier::kFull, effects_of(model), {}, seed);
    recipe.grid.n_theta_h = 30;
    recipe.grid.n_theta_d = 30;
    recipe.grid.n_phi_d = 36;
    synthetic::generate(recipe, path(name + ".binary"));
  }

  void write_bytes(const std::string& name, const std::string& bytes) { write_text(path(name), bytes); }

  std::size_t files_in(const std::string& name) const {
    if (!std::filesystem::exists(path(name))) return 0;
    const std::filesystem::directory_iterator files(path(name));
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
  }

  TempFolder folder_;
};

}  // namespace brdfit::tests

#endif  // BRDFIT_TESTS_CLI_FIXTURE_H_
