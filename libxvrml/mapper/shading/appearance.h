// appearance.h: appearance nodes as surface shaders: one shader per appearance node, made on first
// use. [the mapper's thread]
#pragma once

#include <unordered_map>

#include "mapper/ration.h"
#include "mapper/rt.h"
#include "mapper/shading/custom_shaders.h"
#include "mapper/shading/textures.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

// Returns whether shapes of this appearance need texture coordinates: it has a texture, or a custom
// shader that may use them.
bool isTextured(Node* appearance);

struct Surface {
  RTid shader = 0;
  Color lineColor{1, 1, 1}; // for lines and points without colours of their own
};

class Surfaces {
 public:
  Surfaces(World& world, bool linearColor, ShaderClasses& classes, Textures& textures,
           CustomShaders& custom)
      : world_(world), linear_(linearColor), classes_(classes), textures_(textures),
        custom_(custom), quota_(world, "appearances") {}

  // Returns the surface of a Shape's appearance, which may be null or a prototype instance. lines:
  // for IndexedLineSet and PointSet, which are neither lit nor textured (clauses 6.24, 6.36).
  Surface surfaceFor(Node* appearance, bool lines);

  // The effect that a change of an appearance node, or of a node it holds, has on the shapes that
  // use it.
  struct Effect {
    bool other = false;    // they need another shader
    bool colored = false;  // lines need another colour
    bool textured = false; // they now have a texture and had none before
  };
  // Updates the shader parameters of a rendered appearance. It has no effect if no shape uses it.
  Effect update(Node& appearance);
  // Deletes the shaders of appearances that no shape uses any more. uses(appearance) returns
  // whether a rendered appearance is used.
  template <class Uses> void forgetUnless(const Uses& uses);
  void clear(); // deletes everything
  size_t count() const { return surfaces_.size() + lines_.size(); }
  uint64_t parametersSet() const { return sets_; }
  bool multiplyTextures = false; // OpenRTMapper::setMultiplyTextures

 private:
  struct Entry {
    NodeRef appearance;
    Surface surface;
    RTid own = 0; // own shader of the class VRML97
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
  Quota quota_;
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
