// SHA-256 of files, against the published test vectors (FIPS 180-4, NIST examples).
#include "io/sha256.h"

#include <gtest/gtest.h>

#include <string>

#include "io/error.h"
#include "tests/temp_folder.h"

namespace brdfit::io {
namespace {

std::string digest_of(const std::string& bytes) {
  const tests::TempFolder folder;
  tests::write_text(folder / "bytes", bytes);
  return sha256_of_file(folder / "bytes");
}

TEST(Sha256, MeetsThePublishedVectors) {
  EXPECT_EQ(digest_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(digest_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(digest_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Sha256, ReadsFilesOfManyPieces) {
  EXPECT_EQ(digest_of(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, OfTextIsThatOfAFileWithIt) {
  for (const std::string& text : {std::string(), std::string("abc"), std::string(100000, 'x')}) {
    EXPECT_EQ(sha256_of_text(text), digest_of(text));
  }
}

TEST(Sha256, AFileThatIsNotThereIsAnError) {
  const tests::TempFolder folder;
  EXPECT_THROW(sha256_of_file(folder / "none"), IoError);
  EXPECT_THROW(sha256_of_file(folder.path()), IoError);
}

}  // namespace
}  // namespace brdfit::io
