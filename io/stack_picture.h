// What both kinds of stack files ask of their pictures and lights.
#ifndef BRDFIT_IO_STACK_PICTURE_H_
#define BRDFIT_IO_STACK_PICTURE_H_

#include <filesystem>
#include <string>
#include <vector>

#include "io/stack_source.h"

namespace brdfit::io {

// A direction made unit. where: the place in the file, for messages ("'images[3].direction'", "line 4").
// Throws IoError (kInput): not finite, of no length, below the surface plane.
Vec3 light_direction(const Vec3& direction, const std::string& file, const std::string& where);

// Sorts pictures by name and names their lights. Throws IoError (kInput) when a picture is listed twice.
void settle_pictures(std::vector<StackPicture>& pictures, const std::string& file);

// Whether a regular file has that name.
bool is_file(const std::filesystem::path& wanted);

// Throws IoError (kInput) unless a regular file is there. what: "the picture", "the mask".
void require_file(const std::filesystem::path& wanted, const std::string& file, const std::string& where,
                  const std::string& what);

}  // namespace brdfit::io

#endif  // BRDFIT_IO_STACK_PICTURE_H_
