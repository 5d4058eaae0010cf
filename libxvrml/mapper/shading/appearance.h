// appearance.h: appearance nodes as surface shaders: one shader per appearance node. Made by the
// mapper's thread when first used.
#pragma once

#include <unordered_map>

#include "mapper/ration.h"
#include "mapper/rt.h"
#include "mapper/shading/custom_shaders.h"
#include "mapper/shading/textures.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

// True if shapes of this appearance need texture coordinates: a texture, or a shader that may want
// them.
bool isTextured(Node* appearance);

struct Surface {
  RTid shader = 0;
  Color lineColor{1, 1, 1}; // of lines and points without colours of their own
};

class Surfaces {
 public:
  Surfaces(World& world, bool linearColor, ShaderClasses& classes, Textures& textures,
           CustomShaders& custom)
      : world_(world), linear_(linearColor), classes_(classes), textures_(textures),
        custom_(custom), ration_(world, "appearances") {}

  // Of a Shape's appearance (may be null or a prototype instance). lines: for IndexedLineSet and
  // PointSet, which are neither lit nor textured (clauses 6.24, 6.36).
  Surface of(Node* appearance, bool lines);

  // What a change of an appearance node, or of a node it holds, means for shapes that use it.
  struct Effect {
    bool other = false;    // they need another shader
    bool colored = false;  // lines need another colour
    bool textured = false; // they have a texture, and had none
  };
  // Gives the shaders of an appearance (rendered) new parameters. No effect if no shape uses it.
  Effect update(Node& appearance);
  // Shaders of appearances that no shape uses any more; users: those that are used, rendered.
  template <class Uses> void forgetUnless(const Uses& uses);
  void clear(); // deletes everything
  size_t count() const { return surfaces_.size() + lines_.size(); }
  uint64_t parametersSet() const { return sets_; }
  bool multiplyTextures = false; // OpenRTMapper::setMultiplyTextures

 private:
  struct Entry {
    NodeRef appearance;
    Surface surface;
    RTid own = 0; // of the class VRML97
    bool textured = false;
    bool counted = false; // its memory is taken from the budget
  };
  using Entries = std::unordered_map<const Node*, Entry>;
  Surface makeLines(Node* appearance);
  void makeSurface(Entry& entry);
  RTid customSurface(Node& appearance, nodes::ORTShader& shader);
  void forget(const Entry& entry);

  World& world_;
  bool linear_;
  ShaderClasses& classes_;
  Textures& textures_;
  CustomShaders& custom_;
  Ration ration_;
  Entries surfaces_, lines_;
  uint64_t sets_ = 0;
};

template <class Uses> void Surfaces::forgetUnless(const Uses& uses) {
  const auto sweep = [&](const auto& known) {
    if (!known.first || uses(known.first)) return false;
    forget(known.second);
    return true;
  };
  std::erase_if(surfaces_, sweep);
  std::erase_if(lines_, sweep);
}

} // namespace xvrml::mapper
