// appearance.cpp: surfaces with the lighting model of clause 4.14. The parameters are those of the
// class VRML97.
#include "mapper/shading/appearance.h"

#include <array>
#include <cstring>
#include <optional>
#include <utility>

#include <xxhash.h>

#include "geometry/node_matrix.h"
#include "mapper/shading/layers.h"
#include "mapper/shading/material_parameters.h"
#include "mapper/shading/physical.h"
#include "mapper/shading/x3d_material.h"
#include "xvrml/appearance.h"
#include "xvrml/change.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {

TextureNeed textureNeed(Node* appearance) {
  const AppearanceParts parts = resolveAppearance(appearance);
  if (showsVolume(parts))
    return isPhysical(parts.material) ? TextureNeed::physicalVolume : TextureNeed::volume;
  if (parts.shader || (parts.texture && !isCubeMap(parts.texture))) return TextureNeed::picture;
  if (parts.material && hasPictures(*parts.material)) return TextureNeed::picture;
  Node* back = parts.plain ? renderedNode(parts.plain->backMaterial.get()) : nullptr;
  return back && hasPictures(*back) ? TextureNeed::picture : TextureNeed::none;
}

namespace {
// Sets the material (clause 4.14). Without a Material the surface is unlit.
void setMaterial(ShaderSetup& shader, const nodes::Material* m, bool linear) {
  shader.integer("lit", m ? 1 : 0);
  shader.number("transparency", m ? m->transparency : 0, 0, 1);
  if (!m) return;
  shader.color("diffuseColor", convert(m->diffuseColor, linear));
  shader.color("emissiveColor", convert(m->emissiveColor, linear));
  shader.color("specularColor", convert(m->specularColor, linear));
  shader.number("ambientIntensity", m->ambientIntensity, 0, 1);
  shader.number("shininess", m->shininess, 0, 1);
}
} // namespace

namespace {

constexpr uint64_t bytesOfShader = bytesOfSurface - bytesOfSharedSurface;

// Up to this number of appearances each has a shader of its own, so that its first change is a
// change of parameters. The first change of a shared shader rewrites the shapes of one appearance.
constexpr size_t smallWorld = 256;

} // namespace

Surfaces::Key Surfaces::keyOf(const AppearanceParts& parts, RTid texture, bool multiply,
                              bool vertexAlpha) const {
  std::array<std::byte, 256> bytes; // those of all values take less
  size_t size = 0;
  const auto add = [&](const auto& value) {
    std::memcpy(bytes.data() + size, &value, sizeof value);
    size += sizeof value;
  };
  add(parts.shader);
  add(texture);
  add(multiply);
  add(vertexAlpha);
  if (const auto* m = nodeCast<nodes::Material>(parts.material)) {
    for (const Color& color : {m->diffuseColor, m->emissiveColor, m->specularColor})
      add(convert(color, linear_));
    for (const float number : {m->ambientIntensity, m->shininess, m->transparency}) add(number);
  }
  if (const Node* t = firstTransform(parts.textureTransform); t && texture != 0)
    add(textureMatrixOf(t));
  const XXH128_hash_t digest = XXH3_128bits(bytes.data(), size);
  return {digest.low64, digest.high64};
}

// Returns whether the appearance may share the shader of an equal one: the world has many
// appearances, and no events reach this one. One with an ORTShader has nothing but a Material.
bool Surfaces::mayShare(const Entry& entry, const AppearanceParts& parts) const {
  Node* node = entry.appearance.get();
  if (!node || entries_[placeOf(entry.use)].size() <= smallWorld) return false;
  if (isPhysical(parts.material)) return false;
  const bool isPlain = !parts.texture && !parts.textureTransform && !entry.use.vertexAlpha &&
                       nodeCast<nodes::Material>(parts.material) && !hasPictures(*parts.material);
  if (parts.shader && !isPlain) return false;
  for (const Node* part :
       {node, nodeCast<nodes::Material>(parts.material) ? parts.material : nullptr, parts.texture,
        parts.textureTransform})
    if (part && part->live && reachOf(*part) != 0) return false;
  return true;
}

// Takes memory for a surface from the budget. Returns false, with a message, if none is left.
bool Surfaces::take(const Entry& entry, uint64_t bytes) {
  const Node* node = entry.appearance.get();
  return quota_.take(bytes, node ? node->source : SourcePosition());
}

