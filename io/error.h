// The one error that reading and writing files throws.
#ifndef BRDFIT_IO_ERROR_H_
#define BRDFIT_IO_ERROR_H_

#include <stdexcept>
#include <string>

namespace brdfit::io {

// A text for one line of a terminal: control characters, which files may hold in their strings, become '?',
// and what is longer than a screen is cut, at a whole character.
std::string plain_line(std::string text);

// What is wrong with a file: its name, what was found, what was expected, and what to do about it, each as
// plain_line() has it. what() is all of it: "FILE: FOUND (expected EXPECTED); ADVICE".
class IoError : public std::runtime_error {
 public:
  // Whether the input cannot be used, or writing failed: they end in different exit codes.
  enum class Side { kInput, kOutput };

  IoError(Side side, std::string file, std::string found, std::string expected, std::string advice = "");

  Side side() const { return side_; }
  // As it was given, control characters and all.
  const std::string& file() const { return file_; }
  const std::string& found() const { return found_; }
  const std::string& expected() const { return expected_; }
  const std::string& advice() const { return advice_; }

 private:
  Side side_;
  std::string file_;
  std::string found_;
  std::string expected_;
  std::string advice_;
};

}  // namespace brdfit::io

#endif  // BRDFIT_IO_ERROR_H_
