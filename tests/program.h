// Runs the brdfit program as a shell would, and keeps what it said.
#ifndef BRDFIT_TESTS_PROGRAM_H_
#define BRDFIT_TESTS_PROGRAM_H_

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/temp_folder.h"

namespace brdfit::tests {

struct ProgramResult {
  int exit_code = -1;  // -1: ended by a signal
  std::string out;
  std::string err;
};

// arguments: a shell's words after the program's name; scratch: a folder for its output streams; before: what
// the shell is told before it ("cd DIR && LC_ALL=C").
inline ProgramResult run_brdfit(const std::string& arguments, const std::filesystem::path& scratch,
                                const std::string& before = "") {
  const std::string out = (scratch / "stdout.txt").string();
  const std::string err = (scratch / "stderr.txt").string();
  const std::string command =
      before + " " + std::string(BRDFIT_PROGRAM) + " " + arguments + " >'" + out + "' 2>'" + err + "'";
  const int status = std::system(command.c_str());
  ProgramResult result;
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  result.out = read_text(out);
  result.err = read_text(err);
  return result;
}

}  // namespace brdfit::tests

#endif  // BRDFIT_TESTS_PROGRAM_H_
