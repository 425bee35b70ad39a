// Synthetic stacks as files: photographs, manifest, and the answers.
#ifndef BRDFIT_DATA_SYNTHETIC_STACK_FILES_H_
#define BRDFIT_DATA_SYNTHETIC_STACK_FILES_H_

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "data/synthetic/stack_recipe.h"

namespace brdfit::synthetic {

// The files that a recipe makes, the manifest (NAME.olat.json or NAME.lp) last.
std::vector<std::filesystem::path> stack_paths(const StackRecipe& recipe,
                                               const std::filesystem::path& folder);

// Writes them into a folder that exists: a photograph per light; the manifest; for a sphere its mask; the
// true normals and albedo (EXR); with a residual its amplitudes (EXR, channels lobe00.Y ...) and its lobes
// (NAME.truth.json). exr photographs hold floats, jpg 8 bits, others 16 bits; what an encoding cannot hold is
// cut to its range, as a camera does. progress: called after each photograph with their number so far; may
// throw to stop. Throws io::IoError (kOutput), and std::invalid_argument if the recipe is not valid.
void write_stack(const StackRecipe& recipe, const std::filesystem::path& folder,
                 const std::function<void(std::size_t)>& progress = {});

}  // namespace brdfit::synthetic

#endif  // BRDFIT_DATA_SYNTHETIC_STACK_FILES_H_
