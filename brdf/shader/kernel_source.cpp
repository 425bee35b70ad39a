// Cutting kernel headers into declarations. They are regular: blank lines between declarations, comments
// right above them, the dialect's macros around them.
#include "brdf/shader/kernel_source.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>
#include <stdexcept>

namespace brdfit::shader {
namespace {

struct Header {
  std::string_view name;
  std::string_view text;
};

constexpr Header kHeaders[] = {
#include "kernel_headers.inc"
};

std::string_view text_of(std::string_view name) {
  for (const Header& header : kHeaders) {
    if (header.name == name) return header.text;
  }
  throw std::invalid_argument("there is no kernel header " + std::string(name));
}

bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

// Lines between blank ones; preprocessor lines each by themselves.
std::vector<std::string> paragraphs(std::string_view text) {
  std::vector<std::string> found;
  std::istringstream lines{std::string(text)};
  std::string paragraph;
  const auto end = [&] {
    if (!paragraph.empty()) found.push_back(std::move(paragraph));
    paragraph.clear();
  };
  int depth = 0;
  for (std::string line; std::getline(lines, line);) {
    if (depth == 0 && line.empty()) {
      end();
      continue;
    }
    if (starts_with(line, "#")) {
      end();
      found.push_back(line);
      continue;
    }
    for (const char c : line) depth += c == '{' ? 1 : c == '}' ? -1 : 0;
    paragraph += line + "\n";
  }
  end();
  return found;
}

// The identifier that ends right before a place.
std::string word_before(std::string_view text, std::size_t end) {
  std::size_t begin = end;
  while (begin > 0 &&
         (std::isalnum(static_cast<unsigned char>(text[begin - 1])) != 0 || text[begin - 1] == '_'))
    --begin;
  return std::string(text.substr(begin, end - begin));
}

// Cuts leading comment lines and function macros off a paragraph. Of what is left the name is that of the
// struct, or the word before the parenthesis of the parameters.
bool parse(const std::string& paragraph, Declaration& out) {
  std::istringstream lines(paragraph);
  bool in_comment = true;
  for (std::string line; std::getline(lines, line);) {
    if (in_comment && starts_with(line, "//")) {
      out.comment += line + "\n";
      continue;
    }
    in_comment = false;
    const bool is_macro = line == "BRDF_FUNCTION" || line == "BRDF_REAL_FUNCTION" ||
                          line == "BRDF_GEO_FUNCTION" || starts_with(line, "BRDF_NAMESPACE");
    if (!is_macro) out.text += line + "\n";
  }
  if (out.text.empty()) return false;
  for (const std::string_view macro : {"BRDF_REAL_STRUCT(", "BRDF_GEO_STRUCT("}) {
    if (!starts_with(out.text, macro)) continue;
    const std::size_t close = out.text.find(')');
    out.kind = Declaration::Kind::kStruct;
    out.name = out.text.substr(macro.size(), close - macro.size());
    return true;
  }
  // A result type OF_REAL(Name) has a parenthesis of its own.
  std::size_t from = 0;
  if (starts_with(out.text, "OF_")) from = out.text.find(')') + 1;
  out.kind = Declaration::Kind::kFunction;
  out.name = word_before(out.text, out.text.find('(', from));
  return true;
}

// #define NAME value, but for include guards.
bool parse_constant(const std::string& line, Declaration& out) {
  std::istringstream words(line);
  std::string define;
  words >> define >> out.name >> out.text;
  out.kind = Declaration::Kind::kConstant;
  return define == "#define" && !out.text.empty();
}

void add_header(std::string_view name, std::set<std::string, std::less<>>& seen,
                std::vector<Declaration>& out) {
  // Of the dialect only what it adds to GLSL.
  if (name == "lang.h") name = "glsl_float.h";
  if (!seen.emplace(name).second) return;
  for (const std::string& paragraph : paragraphs(text_of(name))) {
    if (starts_with(paragraph, "#include")) {
      const std::size_t quote = paragraph.find('"') + 1;
      add_header(paragraph.substr(quote, paragraph.rfind('"') - quote), seen, out);
      continue;
    }
    Declaration declaration;
    const bool is_one =
        starts_with(paragraph, "#") ? parse_constant(paragraph, declaration) : parse(paragraph, declaration);
    if (is_one) out.push_back(std::move(declaration));
  }
}

}  // namespace

std::vector<Declaration> kernel_declarations(std::span<const std::string_view> headers) {
  std::set<std::string, std::less<>> seen;
  std::vector<Declaration> out;
  for (const std::string_view header : headers) add_header(header, seen, out);
  return out;
}

}  // namespace brdfit::shader