// Gives the entry the shared shader of these values. Returns false if there is none yet: then the
// entry is its first user, and the caller makes the shader.
bool Surfaces::share(Entry& entry, const Key& key) {
  uint32_t at = sharedByKey_.find(key.low, [&](uint32_t i) { return shared_[i].key == key; });
  const bool fresh = at == IndexTable::none;
  if (fresh && freeShared_.empty()) {
    at = uint32_t(shared_.size());
    shared_.emplace_back();
  } else if (fresh) {
    at = freeShared_.back();
    freeShared_.pop_back();
  }
  if (fresh) {
    shared_[at] = {0, 0, key};
    sharedByKey_.insert(key.low, at);
  }
  entry.shared = at;
  ++shared_[at].users;
  entry.surface.shader = shared_[at].shader;
  return !fresh;
}

// Takes the entry away from its shared shader. The last user keeps one of the class VRML97 as its
// own.
void Surfaces::leaveShared(Entry& entry) {
  const uint32_t at = std::exchange(entry.shared, IndexTable::none);
  Shared& shared = shared_[at];
  if (--shared.users > 0) return;
  if (const NodeRef user = std::exchange(shared.customUser, {}))
    custom_.forget(*user);
  else
    entry.own = shared.shader;
  sharedByKey_.erase(shared.key.low, at);
  freeShared_.push_back(at);
}

Surface Surfaces::surfaceFor(Node* appearance, SurfaceUse use) {
  Node* node = renderedNode(appearance);
  // Lines have no textures.
  if (use.lines) use.byNormal = use.placed = false;
  const auto [it, fresh] = entries_[placeOf(use)].try_emplace(node);
  Entry& entry = it->second;
  if (!fresh) return entry.surface;
  entry.appearance = NodeRef(node);
  entry.need = textureNeed(node);
  entry.use = use;
  const AppearanceParts parts = resolveAppearance(node);
  const uint64_t bytes = parts.shader ? bytesOfSurface : bytesOfSharedSurface;
  if (!take(entry, bytes)) return entry.surface;
  entry.bytes = uint32_t(bytes);
  if (!use.lines) warnOfFaces(parts.plain, world_);
  if (!use.lines)
    makeSurface(entry);
  else if (take(entry, bytesOfShader))
    entry.own = (entry.surface = makeLines(entry)).shader;
  return entry.surface;
}

// Makes the surface of lines and points (clauses 6.24 and 6.36) in the colours of the geometry,
// else in emissiveColor: unlit, unless they are thick, and as transparent as the material.
Surface Surfaces::makeLines(const Entry& entry) {
  Node* appearance = entry.appearance.get();
  Surface surface;
  ShaderSetup shader(classes_.get("VRML97", ""));
  surface.shader = shader.id();
  surface.lines = true;
  shader.integer("lit", entry.use.thick);
  if (entry.use.vertexAlpha) shader.integer("vertexAlpha", 1);
  const AppearanceParts parts = resolveAppearance(appearance);
  if (parts.material) {
    const MaterialValues values = materialValues(parts.material);
    surface.lineColor = convert(values.lineColor, linear_);
    surface.transparency = values.transparency;
    shader.number("transparency", values.transparency, 0, 1);
  }
  surface.style = lineStyle(parts.plain);
  warnOfLines(parts.plain, world_);
  report(world_.diagnostics, appearance ? appearance->source : SourcePosition(),
         "appearance of lines or points");
  return surface;
}

// Lets the entry share the shader of equal appearances with one ORTShader, if it may, or leave it
// if it has other values now. Returns whether the shader is ready: an earlier user has made it.
bool Surfaces::joinCustom(Entry& entry, const AppearanceParts& parts) {
  const bool isFirst = entry.surface.shader == 0 && !isShared(entry);
  if (!isShared(entry) && !(isFirst && mayShare(entry, parts))) return false;
  const Key key = keyOf(parts, 0, false, false);
  if (isShared(entry) && shared_[entry.shared].key == key)
    return false; // its parameters are set again
  if (isShared(entry)) leaveShared(entry);
  if (!isFirst) return false;
  if (share(entry, key)) return entry.surface.shader != 0;
  const NodeType& type = *findNodeType("Appearance");
  shared_[entry.shared].customUser = NodeRef(type.create(type));
  return false;
}

