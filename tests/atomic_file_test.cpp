// Files appear whole or not at all.
#include "io/atomic_file.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <string>

#include "io/error.h"
#include "tests/temp_folder.h"

namespace brdfit::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::read_text;
using tests::TempFolder;
using tests::write_text;

// The message of the IoError that work throws, which must be about the output.
template <typename Work>
std::string message_of(const Work& work) {
  try {
    work();
  } catch (const IoError& error) {
    EXPECT_EQ(error.side(), IoError::Side::kOutput);
    return error.what();
  }
  return "no error";
}

TEST(AtomicFile, AppearsOnlyWithTheCommit) {
  const TempFolder folder;
  AtomicFile file(folder / "out");
  file.write("half ");
  file.write(std::as_bytes(std::span("and half", 8)));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  file.commit();
  EXPECT_EQ(read_text(folder / "out"), "half and half");
  EXPECT_THAT(folder.names(), ElementsAre("out"));
}

TEST(AtomicFile, LeavesNothingBehindWithoutACommit) {
  const TempFolder folder;
  { AtomicFile(folder / "out").write("half"); }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(AtomicFile, KeepsTheOldFileUntilTheCommit) {
  const TempFolder folder;
  write_text(folder / "out", "old");
  { AtomicFile(folder / "out").write("new"); }
  EXPECT_EQ(read_text(folder / "out"), "old");
  AtomicFile file(folder / "out");
  file.write("new");
  file.commit();
  EXPECT_EQ(read_text(folder / "out"), "new");
  EXPECT_THAT(folder.names(), ElementsAre("out"));
}

TEST(AtomicFile, TwoAtOnceDoNotMeet) {
  const TempFolder folder;
  AtomicFile one(folder / "one");
  AtomicFile two(folder / "two");
  one.write("1");
  two.write("2");
  one.commit();
  two.commit();
  EXPECT_EQ(read_text(folder / "one") + read_text(folder / "two"), "12");
}

TEST(AtomicFile, HasThePermissionsOfAnyNewFile) {
  const TempFolder folder;
  const mode_t mask = umask(027);
  {
    AtomicFile file(folder / "out");
    file.commit();
  }
  umask(mask);
  EXPECT_EQ(std::filesystem::status(folder / "out").permissions(), std::filesystem::perms{0640});
}

TEST(AtomicFile, AMissingFolderIsAnErrorAtOnce) {
  const TempFolder folder;
  const auto file = folder / "none/out";
  EXPECT_EQ(message_of([&] { AtomicFile{file}; }),
            file.string() +
                ": cannot be written: No such file or directory (expected a place that can be written "
                "to); make the folder first");
}

TEST(AtomicFile, AFolderOrADeviceIsNotReplaced) {
  const TempFolder folder;
  EXPECT_EQ(message_of([&] { AtomicFile{folder.path()}; }),
            folder.path().string() + ": is a directory (expected a file name); name a file in it");
  const auto pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(message_of([&] { AtomicFile{pipe}; }),
            pipe.string() + ": is not a regular file (expected a file name); write to a file instead");
  EXPECT_THAT(folder.names(), ElementsAre("pipe"));
}

// A limit on the size of files stands in for a full disk: both end a write in the middle.
TEST(AtomicFile, AFailedWriteLeavesNothingBehind) {
  const TempFolder folder;
  rlimit old = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small = {1000, old.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string message = message_of([&] {
    AtomicFile file(folder / "out");
    file.write(std::string(2000, 'x'));
    file.commit();
  });
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(message, HasSubstr("out: cannot be written: File too large"));
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(AtomicFile, AFailedRenameLeavesNothingBehind) {
  const TempFolder folder;
  const std::string message = message_of([&] {
    AtomicFile file(folder / "out");
    file.write("new");
    std::filesystem::create_directory(folder / "out");  // in the meantime
    file.commit();
  });
  EXPECT_THAT(message, HasSubstr("out: cannot be put in place: Is a directory"));
  EXPECT_THAT(folder.names(), ElementsAre("out"));
}

}  // namespace
}  // namespace brdfit::io
