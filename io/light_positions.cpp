// Light files of the RTI community.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "io/error.h"
#include "io/input_file.h"
#include "io/stack_picture.h"
#include "io/stack_source.h"

namespace brdfit::io {
namespace {

namespace fs = std::filesystem;
using Side = IoError::Side;

constexpr std::size_t kLargestFile = std::size_t{16} << 20;
constexpr std::string_view kBlank = " \t\r\v\f";

struct Line {
  std::size_t number;
  std::string_view text;
};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

// Lines that hold anything.
std::vector<Line> lines_of(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::vector<Line> lines;
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    ++number;
    const std::string_view line = trimmed(text.substr(0, end));
    if (!line.empty()) lines.push_back({number, line});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

template <class Number>
std::optional<Number> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number value{};
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || result.ec != std::errc{} || result.ptr != text.data() + text.size()) return {};
  return value;
}

// Takes the last word off a line.
std::string_view take_last_word(std::string_view& text) {
  const std::size_t blank = text.find_last_of(kBlank);
  const std::size_t begin = blank == std::string_view::npos ? 0 : blank + 1;
  const std::string_view word = text.substr(begin);
  text = trimmed(text.substr(0, begin));
  return word;
}

// Shortened and fit for one line of a terminal.
std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string result(text.substr(0, kLongest));
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7f) c = '?';
  }
  return result + (text.size() > kLongest ? "..." : "");
}

class LightFile {
 public:
  explicit LightFile(const fs::path& file) : file_(file), name_(file.string()) {}

  StackSource read() const {
    const InputFile input(file_, "a light file (.lp)");
    if (input.size() > kLargestFile)
      fail("it is too large for a light file", "a count and one line a picture");
    std::string text(input.size(), '\0');
    input.read_at(0, std::as_writable_bytes(std::span(text)));
    const std::vector<Line> lines = lines_of(text);
    const long long count = lines.empty() ? -1 : number_in<long long>(lines[0].text).value_or(-1);
    if (count < 1) {
      fail(lines.empty() ? "it is empty" : fmt::format("the first line is '{}'", shown(lines[0].text)),
           "the number of pictures");
    }
    if (static_cast<std::size_t>(count) != lines.size() - 1) {
      fail(fmt::format("the first line says {} pictures, and {} follow", count, lines.size() - 1),
           "as many lines as the first one says");
    }
    StackSource source;
    source.file = file_;
    source.name = file_.stem().string();
    for (std::size_t k = 1; k < lines.size(); ++k) source.pictures.push_back(picture_of(lines[k]));
    settle_pictures(source.pictures, name_);
    return source;
  }

 private:
  StackPicture picture_of(const Line& line) const {
    const std::string where = fmt::format("line {}", line.number);
    std::string_view rest = line.text;
    const auto z = number_in<double>(take_last_word(rest));
    const auto y = number_in<double>(take_last_word(rest));
    const auto x = number_in<double>(take_last_word(rest));
    if (!x || !y || !z || rest.empty()) {
      fail(fmt::format("{} is '{}'", where, shown(line.text)), "a picture's name and the light's x y z");
    }
    StackPicture picture;
    picture.light.direction = light_direction({*x, *y, *z}, name_, where);
    picture.file = find_picture(std::string(rest), where);
    return picture;
  }

  fs::path find_picture(std::string written, const std::string& where) const {
    std::replace(written.begin(), written.end(), '\\', '/');
    const fs::path as_written = file_.parent_path() / written;
    const fs::path beside = file_.parent_path() / fs::path(written).filename();
    if (!is_file(as_written) && is_file(beside)) return beside;
    require_file(as_written, name_, where, "the picture");
    return as_written;
  }

  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw IoError(Side::kInput, name_, found, expected);
  }

  fs::path file_;
  std::string name_;
};

}  // namespace

StackSource read_light_positions(const fs::path& file) {
  return LightFile(file).read();
}

}  // namespace brdfit::io
