// panel.h: lines of text as a picture with a dark, translucent ground, for the overlay. FreeType
// draws them in a font that fontconfig finds. [one thread]
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vv {

struct Panel {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba; // first row at the top, colours not multiplied by alpha
};

class PanelPainter {
 public:
  // size: pixels of the em square. Without any font panels are empty.
  explicit PanelPainter(int size);
  ~PanelPainter();
  // UTF-8; a line beginning with a tab stands apart in a weaker colour. Lines are broken at `width`
  // pixels, and cut. fixed: columns line up, and lines are cut only.
  Panel paint(const std::vector<std::string>& lines, int width, bool fixed = false);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace vv
