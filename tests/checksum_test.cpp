// The checksum against values of the reference implementation, and that it sees every byte.
#include "io/checksum.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

namespace brdfit::io {
namespace {

std::uint64_t of_text(const std::string& text, std::uint64_t seed = 0) {
  return checksum(std::as_bytes(std::span(text)), seed);
}

TEST(Checksum, IsThatOfTheReference) {
  EXPECT_EQ(of_text(""), 0xEF46DB3751D8E999U);
  EXPECT_EQ(of_text("a"), 0xD24EC4F1A98C6E5BU);
  EXPECT_EQ(of_text("abc"), 0x44BC2CF5AD770999U);
  EXPECT_EQ(of_text("Nobody inspects the spammish repetition"), 0xFBCEA83C8A378BF1U);
}

TEST(Checksum, ChangesWithEveryBitAndLength) {
  std::set<std::uint64_t> seen;
  std::size_t count = 0;
  for (const std::size_t size : {1U, 3U, 4U, 7U, 8U, 31U, 32U, 33U, 63U, 100U}) {
    std::vector<std::byte> bytes(size);
    seen.insert(checksum(bytes));
    ++count;
    for (std::size_t bit = 0; bit < 8 * size; ++bit) {
      bytes[bit / 8] ^= std::byte{1} << (bit % 8);
      seen.insert(checksum(bytes));
      ++count;
      bytes[bit / 8] ^= std::byte{1} << (bit % 8);
    }
  }
  EXPECT_EQ(seen.size(), count);
}

}  // namespace
}  // namespace brdfit::io
