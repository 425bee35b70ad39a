// Shadow contours of a whole stack, in a pass of its own before the bake: in the photographs, and in what the
// bake renders.
#ifndef BRDFIT_CLI_CONTOUR_PASS_H_
#define BRDFIT_CLI_CONTOUR_PASS_H_

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>

#include "bake/contours.h"
#include "io/picture_maps.h"
#include "measured/image_stack.h"

namespace brdfit::cli {

struct ContourPassOptions {
  bake::ContourOptions contours;
  int strip_rows = 64;                               // read at once from the stack
  std::size_t memory_bytes = std::size_t{64} << 20;  // for looking at pictures, beside the strips
  std::filesystem::path folder;                      // of the temporary file; empty: that of temporary files
  std::function<void()> step;                        // called now and then; may throw to stop. May be empty
};

// Weights of all values by how far the shadow contours of a photograph and of its render lie apart. They are
// kept in a temporary file, a byte per texel and light, so that memory does not grow with the stack; beside
// them the file holds what was read, four bytes per texel and light.
//
// The render is Lambert's on the stack's normals and albedo, or on those of photometric stereo: it has
// attached shadows, and the cast ones of a shadow map where a picture has one.
class ContourPass {
 public:
  // Reads the stack once. shadows: maps per picture. Throws what the stack throws, and io::IoError (kOutput)
  // when there is no room.
  ContourPass(ImageStack& stack, io::PictureMaps shadows, const ContourPassOptions& options);
  ~ContourPass();

  // Multiplies the weights of a block of the stack. Where no contours differ it leaves the block as it is.
  void weigh(TexelBlock& block) const;

  // Values (texels under a light) that lost weight.
  std::size_t lowered() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace brdfit::cli

#endif  // BRDFIT_CLI_CONTOUR_PASS_H_
