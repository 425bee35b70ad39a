// docs/stability.md and the suite list the same cases, and what the page says can be looked up.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/stability_cases.h"
#include "tests/stability_data.h"
#include "tests/stability_energy.h"

namespace brdfit::stability {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = BRDFIT_SOURCE_DIR;

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string page() {
  return text_of(kSource / "docs/stability.md");
}

using Row = std::vector<std::string>;

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

// Rows of tables without the outer bars.
std::vector<Row> rows_of(const std::string& text) {
  std::vector<Row> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| ")) continue;
    Row row;
    std::istringstream cells(line.substr(1));
    for (std::string cell; std::getline(cells, cell, '|');) row.push_back(trimmed(cell));
    rows.push_back(row);
  }
  return rows;
}

// By the names of cases, of the tables that list cases.
std::map<std::string, Row> cases_of_page() {
  std::map<std::string, Row> cases;
  for (const Row& row : rows_of(page())) {
    if (!row[0].starts_with("`")) continue;
    const std::string id = row[0].substr(1, row[0].size() - 2);
    EXPECT_TRUE(cases.emplace(id, row).second) << id << " stands there twice";
  }
  return cases;
}

std::vector<std::string> cases_of_suite() {
  std::vector<std::string> ids;
  const auto add = [&ids](const auto& cases) {
    for (const auto& one : cases) ids.push_back(one.id);
  };
  add(kernel_cases());
  add(branch_cases());
  add(kink_cases());
  add(energy_cases());
  add(fit_cases());
  add(realis_cases());
  return ids;
}

// "Suite.Name" of every test in the tree.
std::set<std::string> tests_of_tree() {
  const std::regex test(R"(\bTEST(?:_F|_P)?\((\w+),\s*(\w+)\))");
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(kSource / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator it(text.begin(), text.end(), test), end; it != end; ++it) {
      names.insert((*it)[1].str() + "." + (*it)[2].str());
    }
  }
  return names;
}

// Names of tests in a text, as `Suite.Name` or `Beginning*`.
std::vector<std::string> tests_in(const std::string& text) {
  const std::regex name(R"(`([A-Z]\w+\.[A-Z]\w*\*?|[A-Z]\w+\*)`)");
  std::vector<std::string> names;
  for (std::sregex_iterator it(text.begin(), text.end(), name), end; it != end; ++it) {
    names.push_back((*it)[1].str());
  }
  return names;
}

TEST(StabilityPage, ListsTheCasesOfTheSuite) {
  std::vector<std::string> listed;
  for (const auto& [id, row] : cases_of_page()) listed.push_back(id);
  EXPECT_THAT(cases_of_suite(), testing::UnorderedElementsAreArray(listed));
}

TEST(StabilityPage, SaysOfEachCaseWhatHappensWhyAndWhichTest) {
  for (const auto& [id, row] : cases_of_page()) {
    EXPECT_GE(row.size(), 4U) << id;
    for (const std::string& cell : row) EXPECT_FALSE(cell.empty()) << id;
    EXPECT_FALSE(tests_in(row.back()).empty()) << id;
  }
}

TEST(StabilityPage, NamesTestsThatExist) {
  const std::set<std::string> tests = tests_of_tree();
  const std::vector<std::string> named = tests_in(page());
  EXPECT_FALSE(named.empty());
  for (std::string name : named) {
    if (!name.ends_with("*")) {
      EXPECT_TRUE(tests.contains(name)) << name;
      continue;
    }
    name.pop_back();
    const auto found = tests.lower_bound(name);
    EXPECT_TRUE(found != tests.end() && found->starts_with(name)) << name;
  }
}

TEST(StabilityPage, GivesAReasonForWhatIsLeftOut) {
  const std::string text = page();
  const std::vector<Row> rows = rows_of(text.substr(text.find("## Left out")));
  ASSERT_GT(rows.size(), 1U);
  for (const Row& row : rows) {
    ASSERT_EQ(row.size(), 2U) << row[0];
    EXPECT_FALSE(row[1].empty()) << row[0];
  }
}

TEST(StabilityPage, GivesTheAlbedosOfTheQuadrature) {
  const std::map<std::string, Row> rows = cases_of_page();
  for (const EnergyCase& one : energy_cases()) {
    const Row& row = rows.at(one.id);
    const auto albedos = albedos_of(one);
    for (std::size_t k = 0; k < albedos.size(); ++k) {
      EXPECT_NEAR(std::stod(row[1 + k]), albedos[k], 0.0051) << one.id << " at " << kEnergyAnglesDeg[k];
    }
    EXPECT_EQ(row[1 + albedos.size()].starts_with("at most 1"), one.promises) << one.id;
  }
}

}  // namespace
}  // namespace brdfit::stability
