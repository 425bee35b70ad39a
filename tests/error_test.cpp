// Messages that quote what files hold.
#include "io/error.h"

#include <gtest/gtest.h>

#include <string>

namespace brdfit::io {
namespace {

TEST(PlainLine, ControlCharactersBecomeQuestionMarks) {
  EXPECT_EQ(plain_line("a\nb\x1b[31mc\x7f"), "a?b?[31mc?");
  EXPECT_EQ(plain_line(std::string("a\0b", 3)), "a?b");
  EXPECT_EQ(plain_line("höher"), "höher");
}

TEST(PlainLine, CutsWhatIsLongAtAWholeCharacter) {
  const std::string whole(899, 'x');
  EXPECT_EQ(plain_line(whole), whole);
  EXPECT_EQ(plain_line(whole + "ö."), whole + "...");
  EXPECT_LT(plain_line(std::string(1U << 20U, '\x80')).size(), 1000U);
}

TEST(IoError, IsOneLineWhateverTheFileHolds) {
  const IoError error(IoError::Side::kInput, "a\nb", "is \"\r\"", "c\td", "\x01");
  EXPECT_STREQ(error.what(), "a?b: is \"?\" (expected c?d); ?");
  EXPECT_EQ(error.file(), "a\nb");
  EXPECT_EQ(error.found(), "is \"?\"");
}

}  // namespace
}  // namespace brdfit::io
