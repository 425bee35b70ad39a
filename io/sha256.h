// SHA-256 of a file: the identity of an input in every result.
#ifndef BRDFIT_IO_SHA256_H_
#define BRDFIT_IO_SHA256_H_

#include <filesystem>
#include <string>
#include <string_view>

namespace brdfit::io {

// 64 lower-case hexadecimal digits. Throws IoError (kInput) when the file cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

// The same of bytes in memory.
std::string sha256_of_text(std::string_view text);

}  // namespace brdfit::io

#endif  // BRDFIT_IO_SHA256_H_
