// fonts.h: fonts found by fontconfig, read by FreeType and laid out by HarfBuzz; glyphs are cached
// as triangles. Fonts live as long as the process. Callers hold fontsMutex() around every call,
// because FreeType faces are not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "xvrml/types.h"

namespace xvrml {

// A glyph in units of the font size (the em square is 1). Triangles are counterclockwise about +z.
struct GlyphMesh {
  std::vector<Vec2f> points;
  std::vector<uint32_t> indices;
};

// A glyph in a line of text and the position of its origin, in em.
struct PlacedGlyph {
  uint32_t glyph;
  double x, y;
};

struct ShapedLine {
  std::vector<PlacedGlyph> glyphs;
  double advanceX = 0, advanceY = 0; // pen position at the end of the line
};

enum class TextDirection : uint8_t { leftToRight, rightToLeft, topToBottom, bottomToTop };

class Font {
 public:
  // Throws std::runtime_error if the file is unusable.
  Font(const std::string& file, int faceIndex, bool slant, bool embolden);
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  double ascender() const;  // em above the baseline
  double descender() const; // em relative to the baseline, negative
  ShapedLine shape(const std::string& utf8, TextDirection direction, const std::string& language);
  // Returns a mesh that is valid until the next call of glyph().
  const GlyphMesh& glyph(uint32_t id);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

std::mutex& fontsMutex();

// Returns the font for FontStyle's family and style (clause 6.20.2): the first available family.
// SERIF, SANS and TYPEWRITER are available if any font is installed. Returns null if there is none.
Font* findFont(std::span<const std::string> families, bool bold, bool italic,
               const std::string& language);

} // namespace xvrml
