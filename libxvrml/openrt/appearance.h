// appearance.h: appearance nodes as surface shaders: one shader per appearance node. Made by the mapper's thread when first used.
#pragma once

#include <unordered_map>

#include "openrt/rt.h"
#include "openrt/textures.h"
#include "xvrml/world.h"

namespace xvrml::mapping {

// True if shapes of this appearance need texture coordinates: a texture, or a shader that may want them.
bool isTextured(Node* appearance);

struct Surface {
  RTid shader = 0;
  Color lineColor{1, 1, 1}; // of lines and points without colours of their own
};

class Surfaces {
 public:
  Surfaces(World& world, bool linearColor, ShaderClasses& classes, Textures& textures)
      : world_(world), linear_(linearColor), classes_(classes), textures_(textures) {}

  // Of a Shape's appearance (may be null or a prototype instance). lines: for IndexedLineSet and PointSet, which are neither
  // lit nor textured (clauses 6.24, 6.36).
  Surface of(Node* appearance, bool lines);

 private:
  Surface makeLines(Node* appearance);
  RTid makeSurface(Node* appearance);
  RTid makeCustom(Node& shaderNode);

  World& world_;
  bool linear_;
  ShaderClasses& classes_;
  Textures& textures_;
  std::unordered_map<const Node*, Surface> surfaces_, lines_;
  std::unordered_map<const Node*, RTid> custom_; // by ORTShader
};

} // namespace xvrml::mapping
