// Rewriting kernel code as text.
#include "brdf/shader/fold.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace brdfit::shader {
namespace {

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::size_t skip_space(std::string_view code, std::size_t at) {
  while (at < code.size() && std::isspace(static_cast<unsigned char>(code[at])) != 0) ++at;
  return at;
}

bool word_at(std::string_view code, std::size_t at, std::string_view word) {
  return code.substr(at, word.size()) == word && (at == 0 || !is_word(code[at - 1])) &&
         (at + word.size() >= code.size() || !is_word(code[at + word.size()]));
}

std::size_t find_word(std::string_view code, std::string_view word, std::size_t from) {
  for (std::size_t at = code.find(word, from); at != std::string_view::npos; at = code.find(word, at + 1)) {
    if (word_at(code, at, word)) return at;
  }
  return std::string_view::npos;
}

int value_of(const std::string& word, const KnownValues& values) {
  const auto found = values.find(word);
  if (found == values.end()) throw std::invalid_argument("a branch on " + word + ", which is not known");
  return found->second;
}

bool is_true(const std::string& condition, const KnownValues& values) {
  std::string text = condition;
  for (char& c : text) {
    if (c == '(' || c == ')') c = ' ';
  }
  std::istringstream words(text);
  std::string a;
  std::string operation;
  std::string b;
  words >> a >> operation >> b;
  if (operation == "==") return value_of(a, values) == value_of(b, values);
  if (operation == "&") return (value_of(a, values) & value_of(b, values)) != 0;
  throw std::invalid_argument("a branch on (" + condition + ")");
}

// A branch: what it holds, and where it ends.
struct Branch {
  std::string text;
  std::size_t end = 0;
};

std::string shifted_left(const std::string& block) {
  std::istringstream lines(block);
  std::string out;
  for (std::string line; std::getline(lines, line);) {
    const bool has_indent = line.size() >= 2 && line[0] == ' ' && line[1] == ' ';
    out += (has_indent ? line.substr(2) : line) + "\n";
  }
  return out;
}

Branch branch_at(const std::string& code, std::size_t at) {
  if (code[at] == '{') {
    const std::size_t end = closing(code, at);
    std::string inside = shifted_left(code.substr(at + 1, end - at - 1));
    const std::size_t first = inside.find_first_not_of(" \n");
    inside = first == std::string::npos ? "" : inside.substr(first);
    while (!inside.empty() && std::isspace(static_cast<unsigned char>(inside.back())) != 0) inside.pop_back();
    return {std::move(inside), end + 1};
  }
  const std::size_t end = code.find(';', at);
  return {code.substr(at, end + 1 - at), end + 1};
}

// Where the block that holds a place ends: at its closing brace.
std::size_t end_of_enclosing(const std::string& code, std::size_t at) {
  int depth = 0;
  for (; at < code.size(); ++at) {
    if (code[at] == '{') ++depth;
    if (code[at] == '}' && depth-- == 0) return at;
  }
  return code.size();
}

// Replaces the code in [begin, end), and takes the line with it where nothing is left on it.
void put(std::string& code, std::size_t begin, std::size_t end, const std::string& with) {
  if (with.empty()) {
    while (begin > 0 && code[begin - 1] == ' ') --begin;
    if (begin > 0 && code[begin - 1] == '\n') --begin;
  }
  code.replace(begin, end - begin, with);
}

}  // namespace

std::size_t closing(std::string_view code, std::size_t open) {
  const char opens = code[open];
  const char closes = opens == '(' ? ')' : '}';
  int depth = 0;
  for (std::size_t at = open; at < code.size(); ++at) {
    if (code[at] == opens) ++depth;
    if (code[at] == closes && --depth == 0) return at;
  }
  throw std::invalid_argument("a bracket is not closed");
}

std::string fold_branches(std::string code, const KnownValues& values) {
  std::size_t at = 0;
  while ((at = find_word(code, "if", at)) != std::string::npos) {
    const std::size_t open = code.find('(', at);
    const std::size_t close = closing(code, open);
    const bool taken = is_true(code.substr(open + 1, close - open - 1), values);
    const Branch yes = branch_at(code, skip_space(code, close + 1));
    std::optional<Branch> no;
    if (const std::size_t next = skip_space(code, yes.end); word_at(code, next, "else")) {
      no = branch_at(code, skip_space(code, next + 4));
    }
    const std::string chosen = fold_branches(taken ? yes.text : no ? no->text : "", values);
    std::size_t end = no ? no->end : yes.end;
    if (find_word(chosen, "return", 0) != std::string::npos) {
      end = end_of_enclosing(code, end);
      put(code, at, end, chosen + "\n");
    } else {
      put(code, at, end, chosen);
    }
  }
  return code;
}

std::string replace_words(std::string_view code, const std::function<std::string(const Word&)>& with) {
  std::string out;
  for (std::size_t at = 0; at < code.size();) {
    if (code.substr(at, 2) == "//") {
      const std::size_t end = std::min(code.find('\n', at), code.size());
      out += code.substr(at, end - at);
      at = end;
    } else if (is_word(code[at])) {
      std::size_t end = at;
      while (end < code.size() && is_word(code[end])) ++end;
      const bool is_called = end < code.size() && code[end] == '(';
      out += with({std::string(code.substr(at, end - at)), at > 0 && code[at - 1] == '.', is_called});
      at = end;
    } else {
      out += code[at++];
    }
  }
  return out;
}

std::string unwrap_macro(std::string code, std::string_view macro) {
  std::size_t at = 0;
  while ((at = find_word(code, macro, at)) != std::string::npos) {
    const std::size_t open = at + macro.size();
    const std::size_t close = closing(code, open);
    std::string inside = code.substr(open + 1, close - open - 1);
    std::size_t word = 0;
    while (word < inside.size() && (is_word(inside[word]) || inside[word] == '.' || inside[word] == '-'))
      ++word;
    const bool is_call =
        word > 0 && word < inside.size() && inside[word] == '(' && closing(inside, word) + 1 == inside.size();
    if (word < inside.size() && !is_call) inside = "(" + inside + ")";
    code.replace(at, close + 1 - at, inside);
  }
  return code;
}

}  // namespace brdfit::shader
