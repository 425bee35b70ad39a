// A CSV of `brdfit cost`, and what its sentences say, anew from it.
#ifndef BRDFIT_TESTS_COST_CSV_H_
#define BRDFIT_TESTS_COST_CSV_H_

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "cli/cost/cost_point.h"
#include "io/json.h"
#include "tests/cli_fixture.h"

namespace brdfit::cli {

using Row = std::map<std::string, std::string>;

inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

inline std::vector<Row> read_csv(const std::filesystem::path& file) {
  std::istringstream lines(tests::read_text(file));
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> heading = cells_of(line);
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), heading.size()) << line;
    Row& row = rows.emplace_back();
    for (std::size_t k = 0; k < heading.size(); ++k) row[heading[k]] = cells[k];
  }
  return rows;
}

inline double number(const Row& row, const std::string& key) {
  return row.at(key).empty() ? kNotMeasured : std::stod(row.at(key));
}

// The numbers of a sentence, anew from the CSV: by formulas of this test, not of the program.
class Rederive {
 public:
  explicit Rederive(const std::vector<Row>& rows) {
    for (const Row& row : rows) by_name_[row.at("name")] = &row;
  }

  // What a number in a sentence may be off by: half of its last digit.
  static double half_digit(const std::string& text) {
    const std::size_t point = text.find('.');
    return point == std::string::npos ? 0.5
                                      : 0.5 * std::pow(10.0, -static_cast<double>(text.size() - point - 1));
  }
  static void expect_number(const std::string& text, double value, const std::string& sentence) {
    EXPECT_NEAR(std::stod(text), value, half_digit(text) * 1.000001) << sentence;
  }

  double error(const std::string& name) const {
    const Row& row = *by_name_.at(name);
    return number(row, row.at("leading_error"));
  }
  double share(const std::string& a, const std::string& b) const { return 100.0 * error(b) / error(a); }
  double ratio(const std::string& a, const std::string& b, const std::string& what) const {
    return number(*by_name_.at(a), what) / number(*by_name_.at(b), what);
  }

  // "0.40x its run-time cost", "about its time to fit".
  void expect_ratio(const std::string& text, const std::string& a, const std::string& b,
                    const std::string& what, const std::string& sentence) const {
    if (text == "about") {
      const auto interval = [&](const std::string& name) {
        const Row& row = *by_name_.at(name);
        const double width = number(row, what + "_high") - number(row, what + "_low");
        return 1.57 * width / std::sqrt(number(row, what + "_repeats"));
      };
      EXPECT_LE(std::abs(number(*by_name_.at(a), what) - number(*by_name_.at(b), what)),
                interval(a) + interval(b))
          << sentence;
      return;
    }
    expect_number(text.substr(0, text.size() - 1), ratio(a, b, what), sentence);
  }

 private:
  std::map<std::string, const Row*> by_name_;
};

// Checks every sentence that compares points or names the best. Returns how many there were.
inline int expect_comparisons_follow(const std::vector<Row>& table, const io::Json& json) {
  const Rederive from(table);
  const std::regex reaches(
      R"((.*) reaches ([0-9.]+)% of the accuracy of (.*) at (\S+) its run-time cost and (\S+) its time to (?:fit|bake)\.)");
  const std::regex pays(
      R"(For [0-9.]+% of the accuracy of (.*) pay (\S+) its (run-time cost|time to (?:fit|bake)): (.*) \(([0-9.]+)% of it, .*\)\.)");
  const std::regex without(
      R"(Without (\S+) the error is ([0-9.]+)% (higher|lower), at (\S+) the run-time cost\.)");
  const std::regex least(R"(The least error, (\S+) \(.*\), is that of .*)");
  int compared = 0;
  for (const io::Json& sentence : json["sentences"]) {
    const std::string text = sentence["text"];
    const std::vector<std::string> points = sentence["points"];
    std::smatch found;
    if (std::regex_match(text, found, reaches)) {
      EXPECT_EQ(points, (std::vector<std::string>{found[1], found[3]}));
      Rederive::expect_number(found[2], from.share(found[1], found[3]), text);
      from.expect_ratio(found[4], found[1], found[3], "evaluation_ns", text);
      from.expect_ratio(found[5], found[1], found[3], "make_seconds", text);
    } else if (std::regex_match(text, found, pays)) {
      Rederive::expect_number(found[5], from.share(found[4], found[1]), text);
      from.expect_ratio(found[2], found[4], found[1],
                        found[3] == "run-time cost" ? "evaluation_ns" : "make_seconds", text);
    } else if (std::regex_match(text, found, without)) {
      Rederive::expect_number(found[2],
                              std::abs(100.0 * (from.error(points[0]) / from.error(points[1]) - 1.0)), text);
      from.expect_ratio(found[4], points[0], points[1], "evaluation_ns", text);
    } else if (std::regex_match(text, found, least)) {
      EXPECT_NEAR(std::stod(found[1]), from.error(points[0]), 0.005 * from.error(points[0])) << text;
      for (const Row& row : table) {
        EXPECT_TRUE(row.at("sweep") == "device" || from.error(points[0]) <= from.error(row.at("name")))
            << text;
      }
    } else {
      continue;
    }
    ++compared;
  }
  return compared;
}

}  // namespace brdfit::cli

#endif  // BRDFIT_TESTS_COST_CSV_H_
