// appearance.h: appearance nodes as surface shaders, made on first use. In a world with many
// appearances, equal ones, also with an ORTShader, share a shader as long as no event reaches them;
// the first change gives an appearance a shader of its own. [the mapper's thread]
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/index_table.h"
#include "geometry/mesh.h"
#include "mapper/ration.h"
#include "mapper/rt.h"
#include "mapper/shading/cube_maps.h"
#include "mapper/shading/custom_shaders.h"
#include "mapper/shading/line_properties.h"
#include "mapper/shading/textures.h"
#include "mapper/shading/volumes.h"
#include "xvrml/world.h"

namespace xvrml::mapper {

// Returns which texture coordinates shapes of this appearance need: it has a texture, or a custom
// shader that may use them.
TextureNeed textureNeed(Node* appearance);

struct Surface {
  RTid shader = 0;
  bool lines = false;       // it is for lines or points
  bool takesPlaces = false; // its class has the parameter texturePlace of vertices
  Color lineColor{1, 1, 1}; // for lines and points without colours of their own
  float transparency = 0;   // that of lines and points
  LineStyle style;
};

// Says what a surface is used for.
struct SurfaceUse {
  // Lines or points, which are neither lit nor textured (clauses 6.24, 6.36).
  bool lines = false;
  bool thick = false; // lines or points that are rods or balls, and therefore lit
  // The geometry's colours are those of a ColorRGBA, whose opacities stand in place of the
  // material's transparency (ISO/IEC 19775-1 11.4.3).
  bool vertexAlpha = false;
  // Cube maps are looked up by the normal (TextureCoordinateGenerator).
  bool byNormal = false;
  bool placed = false; // the geometry has texture coordinates in space
};

class Surfaces {
 public:
  Surfaces(World& world, bool linearColor, ShaderClasses& classes, Textures& textures,
           CubeMaps& cubes, Volumes& volumes, CustomShaders& custom)
      : world_(world), linear_(linearColor), classes_(classes), textures_(textures), cubes_(cubes),
        volumes_(volumes), custom_(custom), quota_(world, "appearances") {}

  // Returns the surface of a Shape's appearance, which may be null or a prototype instance.
  Surface surfaceFor(Node* appearance, SurfaceUse use);

  // The effect that a change of an appearance node, or of a node it holds, has on the shapes that
  // use it.
  struct Effect {
    bool other = false;    // they need another shader
    bool colored = false;  // lines look another way
    bool textured = false; // they now need texture coordinates that they did not need before
  };
  // Returns the surface of meshes whose texture coordinates in space shaders of instances use:
  // those of the class Physical, or of X3DMaterial.
  Surface carrier(bool physical);
  // Updates the shader parameters of a rendered appearance. It has no effect if no shape uses it.
  Effect update(Node& appearance);
  // Deletes the shaders of appearances that no shape uses any more. uses(appearance) returns
  // whether a rendered appearance is used.
  template <class Uses> void forgetUnless(const Uses& uses);
  void clear(); // deletes everything
  size_t count() const {
    size_t n = 0;
    for (const Entries& entries : entries_) n += entries.size();
    return n;
  }
  uint64_t parametersSet() const { return sets_; }
  bool multiplyTextures = false; // OpenRTMapper::setMultiplyTextures

 private:
  // The hash of all values that decide how a surface looks. It stands for them, because no two
  // different ones among millions have the same 128 bits.
  struct Key {
    uint64_t low = 0, high = 0;
    bool operator==(const Key&) const = default;
  };
  // A shader for all appearances whose values have the hash `key`: of the class VRML97, or that of
  // an ORTShader.
  struct Shared {
    RTid shader = 0;
    uint32_t users = 0; // 0: the place is free
    Key key;
    NodeRef customUser; // stands for the users in custom_; null: the class is VRML97
  };
  struct Entry {
    NodeRef appearance;
    Surface surface;
    RTid own = 0;      // own shader of the class VRML97
    RTid physical = 0; // own shader of the class Physical
    RTid x3d = 0;      // own shader of the class X3DMaterial
    // Index into shared_, of a shader shared with equal appearances; then `own` is 0.
    uint32_t shared = IndexTable::none;
    // Taken from the budget, without its own shaders; 0: the appearance is left out.
    uint32_t bytes = 0;
    TextureNeed need = TextureNeed::none;
    SurfaceUse use;
  };
  using Entries = std::unordered_map<const Node*, Entry>;
  // Returns the place in entries_ of surfaces for a use.
  static size_t placeOf(SurfaceUse use) {
    return size_t(use.placed) * 16 + size_t(use.thick) * 8 + size_t(use.lines) * 4 +
           size_t(use.byNormal) * 2 + size_t(use.vertexAlpha);
  }
  Surface makeLines(const Entry& entry);
  void makeSurface(Entry& entry);
  bool setUp(Entry& entry, RTid Entry::*own, RTid shaderClass, std::optional<ShaderSetup>& setup);
  void makePhysical(Entry& entry);
  void makeX3d(Entry& entry);
  bool multiplies(const Entry& entry) const;
  bool mayShare(const Entry& entry, const AppearanceParts& parts) const;
  Key keyOf(const AppearanceParts& parts, RTid texture, bool multiply, bool vertexAlpha) const;
  bool isShared(const Entry& entry) const { return entry.shared != IndexTable::none; }
  bool joinCustom(Entry& entry, const AppearanceParts& parts);
  bool share(Entry& entry, const Key& key);
  void leaveShared(Entry& entry);
  bool take(const Entry& entry, uint64_t bytes);
  RTid customSurface(Entry& entry, const AppearanceParts& parts);
  void forget(Entry& entry);

  World& world_;
  bool linear_;
  ShaderClasses& classes_;
  Textures& textures_;
  CubeMaps& cubes_;
  Volumes& volumes_;
  CustomShaders& custom_;
  Quota quota_;
  Entries entries_[32];   // by placeOf()
  RTid carriers_[2] = {}; // those of the classes X3DMaterial and Physical
  std::vector<Shared> shared_;
  std::vector<uint32_t> freeShared_;
  IndexTable sharedByKey_;
  uint64_t sets_ = 0;
};

template <class Uses> void Surfaces::forgetUnless(const Uses& uses) {
  for (Entries& entries : entries_)
    for (auto it = entries.begin(); it != entries.end();) {
      if (!it->first || uses(it->first)) {
        ++it;
        continue;
      }
      forget(it->second);
      it = entries.erase(it);
    }
}

} // namespace xvrml::mapper
