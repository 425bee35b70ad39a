// Timed loading of tables.
#include "cli/table_input.h"

#include <fmt/format.h>

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

}  // namespace brdfit::cli
