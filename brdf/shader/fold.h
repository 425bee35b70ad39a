// Branches of kernel code on values that are known, decided.
#ifndef BRDFIT_BRDF_SHADER_FOLD_H_
#define BRDFIT_BRDF_SHADER_FOLD_H_

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace brdfit::shader {

using KnownValues = std::map<std::string, int, std::less<>>;

// Code in which every `if` on known values, `(a & B) != 0` or `a == B`, is replaced by the branch that is
// taken. What follows a branch that returns is left out. Throws std::invalid_argument at an `if` of another
// form: kernels branch on options alone.
std::string fold_branches(std::string code, const KnownValues& values);

// A word of code: an identifier or a number, and what it stands for.
struct Word {
  std::string text;
  bool is_member = false;  // behind a dot
  bool is_called = false;  // before a parenthesis
};

// Code with a function applied to every word outside of comments.
std::string replace_words(std::string_view code, const std::function<std::string(const Word&)>& with);

// Code without the parentheses of the macro, or with them where its argument is more than a word, a number
// or a call: MACRO(x) is x, MACRO(a + b) is (a + b).
std::string unwrap_macro(std::string code, std::string_view macro);

// Where the bracket that opens at a place closes. Throws std::invalid_argument where none does.
std::size_t closing(std::string_view code, std::size_t open);

}  // namespace brdfit::shader

#endif  // BRDFIT_BRDF_SHADER_FOLD_H_
