// Parts of a run.
#include "cli/shard.h"

#include <charconv>

#include "cli/common.h"

namespace brdfit::cli {
namespace {

// A whole number at the front of the text, which is shortened by it; 0 where there is none.
int take_number(std::string_view& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return 0;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

}  // namespace

Shard parse_shard(const std::string& text) {
  std::string_view rest = text;
  Shard shard;
  shard.index = take_number(rest);
  const bool has_slash = rest.starts_with('/');
  if (has_slash) rest.remove_prefix(1);
  shard.count = take_number(rest);
  if (!has_slash || !rest.empty() || shard.index < 1 || shard.index > shard.count) {
    throw UsageError("--shard is \"" + text + "\", not I/N with I from 1 to N");
  }
  return shard;
}

std::vector<std::string> files_of_shard(const std::vector<std::string>& files, const Shard& shard) {
  std::vector<std::string> result;
  for (std::size_t k = static_cast<std::size_t>(shard.index - 1); k < files.size();
       k += static_cast<std::size_t>(shard.count)) {
    result.push_back(files[k]);
  }
  return result;
}

}  // namespace brdfit::cli