// Returns the shader of an ORTAppearance. Fields of the appearance set the class's parameters of
// the same name, where the class has them (as VRML97 does). These fields are texture,
// textureTransform and those of the Material.
RTid Surfaces::customSurface(Entry& entry, const AppearanceParts& parts) {
  nodes::ORTShader& node = *parts.shader;
  if (!parts.texture && !firstTransform(parts.textureTransform) && !parts.material) {
    if (isShared(entry)) leaveShared(entry);
    return custom_.shaderFor(node, RT_SURFACE);
  }
  if (joinCustom(entry, parts)) return shared_[entry.shared].shader;
  const CustomShaders::Preset preset = [&](ShaderSetup& shader, const ShaderClass& shaderClass) {
    setMaterialParameters(shader, shaderClass, node, parts, textures_, world_, linear_);
  };
  const Node* const user =
      isShared(entry) ? shared_[entry.shared].customUser.get() : entry.appearance.get();
  const RTid shader = custom_.shaderFor(node, RT_SURFACE, user, preset);
  if (isShared(entry)) shared_[entry.shared].shader = shader;
  return shader;
}

bool Surfaces::multiplies(const Entry& entry) const {
  return multiplyTextures || resolveAppearance(entry.appearance.get()).texturesMultiply();
}

// Makes the surface, or sets new parameters on its existing shader.
void Surfaces::makeSurface(Entry& entry) {
  entry.surface.takesPlaces = false;
  const AppearanceParts parts = resolveAppearance(entry.appearance.get());
  // Shaders of both kinds are not shared with each other.
  if (isShared(entry) && bool(shared_[entry.shared].customUser) != bool(parts.shader))
    leaveShared(entry);
  if (parts.shader) {
    if (const RTid shader = customSurface(entry, parts)) {
      entry.surface.shader = shader;
      return;
    }
    if (isShared(entry)) leaveShared(entry); // the class is not there
  }
  const bool isPlaced = entry.use.placed && parts.texture && !isPhysical(parts.material);
  if (!parts.shader && (isPlaced || needsX3dMaterial(parts))) return makeX3d(entry);
  if (!parts.shader && isPhysical(parts.material)) return makePhysical(entry);
  // This may bind another texture, but no shader.
  const RTid texture = textures_.ofNode(parts.texture);
  const bool multiplied = multiplies(entry);
  const bool first = entry.own == 0 && !isShared(entry);
  if (isShared(entry) || (first && !parts.shader && mayShare(entry, parts))) {
    const Key key = keyOf(parts, texture, multiplied, entry.use.vertexAlpha);
    if (isShared(entry) && shared_[entry.shared].key == key) {
      entry.surface.shader = shared_[entry.shared].shader;
      return;
    }
    if (isShared(entry)) leaveShared(entry);
    if (first && share(entry, key)) return;
  }
  if (entry.own == 0 && !take(entry, bytesOfShader)) {
    if (isShared(entry)) leaveShared(entry);
    entry.surface = Surface();
    return;
  }
  std::optional<ShaderSetup> setup;
  const RTid shaderClass = classes_.get("VRML97", "");
  if (entry.own == 0)
    setup.emplace(shaderClass);
  else
    setup.emplace(shaderClass, entry.own, sets_);
  ShaderSetup& shader = *setup;
  shader.leaveOutDefaults();
  entry.surface.shader = shader.id();
  (isShared(entry) ? shared_[entry.shared].shader : entry.own) = shader.id();
  const auto* material = nodeCast<nodes::Material>(parts.material);
  // If the custom shader is unavailable, the surface is shaded as a default Material.
  if (!material && parts.shader) {
    const nodes::Material standard(*findNodeType("Material"));
    setMaterial(shader, &standard, linear_);
  } else {
    setMaterial(shader, material, linear_);
  }
  if (texture != 0 || !shader.fresh()) shader.texture("texture", texture);
  if (multiplied && shader.fresh()) shader.integer("multiplyTexture", 1);
  if (entry.use.vertexAlpha && shader.fresh()) shader.integer("vertexAlpha", 1);
  if (const Node* t = firstTransform(parts.textureTransform); t && texture != 0)
    shader.matrix("textureTransform", textureMatrixOf(t));
  else if (!shader.fresh())
    shader.matrix("textureTransform", Matrix());
  report(world_.diagnostics, entry.appearance ? entry.appearance->source : SourcePosition(),
         "appearance");
}

