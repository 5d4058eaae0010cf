// panel.h: Draws lines of text on a dark, translucent background, for the overlay. FreeType draws
// the text in a font that fontconfig finds. [one thread]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vv {

// Returns the file of a family's font; empty if there is none.
std::string findFontFile(const char* family);

struct Panel {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba; // first row at the top, colours not premultiplied
};

class PanelPainter {
 public:
  // size: pixels of the em square. If no font is found, panels are empty.
  explicit PanelPainter(int size);
  ~PanelPainter();
  // Draws UTF-8 text; a line that begins with a tab gets a weaker colour. Lines longer than `width`
  // pixels are wrapped, and cut if that fails. fixed: for long lists, uses a fixed-width font on an
  // opaque ground, and lines are only cut.
  Panel paint(const std::vector<std::string>& lines, int width, bool fixed = false);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vv
