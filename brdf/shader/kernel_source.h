// The kernel headers as text, cut into declarations: what shaders for other programs are made from.
#ifndef BRDFIT_BRDF_SHADER_KERNEL_SOURCE_H_
#define BRDFIT_BRDF_SHADER_KERNEL_SOURCE_H_

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace brdfit::shader {

// One struct, function or constant of the kernel, as it is written there.
struct Declaration {
  enum class Kind { kStruct, kFunction, kConstant };
  Kind kind = Kind::kFunction;
  std::string name;
  std::string comment;  // the lines above it, each with its //; may be empty
  std::string text;     // of a constant: its value
};

// All declarations of some kernel headers and of those that they include, each after what it uses.
// headers: names in brdf/kernel, such as "callisto.h". Throws std::invalid_argument if there is no such
// header.
std::vector<Declaration> kernel_declarations(std::span<const std::string_view> headers);

}  // namespace brdfit::shader

#endif  // BRDFIT_BRDF_SHADER_KERNEL_SOURCE_H_
