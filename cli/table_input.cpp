// Timed loading of tables.
#include "cli/table_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace brdfit::cli {

LoadedTable load_table(const std::string& file, const io::MerlReadOptions& options,
                       const CommonOptions& common) {
  LoadedTable loaded;
  const Stopwatch watch;
  loaded.table = io::read_merl(file, options, &loaded.report);
  loaded.seconds = watch.seconds();
  if (loaded.report.non_finite_values > 0) {
    say(common, fmt::format("{}: {} values are not finite and count as unmeasured", file,
                            loaded.report.non_finite_values));
  }
  return loaded;
}

std::vector<std::string> table_files(const std::vector<std::string>& inputs) {
  std::vector<std::string> files;
  for (const std::string& input : inputs) {
    if (!std::filesystem::is_directory(input)) {
      files.push_back(input);
      continue;
    }
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(input)) {
      if (entry.path().extension() == ".binary") found.push_back(entry.path().string());
    }
    if (found.empty()) {
      throw io::IoError(io::IoError::Side::kInput, input, "holds no .binary file", "MERL-format tables");
    }
    std::ranges::sort(found);
    std::ranges::copy(found, std::back_inserter(files));
  }
  return files;
}

}  // namespace brdfit::cli
