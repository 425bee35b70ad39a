// Decoding of a stack's pictures with nothing else: what reading it costs at least, and whether it pays to
// keep decoded pixels.
#ifndef BRDFIT_IO_DECODE_FLOOR_H_
#define BRDFIT_IO_DECODE_FLOOR_H_

#include "io/stack_source.h"

namespace brdfit::io {

// Decodes every file of the stack (pictures, dark and flat frame, mask, normals, albedo) from top to bottom,
// in parallel over files, and throws the rows away. Throws
// IoError (kInput).
void decode_all(const StackSource& source);

// Whether a second pass is faster from a temporary file than from the pictures: where decoding takes work,
// and the decoded pixels fit into the memory that the system has to spare (it keeps the file there) and into
// the folder of temporary files.
bool pays_to_spill(const StackSource& source);

}  // namespace brdfit::io

#endif  // BRDFIT_IO_DECODE_FLOOR_H_
