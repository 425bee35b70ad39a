// The error measures have one list; what is made from it agrees with it.
#include "cli/measure_names.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "cli/result_json.h"
#include "cli/result_table.h"

namespace brdfit::cli {
namespace {

TEST(MeasureNames, KeysTitlesAndValuesAreAllDifferent) {
  std::set<std::string> keys, titles;
  fit::Measures measures;
  for (std::size_t k = 0; k < kMeasures.size(); ++k) {
    keys.insert(kMeasures[k].key);
    titles.insert(kMeasures[k].title);
    measures.*kMeasures[k].value = static_cast<double>(k + 1);
  }
  EXPECT_EQ(keys.size(), kMeasures.size());
  EXPECT_EQ(titles.size(), kMeasures.size());
  for (std::size_t k = 0; k < kMeasures.size(); ++k) {
    EXPECT_EQ(measures.*kMeasures[k].value, static_cast<double>(k + 1));
    EXPECT_EQ(measures_to_json(measures)[kMeasures[k].key], static_cast<double>(k + 1));
  }
}

// Tables put the measures into these columns by their places.
TEST(MeasureNames, ColumnsOfARunAreThoseOfSliceAndTableInTurn) {
  ASSERT_EQ(kMeasureColumns.size(), 2 * kMeasures.size() + 2);
  for (std::size_t k = 0; k < 2 * kMeasures.size(); ++k) {
    const MeasureColumn& column = kMeasureColumns[k];
    EXPECT_STREQ(column.group, k % 2 == 0 ? "slice" : "table");
    EXPECT_STREQ(column.key, kMeasures[k / 2].key);
    EXPECT_EQ(std::string(column.group) + "_" + column.key, column.name);
  }
}

TEST(MeasureNames, TextsHaveTheDigitsOfTheMeasure) {
  EXPECT_EQ(measure_texts(kMeasures[0], 12.34, 6.0), "12.34|6.00");
  EXPECT_EQ(measure_texts(kMeasures[2], 0.25, 1e-9, " | "), "0.250 | 0.000");
  EXPECT_EQ(measure_text(kMeasures[5], 12345.0), "1.23e+04");
  EXPECT_EQ(sphere_text(2.0), "2.00");
}

}  // namespace
}  // namespace brdfit::cli
