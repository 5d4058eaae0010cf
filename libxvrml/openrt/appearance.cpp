// appearance.cpp: see appearance.h. The lighting model is that of clause 4.14; the parameters are those of the class VRML97.
#include "openrt/appearance.h"

#include <optional>

#include "openrt/shader_options.h"
#include "xvrml/nodes.h"

namespace xvrml::mapping {
namespace {

// The parts of an Appearance or ORTAppearance, prototype instances resolved.
struct Parts {
  nodes::Material* material = nullptr;
  Node* texture = nullptr;
  nodes::TextureTransform* textureTransform = nullptr;
  nodes::ORTShader* shader = nullptr;
};

template <class T> void surfaceParts(const T& appearance, Parts& parts) {
  parts.material = nodeCast<nodes::Material>(renderedNode(appearance.material.get()));
  parts.texture = renderedNode(appearance.texture.get());
  parts.textureTransform = nodeCast<nodes::TextureTransform>(renderedNode(appearance.textureTransform.get()));
}

Parts partsOf(Node* appearance) {
  Parts parts;
  Node* node = renderedNode(appearance);
  if (auto* plain = nodeCast<nodes::Appearance>(node)) {
    surfaceParts(*plain, parts);
  } else if (auto* custom = nodeCast<nodes::ORTAppearance>(node)) {
    surfaceParts(*custom, parts);
    parts.shader = nodeCast<nodes::ORTShader>(renderedNode(custom->shader.get()));
  }
  return parts;
}

void setOption(const ShaderOption& option, Textures& textures, const Node& node) {
  const int handle = rtParameterHandle(option.name.c_str());
  const std::vector<float>& n = option.numbers;
  switch (option.type) {
  case ShaderOption::Type::integer:
  case ShaderOption::Type::boolean: return rtParameter1i(handle, option.integer);
  case ShaderOption::Type::text: return rtParameterString(handle, option.text.c_str());
  case ShaderOption::Type::texture: return rtParameterTexture(handle, textures.ofUrls({option.text}, node, true, true));
  case ShaderOption::Type::color:
  case ShaderOption::Type::floats: break;
  }
  switch (n.size()) {
  case 1: return rtParameter1f(handle, n[0]);
  case 2: return rtParameter2f(handle, n[0], n[1]);
  case 3: return rtParameter3f(handle, n[0], n[1], n[2]);
  case 4: return rtParameter4f(handle, n[0], n[1], n[2], n[3]);
  case 16: return rtParameter16f(handle, n.data());
  }
}

} // namespace

bool isTextured(Node* appearance) {
  const Parts parts = partsOf(appearance);
  return parts.texture || parts.shader;
}

namespace {
// Clause 4.14; a Material that is missing means: not lit. A shader that is made again from its defaults is set in part only.
void setMaterial(ShaderSetup& shader, const nodes::Material* m, bool linear) {
  shader.integer("lit", m ? 1 : 0);
  if (!m) return;
  shader.color("diffuseColor", convert(m->diffuseColor, linear));
  shader.color("emissiveColor", convert(m->emissiveColor, linear));
  shader.color("specularColor", convert(m->specularColor, linear));
  shader.number("ambientIntensity", m->ambientIntensity, 0, 1);
  shader.number("shininess", m->shininess, 0, 1);
  shader.number("transparency", m->transparency, 0, 1);
}
} // namespace

Surface Surfaces::of(Node* appearance, bool lines) {
  Node* node = renderedNode(appearance);
  const auto [it, fresh] = (lines ? lines_ : surfaces_).try_emplace(node);
  Entry& entry = it->second;
  if (!fresh) return entry.surface;
  entry.appearance = NodeRef(node);
  if (lines)
    entry.own = (entry.surface = makeLines(node)).shader;
  else
    makeSurface(entry);
  entry.textured = isTextured(node);
  return entry.surface;
}

// Clauses 6.24 and 6.36: unlit, in the colours of the geometry, else in emissiveColor.
Surface Surfaces::makeLines(Node* appearance) {
  Surface surface;
  ShaderSetup shader(classes_.get("VRML97", ""));
  surface.shader = shader.id();
  shader.integer("lit", 0);
  if (const nodes::Material* material = partsOf(appearance).material)
    surface.lineColor = convert(material->emissiveColor, linear_);
  report(world_.diagnostics, appearance ? appearance->source : SourcePosition(), "appearance of lines or points");
  return surface;
}

// Makes the surface, or gives the shader that it has its new parameters.
void Surfaces::makeSurface(Entry& entry) {
  const Parts parts = partsOf(entry.appearance.get());
  if (parts.shader) {
    const auto [it, fresh] = custom_.try_emplace(parts.shader);
    if (fresh) it->second = makeCustom(*parts.shader);
    if (it->second.shader != 0) {
      entry.surface.shader = it->second.shader;
      return;
    }
  }
  const RTid texture = textures_.ofNode(parts.texture); // may bind another texture, but no shader
  std::optional<ShaderSetup> setup;
  if (entry.own == 0)
    setup.emplace(classes_.get("VRML97", ""));
  else
    setup.emplace(entry.own, sets_);
  ShaderSetup& shader = *setup;
  entry.own = entry.surface.shader = shader.id();
  const nodes::Material standard(*findNodeType("Material"));
  const bool fallback = parts.shader != nullptr; // a shader that could not be had: shaded as a default Material
  setMaterial(shader, parts.material ? parts.material : fallback ? &standard : nullptr, linear_);
  if (texture != 0 || !shader.fresh()) shader.texture("texture", texture);
  if (const nodes::TextureTransform* t = parts.textureTransform; t && texture != 0)
    shader.matrix("textureTransform", textureMatrix(t->center, t->rotation, t->scale, t->translation));
  else if (!shader.fresh())
    shader.matrix("textureTransform", Matrix());
  report(world_.diagnostics, entry.appearance ? entry.appearance->source : SourcePosition(), "appearance");
}

Surfaces::Effect Surfaces::update(Node& appearance) {
  Effect effect;
  if (const auto it = surfaces_.find(&appearance); it != surfaces_.end()) {
    const RTid before = it->second.surface.shader;
    makeSurface(it->second);
    effect.other = it->second.surface.shader != before;
    const bool textured = isTextured(&appearance);
    effect.textured = textured && !it->second.textured;
    it->second.textured = textured;
  }
  if (const auto it = lines_.find(&appearance); it != lines_.end()) {
    const nodes::Material* material = partsOf(&appearance).material;
    const Color color = material ? convert(material->emissiveColor, linear_) : Surface().lineColor;
    effect.colored = !(color == it->second.surface.lineColor);
    it->second.surface.lineColor = color;
  }
  return effect;
}

// The same class and the same options: new values. Else a new shader takes its place.
void Surfaces::updateCustom(Node& node) {
  const auto it = custom_.find(&node);
  if (it == custom_.end()) return;
  auto& ort = static_cast<nodes::ORTShader&>(node);
  Custom& custom = it->second;
  std::vector<std::string> errors, names;
  const std::vector<ShaderOption> options = parseShaderOptions(ort.options, errors);
  for (const ShaderOption& option : options) names.push_back(option.name);
  if (custom.shader == 0 || custom.name != ort.name || custom.file != ort.file || names != custom.options || !errors.empty()) {
    const RTid before = custom.shader;
    custom = makeCustom(node);
    if (before != 0) rtDeleteShader(before);
    return;
  }
  ShaderSetup shader(custom.shader, sets_);
  for (const ShaderOption& option : options) {
    setOption(option, textures_, node);
    ++sets_;
  }
  report(world_.diagnostics, node.source, "ORTShader " + ort.name);
}

void Surfaces::clear() {
  for (const Entries* entries : {&surfaces_, &lines_})
    for (const auto& [node, entry] : *entries) forget(entry);
  for (const auto& [node, custom] : custom_)
    if (custom.shader != 0) rtDeleteShader(custom.shader);
}

void Surfaces::forget(const Entry& entry) {
  if (entry.own != 0) rtDeleteShader(entry.own);
}

// An ORTShader: class `name` of the library `file` (empty: stock), parameters by options. 0 and an error if there is no such
// class.
Surfaces::Custom Surfaces::makeCustom(Node& node) {
  auto& ort = static_cast<nodes::ORTShader&>(node);
  Custom custom{NodeRef(&node), 0, ort.name, ort.file, {}};
  const RTid shaderClass = classes_.get(ort.name, ort.file);
  if (!report(world_.diagnostics, node.source, "ORTShader") || shaderClass == 0) return custom;
  RTenum kind = 0;
  rtGetShaderClass(shaderClass, &kind, nullptr);
  if (kind != RT_SURFACE) {
    world_.diagnostics.error(node.source, "ORTShader: " + ort.name + " is not a surface shader");
    return custom;
  }
  std::vector<std::string> errors;
  const std::vector<ShaderOption> options = parseShaderOptions(ort.options, errors);
  for (const std::string& error : errors) world_.diagnostics.error(node.source, "ORTShader " + ort.name + ": " + error);
  ShaderSetup shader(shaderClass);
  custom.shader = shader.id();
  for (const ShaderOption& option : options) {
    custom.options.push_back(option.name);
    setOption(option, textures_, node);
    report(world_.diagnostics, node.source, "ORTShader " + ort.name + ", option " + option.name);
  }
  return custom;
}

} // namespace xvrml::mapping
