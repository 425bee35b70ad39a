// Every input that fuzzers kept, through the harness that it was made for: those that once broke something
// too.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "tests/fuzz/harness.h"

namespace brdfit::fuzz {

// In lists of tests, in place of bytes that are addresses.
void PrintTo(const Harness& harness, std::ostream* out) {
  *out << harness.name;
}

namespace {

namespace fs = std::filesystem;

// Files of tests/fuzz/FOLDER/NAME, sorted; none where there is no such folder.
std::vector<fs::path> inputs(const char* folder, std::string_view name) {
  const fs::path where = fs::path(BRDFIT_FUZZ_FOLDER) / folder / name;
  std::vector<fs::path> files;
  if (fs::is_directory(where)) files.assign(fs::directory_iterator(where), {});
  std::sort(files.begin(), files.end());
  return files;
}

bool run(const Harness& harness, const fs::path& file) {
  const std::string text = tests::read_text(file);
  return harness.run({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

class FuzzCorpus : public testing::TestWithParam<Harness> {};

TEST_P(FuzzCorpus, EveryInputIsRefusedInOneLineOrComesBackUnchanged) {
  int accepted = 0;
  int refused = 0;
  for (const fs::path& file : inputs("corpus", GetParam().name)) {
    SCOPED_TRACE(file.filename());
    ASSERT_NO_THROW(++(run(GetParam(), file) ? accepted : refused));
  }
  // Otherwise the inputs no longer reach what they were kept for.
  EXPECT_GT(accepted, 0);
  EXPECT_GT(refused, 0);
}

INSTANTIATE_TEST_SUITE_P(Readers, FuzzCorpus, testing::ValuesIn(kHarnesses),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(FuzzFinds, WhatOnceBrokeAReaderDoesNotNow) {
  int finds = 0;
  for (const Harness& harness : kHarnesses) {
    for (const fs::path& file : inputs("finds", harness.name)) {
      SCOPED_TRACE(file);
      EXPECT_NO_THROW(run(harness, file));
      ++finds;
    }
  }
  EXPECT_GT(finds, 0);
}

}  // namespace
}  // namespace brdfit::fuzz