// Gives the entry a shader of a class other than VRML97, and starts to set its parameters. Returns
// false, and leaves the appearance out, if the world's budget does not allow the shader.
bool Surfaces::setUp(Entry& entry, RTid Entry::*own, RTid shaderClass,
                     std::optional<ShaderSetup>& setup) {
  if (isShared(entry)) leaveShared(entry);
  if (entry.*own == 0 && !take(entry, bytesOfShader)) {
    entry.surface = Surface();
    return false;
  }
  if (entry.*own == 0)
    setup.emplace(shaderClass);
  else
    setup.emplace(shaderClass, entry.*own, sets_);
  entry.surface.shader = entry.*own = setup->id();
  return true;
}

// Makes the surface of a PhysicalMaterial or UnlitMaterial, or sets new parameters.
void Surfaces::makePhysical(Entry& entry) {
  const AppearanceParts parts = resolveAppearance(entry.appearance.get());
  std::optional<ShaderSetup> setup;
  if (!setUp(entry, &Entry::physical, classes_.get("Physical", "physical"), setup)) return;
  setPhysical(*setup, parts, {textures_, volumes_}, world_, linear_);
  setup->integer("inSpace", showsVolume(parts) ? 1 : 0);
  entry.surface.takesPlaces = showsVolume(parts);
  if (entry.use.vertexAlpha && setup->fresh()) setup->integer("vertexAlpha", 1);
  report(world_.diagnostics, entry.appearance->source, parts.material->type().name);
}

// Makes a surface that needs the class X3DMaterial, or sets new parameters.
void Surfaces::makeX3d(Entry& entry) {
  const AppearanceParts parts = resolveAppearance(entry.appearance.get());
  std::optional<ShaderSetup> setup;
  if (!setUp(entry, &Entry::x3d, classes_.get("X3DMaterial", ""), setup)) return;
  setX3dMaterial(
      *setup, parts,
      {.multiplies = multiplies(entry), .byNormal = entry.use.byNormal, .placed = entry.use.placed},
      {textures_, cubes_, volumes_}, world_, linear_);
  entry.surface.takesPlaces = true;
  if (entry.use.vertexAlpha && setup->fresh()) setup->integer("vertexAlpha", 1);
  report(world_.diagnostics, entry.appearance->source, "appearance");
}

Surfaces::Effect Surfaces::update(Node& appearance) {
  Effect effect;
  for (Entries& entries : entries_) {
    const auto it = entries.find(&appearance);
    if (it == entries.end()) continue;
    if (!it->second.use.lines) {
      const RTid before = it->second.surface.shader;
      if (it->second.bytes > 0) makeSurface(it->second);
      effect.other |= it->second.surface.shader != before;
      const TextureNeed need = textureNeed(&appearance);
      effect.textured |= need > it->second.need;
      it->second.need = need;
    } else {
      const AppearanceParts parts = resolveAppearance(&appearance);
      const MaterialValues values = materialValues(parts.material);
      const Color color = parts.material ? convert(values.lineColor, linear_) : Surface().lineColor;
      if (it->second.own != 0)
        ShaderSetup(classes_.get("VRML97", ""), it->second.own, sets_)
            .number("transparency", values.transparency, 0, 1);
      const LineStyle style = lineStyle(parts.plain);
      Surface& surface = it->second.surface;
      effect.colored |= !(color == surface.lineColor) || !(style == surface.style) ||
                        values.transparency != surface.transparency;
      surface.lineColor = color;
      surface.style = style;
      surface.transparency = values.transparency;
    }
  }
  return effect;
}

Surface Surfaces::carrier(bool physical) {
  RTid& carrier = carriers_[physical];
  if (carrier == 0)
    carrier = rtNewShader(physical ? classes_.get("Physical", "physical")
                                   : classes_.get("X3DMaterial", ""));
  Surface surface;
  surface.shader = carrier;
  surface.takesPlaces = true;
  return surface;
}

void Surfaces::clear() {
  for (const RTid carrier : carriers_)
    if (carrier != 0) rtDeleteShader(carrier);
  for (Entries& entries : entries_)
    for (auto& [node, entry] : entries) forget(entry);
}

void Surfaces::forget(Entry& entry) {
  quota_.give(entry.bytes);
  if (isShared(entry)) leaveShared(entry);
  if (entry.own != 0) {
    rtDeleteShader(entry.own);
    quota_.give(bytesOfShader);
  }
  if (entry.physical != 0) {
    rtDeleteShader(entry.physical);
    quota_.give(bytesOfShader);
  }
  if (entry.x3d != 0) {
    rtDeleteShader(entry.x3d);
    quota_.give(bytesOfShader);
  }
  if (entry.appearance) custom_.forget(*entry.appearance);
}

} // namespace xvrml::mapper
