// changes.cpp: tells what a written file shows otherwise, because the versions of the standard
// differ in what the same nodes mean (docs/versions.md). A pure function of the world.
#include <algorithm>

#include <fmt/format.h>

#include "write/writer.h"
#include "xvrml/nodes.h"
#include "xvrml/walk.h"

namespace xvrml {
namespace {

// Nodes of the world's own file that mean something else in the written one.
struct Counts {
  size_t textured = 0, coloured = 0, inlines = 0, limited = 0, bright = 0, lights = 0, matt = 0,
         askers = 0;
};

bool isWhite(const Color& c) { return c.r == 1 && c.g == 1 && c.b == 1; }

// Returns whether a colour texture and the diffuseColor meet, which VRML97 and X3D combine
// otherwise (4.14.3; ISO/IEC 19775-1 17.2.2.3).
bool mixesTexture(const Node& node) {
  const auto* look = nodeCast<nodes::Appearance>(&node);
  if (!look) return false;
  const auto* material = nodeCast<nodes::Material>(renderedNode(look->material.get()));
  return material && (look->texture || material->diffuseTexture) &&
         !isWhite(material->diffuseColor);
}

// Returns whether a texture and the colours of a geometry meet, likewise.
bool mixesColours(const Node& node) {
  const auto* shape = nodeCast<nodes::Shape>(&node);
  if (!shape) return false;
  const auto* look = nodeCast<nodes::Appearance>(renderedNode(shape->appearance.get()));
  const Node* const geometry = renderedNode(shape->geometry.get());
  if (!look || !look->texture || !geometry) return false;
  const FieldInfo* const field = geometry->type().find("color");
  return field && field->type == FieldType::SFNode &&
         *static_cast<const NodeRef*>(geometry->storage(*field));
}

float intensityOf(const Node& node) {
  if (const auto* light = nodeCast<nodes::DirectionalLight>(&node)) return light->intensity;
  if (const auto* light = nodeCast<nodes::PointLight>(&node)) return light->intensity;
  if (const auto* light = nodeCast<nodes::SpotLight>(&node)) return light->intensity;
  return 0;
}

// Returns whether the program in a Script asks the browser for files. The relative URLs in its text
// count from the file that holds the Script (ISO/IEC 19777-1), and are not rewritten.
bool asksForFiles(const Node& node) {
  const auto* script = nodeCast<ScriptNode>(&node);
  if (!script) return false;
  const Value url = script->get(*script->type().find("url"));
  const auto& programs = std::get<MFString>(url);
  return std::any_of(programs.begin(), programs.end(), [](const std::string& program) {
    return program.find("loadURL") != program.npos || program.find("FromURL") != program.npos;
  });
}

// Returns whether a file lies in another folder than the world's own.
bool movesTo(const World& world, const std::string& path) {
  if (path.empty() || world.path.empty() || world.path == "-") return false;
  return relativeUrl(world.path, path).find('/') != std::string::npos;
}

Counts countOf(const World& world, const FileVersion& to) {
  Counts counts;
  std::vector<const Node*> open;
  appendRoots(world.scope, open);
  for (const ProtoPtr& prototype : world.scope.prototypes) appendRoots(prototype->body, open);
  walk(std::move(open), [&](const Node& node, std::vector<const Node*>& next) {
    const FileVersion& from = versionOf(node);
    if (from.texturesMultiply() != to.texturesMultiply()) {
      counts.textured += mixesTexture(node);
      counts.coloured += mixesColours(node);
    }
    counts.askers += asksForFiles(node);
    counts.lights += node.type().is("light");
    counts.matt += from.encoding == Encoding::gltf && nodeCast<nodes::Material>(&node);
    counts.bright += from.major >= 4 && to.major < 4 && intensityOf(node) > 1;
    if (node.type().index == nodes::Inline::typeIndex) {
      ++counts.inlines;
      counts.limited +=
          from.major >= 4 && to.major < 4 && !static_cast<const nodes::Inline&>(node).global;
    }
    appendChildren(node, next);
  });
  return counts;
}

std::string several(size_t count, const char* thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

} // namespace

std::vector<std::string> changesByWriting(const World& world, Encoding encoding) {
  return changesByWriting(world, "", encoding);
}

std::vector<std::string> changesByWriting(const World& world, const std::string& path,
                                          Encoding encoding) {
  const FileVersion to = writtenVersion(world, encoding);
  const Counts counts = countOf(world, to);
  std::vector<std::string> changes;
  if (counts.textured > 0)
    changes.push_back(fmt::format("colour textures {} diffuseColor in {}: the look of {} changes",
                                  to.texturesMultiply() ? "multiply" : "replace",
                                  to.isX3d() ? "X3D" : "VRML97",
                                  several(counts.textured, "textured appearance")));
  if (counts.coloured > 0)
    changes.push_back(fmt::format("colour textures {} the colours of vertices and faces in {}: the "
                                  "look of {} changes",
                                  to.texturesMultiply() ? "multiply" : "replace",
                                  to.isX3d() ? "X3D" : "VRML97",
                                  several(counts.coloured, "textured shape")));
  for (const FileHead::Unit& unit : world.head.units)
    if (!to.isX3d() && unit.category == "length" && unit.factor != 1 && counts.inlines > 0)
      changes.push_back(fmt::format("VRML97 has no UNIT: the unit of lengths ({}) is lost, and "
                                    "Inlines of files with other units change their size",
                                    unit.name));
  if (counts.limited > 0)
    changes.push_back(fmt::format("before X3D 4 the lights of an Inline shine on the whole world: "
                                  "so will those of {}",
                                  several(counts.limited, "Inline")));
  if (counts.bright > 0)
    changes.push_back(fmt::format("before X3D 4 an intensity ends at 1: {} will be weaker",
                                  several(counts.bright, "light")));
  if (counts.matt > 0 && counts.lights > 0)
    changes.push_back(fmt::format("outside of glTF a Material is pi times as bright in a light: so "
                                  "will be {} without reflection",
                                  several(counts.matt, "surface")));
  if (counts.askers > 0 && movesTo(world, path))
    changes.push_back(fmt::format("relative URLs in the programs of Scripts stay as they are: {} "
                                  "will look for its files beside the written one",
                                  several(counts.askers, "Script")));
  return changes;
}

} // namespace xvrml
