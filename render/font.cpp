// FreeType is used directly: the text functions of OpenImageIO 2.4, which are built on it, keep no more than
// six bits of a character outside ASCII, so that a degree sign becomes a zero.
#include "render/font.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>
#include <tuple>

namespace brdfit::render {
namespace {

using Path = std::filesystem::path;

// The usual folders of fonts; those that the user names come first.
std::vector<Path> font_folders() {
  std::vector<Path> folders;
  if (const char* named = std::getenv("BRDFIT_FONTS")) {
    const std::string_view list(named);
    for (std::size_t begin = 0; begin <= list.size();) {
      const std::size_t end = std::min(list.find(':', begin), list.size());
      if (end > begin) folders.emplace_back(list.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  if (const char* home = std::getenv("HOME")) {
    folders.push_back(Path(home) / ".fonts");
    folders.push_back(Path(home) / ".local/share/fonts");
  }
  folders.emplace_back("/usr/local/share/fonts");
  folders.emplace_back("/usr/share/fonts");
  return folders;
}

std::string find_font(const std::string& name) {
  std::error_code ignored;
  for (const Path& folder : font_folders()) {
    for (const char* inner : {"", "truetype/dejavu", "dejavu", "TTF", "dejavu-sans-fonts"}) {
      const Path file = folder / inner / name;
      if (std::filesystem::is_regular_file(file, ignored)) return file.string();
    }
  }
  throw std::runtime_error("the font " + name +
                           " was not found, without which pictures have no text; on Debian: apt-get install "
                           "fonts-dejavu-core, or name its folder in BRDFIT_FONTS");
}

[[noreturn]] void fail(const std::string& what, const std::string& font, FT_Error error) {
  throw std::runtime_error(what + " with " + font + ": FreeType's error " + std::to_string(error));
}

// One weight of the font, open for the life of the program.
class Face {
 public:
  explicit Face(std::string file) : file_(std::move(file)) {
    if (const FT_Error error = FT_Init_FreeType(&library_)) fail("text cannot be drawn", file_, error);
    if (const FT_Error error = FT_New_Face(library_, file_.c_str(), 0, &face_)) {
      FT_Done_FreeType(library_);
      fail("text cannot be drawn", file_, error);
    }
  }
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;
  ~Face() {
    FT_Done_Face(face_);
    FT_Done_FreeType(library_);
  }

  Glyph render(char32_t c, int size_px) {
    if (const FT_Error error = FT_Set_Pixel_Sizes(face_, 0, static_cast<FT_UInt>(size_px))) {
      fail("text of that size cannot be drawn", file_, error);
    }
    if (const FT_Error error = FT_Load_Char(face_, c, FT_LOAD_RENDER)) {
      fail("a character cannot be drawn", file_, error);
    }
    const FT_GlyphSlot slot = face_->glyph;
    Glyph glyph;
    glyph.advance = static_cast<int>((slot->advance.x + 32) / 64);
    glyph.left = slot->bitmap_left;
    glyph.top = -slot->bitmap_top;
    glyph.width = static_cast<int>(slot->bitmap.width);
    glyph.height = static_cast<int>(slot->bitmap.rows);
    for (int y = 0; y < glyph.height; ++y) {
      const unsigned char* row = slot->bitmap.buffer + std::ptrdiff_t{y} * slot->bitmap.pitch;
      glyph.coverage.insert(glyph.coverage.end(), row, row + glyph.width);
    }
    return glyph;
  }

 private:
  std::string file_;
  FT_Library library_ = nullptr;
  FT_Face face_ = nullptr;
};

// Callers hold the lock of the kept glyphs.
Face& face_of(FontWeight weight) {
  static Face regular(find_font("DejaVuSans.ttf"));
  static Face bold(find_font("DejaVuSans-Bold.ttf"));
  return weight == FontWeight::kBold ? bold : regular;
}

// The code point at `begin`, and where the next one begins.
std::pair<char32_t, std::size_t> decode_at(std::string_view text, std::size_t begin) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char first = byte(begin);
  if (first < 0x20 || first == 0x7F) return {U' ', begin + 1};
  if (first < 0x80) return {first, begin + 1};
  const std::size_t length = first >= 0xF0 && first < 0xF5 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || begin + length > text.size()) return {U'\uFFFD', begin + 1};
  char32_t c = first & (0xFFU >> (length + 1));
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(begin + k) & 0xC0) != 0x80) return {U'\uFFFD', begin + 1};
    c = (c << 6) | (byte(begin + k) & 0x3FU);
  }
  // Nor is UTF-8 what a shorter form could say, half of a surrogate pair, or what is beyond the last plane.
  const char32_t least = length == 4 ? 0x10000 : length == 3 ? 0x800 : 0x80;
  if (c < least || (c >= 0xD800 && c < 0xE000) || c > 0x10FFFF) return {U'\uFFFD', begin + 1};
  return {c, begin + length};
}

}  // namespace

std::size_t next_character(std::string_view text, std::size_t begin) {
  return decode_at(text, begin).second;
}

std::u32string decode_utf8(std::string_view text) {
  std::u32string points;
  for (std::size_t at = 0; at < text.size();) {
    const auto [point, next] = decode_at(text, at);
    points.push_back(point);
    at = next;
  }
  return points;
}

std::vector<const Glyph*> glyphs_of(std::string_view text, int size_px, FontWeight weight) {
  if (size_px < 1) throw std::invalid_argument("text has a size of at least 1 pixel");
  static std::mutex mutex;
  // Nodes of a map stay where they are.
  static std::map<std::tuple<char32_t, int, FontWeight>, Glyph> kept;
  std::vector<const Glyph*> glyphs;
  const std::lock_guard lock(mutex);
  for (const char32_t c : decode_utf8(text)) {
    const auto key = std::make_tuple(c, size_px, weight);
    auto found = kept.find(key);
    if (found == kept.end()) found = kept.emplace(key, face_of(weight).render(c, size_px)).first;
    glyphs.push_back(&found->second);
  }
  return glyphs;
}

}  // namespace brdfit::render
