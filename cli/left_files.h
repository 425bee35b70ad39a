// Files of an asset that was overwritten by one with fewer of them.
#ifndef BRDFIT_CLI_LEFT_FILES_H_
#define BRDFIT_CLI_LEFT_FILES_H_

#include <filesystem>
#include <vector>

namespace brdfit::cli {

// Textures and pictures that an asset's JSON names as its own, in its folder: names that begin as the asset's
// does and do not lead out of it. Empty where there is no such file, or it cannot be read.
std::vector<std::filesystem::path> files_named_by(const std::filesystem::path& json_file);

// Removes those of the files that the JSON, written anew, does not name; then the folder of panels, if it is
// empty.
void remove_left_files(const std::filesystem::path& json_file,
                       const std::vector<std::filesystem::path>& before);

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_LEFT_FILES_H_
