// fonts.h: fonts found by fontconfig, read by FreeType, laid out by HarfBuzz, with glyphs kept as
// triangles. Fonts live as long as the process; every call holds fontsMutex() (FreeType faces are
// not shared between threads).
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

// A glyph in units of the font size (the em square is 1), counterclockwise triangles about +z.
struct GlyphMesh {
  std::vector<Vec2f> points;
  std::vector<uint32_t> indices;
};

// A glyph of a line of text and where its origin stands, in em.
struct PlacedGlyph {
  uint32_t glyph;
  double x, y;
};

struct ShapedLine {
  std::vector<PlacedGlyph> glyphs;
  double advanceX = 0, advanceY = 0; // where the pen stands at the end
};

enum class TextDirection : uint8_t { leftToRight, rightToLeft, topToBottom, bottomToTop };

class Font {
 public:
  // Throws std::runtime_error if the file cannot be used.
  Font(const std::string& file, int faceIndex, bool slant, bool embolden);
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  double ascender() const;  // above the baseline, em
  double descender() const; // below it, negative
  ShapedLine shape(const std::string& utf8, TextDirection direction, const std::string& language);
  // Valid until the next call of glyph().
  const GlyphMesh& glyph(uint32_t id);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

std::mutex& fontsMutex();

// The font for FontStyle's family and style (clause 6.20.2): the first family that is there; SERIF,
// SANS and TYPEWRITER always are as long as any font is installed. Null if none is.
Font* findFont(std::span<const std::string> families, bool bold, bool italic,
               const std::string& language);

} // namespace xvrml
