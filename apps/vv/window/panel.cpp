// panel.cpp: Paints panels. No other file of vv includes FreeType and fontconfig.
#include "window/panel.h"

#include <algorithm>
#include <string_view>

#include <fontconfig/fontconfig.h>
#include <ft2build.h>
#include FT_FREETYPE_H

namespace vv {

std::string findFontFile(const char* family) {
  FcPattern* wanted = FcNameParse(reinterpret_cast<const FcChar8*>(family));
  if (!wanted) return {};
  FcConfigSubstitute(nullptr, wanted, FcMatchPattern);
  FcDefaultSubstitute(wanted);
  FcResult result;
  FcPattern* found = FcFontMatch(nullptr, wanted, &result);
  FcChar8* file = nullptr;
  std::string path;
  if (found && FcPatternGetString(found, FC_FILE, 0, &file) == FcResultMatch)
    path = reinterpret_cast<const char*>(file);
  if (found) FcPatternDestroy(found);
  FcPatternDestroy(wanted);
  return path;
}

namespace {

// Decodes the next character; a byte that is not valid UTF-8 becomes U+FFFD.
uint32_t nextCharacter(std::string_view& text) {
  const auto byte = [&](size_t i) { return uint32_t(static_cast<unsigned char>(text[i])); };
  const uint32_t first = byte(0);
  const size_t length = first < 0x80    ? 1
                        : first >= 0xf0 ? 4
                        : first >= 0xe0 ? 3
                        : first >= 0xc0 ? 2
                                        : 0;
  uint32_t character = length == 1                           ? first
                       : length == 0 || length > text.size() ? 0xfffd
                                                             : first & (0x7fu >> length);
  if (character == 0xfffd) {
    text.remove_prefix(1);
    return character;
  }
  for (size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) {
      text.remove_prefix(1);
      return 0xfffd;
    }
    character = character << 6 | (byte(i) & 0x3f);
  }
  text.remove_prefix(length);
  return character < 0x20 ? ' ' : character;
}

} // namespace

struct PanelPainter::Impl {
  FT_Library library = nullptr;
  FT_Face proportional = nullptr, fixed = nullptr;
  int size;

  explicit Impl(int s) : size(s) {
    if (FT_Init_FreeType(&library) != 0) library = nullptr;
    proportional = open("sans");
    fixed = open("monospace");
  }
  ~Impl() {
    if (proportional) FT_Done_Face(proportional);
    if (fixed) FT_Done_Face(fixed);
    if (library) FT_Done_FreeType(library);
  }
  FT_Face open(const char* family) {
    FT_Face face = nullptr;
    const std::string file = library ? findFontFile(family) : std::string();
    if (file.empty() || FT_New_Face(library, file.c_str(), 0, &face) != 0) return nullptr;
    if (FT_Set_Pixel_Sizes(face, 0, FT_UInt(size)) == 0) return face;
    FT_Done_Face(face);
    return nullptr;
  }

  static int widthOf(FT_Face face, std::string_view text) {
    FT_Pos pen = 0;
    while (!text.empty())
      if (FT_Load_Char(face, nextCharacter(text), FT_LOAD_DEFAULT) == 0)
        pen += face->glyph->advance.x;
    return int((pen + 63) >> 6);
  }

  // Wraps a line at blanks into parts of at most `width` pixels, as far as it has blanks.
  static void wrap(FT_Face face, std::string_view text, int width, std::vector<std::string>& out) {
    const bool weak = text.starts_with('\t');
    while (widthOf(face, text) > width) {
      size_t cut = text.npos;
      for (size_t at = text.find(' ', 1);
           at != text.npos && widthOf(face, text.substr(0, at)) <= width;
           at = text.find(' ', at + 1))
        cut = at;
      if (cut == text.npos) break;
      out.emplace_back((weak && !text.starts_with('\t') ? "\t" : "") +
                       std::string(text.substr(0, cut)));
      text.remove_prefix(cut + 1);
    }
    out.emplace_back((weak && !text.starts_with('\t') ? "\t" : "") + std::string(text));
  }

  static void put(Panel& panel, const FT_GlyphSlot glyph, int x, int y, uint8_t bright) {
    const FT_Bitmap& bitmap = glyph->bitmap;
    for (unsigned row = 0; row < bitmap.rows; ++row)
      for (unsigned column = 0; column < bitmap.width; ++column) {
        const int px = x + glyph->bitmap_left + int(column), py = y - glyph->bitmap_top + int(row);
        if (px < 0 || py < 0 || px >= panel.width || py >= panel.height) continue;
        const unsigned cover = bitmap.buffer[int(row) * bitmap.pitch + int(column)];
        uint8_t* to = panel.rgba.data() + 4 * (size_t(py) * size_t(panel.width) + size_t(px));
        for (int i = 0; i < 3; ++i)
          to[i] = uint8_t(std::max<unsigned>(to[i], cover * bright / 255));
        to[3] = uint8_t(std::max<unsigned>(to[3], cover));
      }
  }

  static void write(Panel& panel, FT_Face face, std::string_view text, int x, int y,
                    uint8_t bright) {
    FT_Pos pen = FT_Pos(x) << 6;
    while (!text.empty()) {
      if (FT_Load_Char(face, nextCharacter(text), FT_LOAD_RENDER) != 0) continue;
      put(panel, face->glyph, int(pen >> 6), y, bright);
      pen += face->glyph->advance.x;
    }
  }
};

PanelPainter::PanelPainter(int size) : impl_(std::make_unique<Impl>(size)) {}
PanelPainter::~PanelPainter() = default;

Panel PanelPainter::paint(const std::vector<std::string>& texts, int width, bool fixed) {
  constexpr size_t longest = 400; // bytes of a line that are drawn
  Panel panel;
  FT_Face face = fixed && impl_->fixed ? impl_->fixed : impl_->proportional;
  if (!face || texts.empty()) return panel;
  std::vector<std::string> lines;
  for (const std::string& text : texts) {
    if (fixed)
      lines.push_back(text);
    else
      impl_->wrap(face, text.substr(0, longest), width - impl_->size, lines);
  }
  const int step = int(face->size->metrics.height >> 6),
            ascent = int(face->size->metrics.ascender >> 6), margin = impl_->size / 2;
  int wide = 0;
  for (const std::string& line : lines)
    wide = std::max(wide, Impl::widthOf(face, std::string_view(line).substr(0, longest)));
  panel.width = std::clamp(wide + 2 * margin, 1, std::max(1, width));
  panel.height = step * int(lines.size()) + margin;
  panel.rgba.assign(4 * size_t(panel.width) * size_t(panel.height), 0);
  const uint8_t ground = fixed ? 255 : 150;
  for (size_t i = 3; i < panel.rgba.size(); i += 4) panel.rgba[i] = ground;
  int y = margin / 2 + ascent;
  for (const std::string& line : lines) {
    const bool weak = line.starts_with('\t');
    Impl::write(panel, face, std::string_view(line).substr(weak ? 1 : 0, longest), margin, y,
                weak ? 190 : 255);
    y += step;
  }
  return panel;
}

} // namespace vv
