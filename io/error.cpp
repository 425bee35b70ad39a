// Messages that quote what files hold.
#include "io/error.h"

#include <utility>

namespace brdfit::io {
namespace {

// Long enough for the names of all parameters.
constexpr std::size_t kLongest = 900;

bool continues_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

std::string message_of(const std::string& file, const std::string& found, const std::string& expected,
                       const std::string& advice) {
  std::string message = plain_line(file) + ": " + plain_line(found);
  if (!expected.empty()) message += " (expected " + plain_line(expected) + ")";
  if (!advice.empty()) message += "; " + plain_line(advice);
  return message;
}

}  // namespace

std::string plain_line(std::string text) {
  if (text.size() > kLongest) {
    std::size_t end = kLongest;
    while (end > 0 && continues_character(text[end])) --end;
    text.resize(end);
    text += "...";
  }
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return text;
}

IoError::IoError(Side side, std::string file, std::string found, std::string expected, std::string advice)
    : std::runtime_error(message_of(file, found, expected, advice)),
      side_(side),
      file_(std::move(file)),
      found_(plain_line(std::move(found))),
      expected_(plain_line(std::move(expected))),
      advice_(plain_line(std::move(advice))) {}

}  // namespace brdfit::io
