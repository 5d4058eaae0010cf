// text_extent.h: the sizes of a text as it is laid out, which the outputs of Text in X3D say
// (ISO/IEC 19775-1 clause 15.4.2).
#pragma once

#include <vector>

#include "xvrml/nodes.h"

namespace xvrml {

struct TextExtent {
  std::vector<Vec2f> lines; // width and height of each line
  Vec2f text{0, 0};         // width and height of all of them
  Vec3f origin{0, 0, 0};    // upper left corner
};

// Returns zeros if nothing is drawn. Lines are as high as the font, and columns an em wide.
TextExtent extentOf(const nodes::Text& node);

} // namespace xvrml
