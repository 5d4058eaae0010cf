// appearance.cpp: see appearance.h. The lighting model is that of clause 4.14; the parameters are those of the class VRML97.
#include "openrt/appearance.h"

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

Surface Surfaces::of(Node* appearance, bool lines) {
  Node* node = renderedNode(appearance);
  auto& known = lines ? lines_ : surfaces_;
  const auto [it, fresh] = known.try_emplace(node);
  if (!fresh) return it->second;
  const Surface made = lines ? makeLines(node) : Surface{makeSurface(node)};
  return known[node] = made;
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

RTid Surfaces::makeSurface(Node* appearance) {
  const Parts parts = partsOf(appearance);
  if (parts.shader) {
    const auto [it, fresh] = custom_.try_emplace(parts.shader, 0);
    if (fresh) it->second = makeCustom(*parts.shader);
    if (it->second != 0) return it->second;
  }
  const RTid texture = textures_.ofNode(parts.texture); // may bind another texture, but no shader
  ShaderSetup shader(classes_.get("VRML97", ""));
  const nodes::Material standard(*findNodeType("Material"));
  const bool fallback = parts.shader != nullptr; // a shader that could not be had: shaded as a default Material
  const nodes::Material* m = parts.material ? parts.material : fallback ? &standard : nullptr;
  shader.integer("lit", m ? 1 : 0);
  if (m) {
    shader.color("diffuseColor", convert(m->diffuseColor, linear_));
    shader.color("emissiveColor", convert(m->emissiveColor, linear_));
    shader.color("specularColor", convert(m->specularColor, linear_));
    shader.number("ambientIntensity", m->ambientIntensity, 0, 1);
    shader.number("shininess", m->shininess, 0, 1);
    shader.number("transparency", m->transparency, 0, 1);
  }
  if (texture != 0) shader.texture("texture", texture);
  if (const nodes::TextureTransform* t = parts.textureTransform; t && texture != 0)
    shader.matrix("textureTransform", textureMatrix(t->center, t->rotation, t->scale, t->translation));
  report(world_.diagnostics, appearance ? appearance->source : SourcePosition(), "appearance");
  return shader.id();
}

// An ORTShader: class `name` of the library `file` (empty: stock), parameters by options. 0 and an error if there is no such
// class.
RTid Surfaces::makeCustom(Node& node) {
  auto& ort = static_cast<nodes::ORTShader&>(node);
  const RTid shaderClass = classes_.get(ort.name, ort.file);
  if (!report(world_.diagnostics, node.source, "ORTShader") || shaderClass == 0) return 0;
  RTenum kind = 0;
  rtGetShaderClass(shaderClass, &kind, nullptr);
  if (kind != RT_SURFACE) {
    world_.diagnostics.error(node.source, "ORTShader: " + ort.name + " is not a surface shader");
    return 0;
  }
  std::vector<std::string> errors;
  const std::vector<ShaderOption> options = parseShaderOptions(ort.options, errors);
  for (const std::string& error : errors) world_.diagnostics.error(node.source, "ORTShader " + ort.name + ": " + error);
  ShaderSetup shader(shaderClass);
  for (const ShaderOption& option : options) {
    setOption(option, textures_, node);
    report(world_.diagnostics, node.source, "ORTShader " + ort.name + ", option " + option.name);
  }
  return shader.id();
}

} // namespace xvrml::mapping
