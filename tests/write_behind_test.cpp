// Work behind its owner's back: one piece at a time, no error lost.
#include "cli/write_behind.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace brdfit::cli {
namespace {

TEST(WriteBehind, DoesOnePieceAtATimeInOrder) {
  std::vector<int> done;
  std::atomic<int> at_work{0};
  bool was_alone = true;
  {
    WriteBehind behind;
    for (int k = 0; k < 200; ++k) {
      behind.begin([&, k] {
        was_alone = was_alone && ++at_work == 1;
        done.push_back(k);
        --at_work;
      });
    }
  }
  EXPECT_TRUE(was_alone);
  ASSERT_EQ(done.size(), 200U);
  for (int k = 0; k < 200; ++k) EXPECT_EQ(done[static_cast<std::size_t>(k)], k);
}

TEST(WriteBehind, TellsAnErrorOnceBeforeAnythingElseBegins) {
  WriteBehind behind;
  bool has_begun = false;
  behind.begin([] { throw std::runtime_error("the disk is full"); });
  EXPECT_THROW(behind.begin([&] { has_begun = true; }), std::runtime_error);
  EXPECT_FALSE(has_begun);
  EXPECT_NO_THROW(behind.wait());
  behind.begin([&] { has_begun = true; });
  behind.wait();
  EXPECT_TRUE(has_begun);
}

TEST(WriteBehind, WaitsForItsWorkWhereItsOwnerLeavesWithAnError) {
  bool is_done = false;
  const auto leave = [&] {
    WriteBehind behind;
    behind.begin([&] {
      is_done = true;
      throw std::runtime_error("of the work");
    });
    throw std::logic_error("of the owner");
  };
  EXPECT_THROW(leave(), std::logic_error);
  EXPECT_TRUE(is_done);
}

}  // namespace
}  // namespace brdfit::cli
