// The least that loading a table can cost: the unit of the fit's timings.
#ifndef BRDFIT_CLI_LOAD_FLOOR_H_
#define BRDFIT_CLI_LOAD_FLOOR_H_

#include <filesystem>

namespace brdfit::cli {

// Seconds to read a MERL file's bytes and convert its values to float, each into fresh memory, on one thread
// and without any check. Throws IoError (kInput) when the file cannot be read.
double load_floor_seconds(const std::filesystem::path& file);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_LOAD_FLOOR_H_
