// builder_x3d.cpp: the statements of X3D, its spellings of names, and what it has and we lack
// (ISO/IEC 19775-1).
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/x3d.h"
#include "graph/inline_node.h"
#include "nearest.h"
#include "nodes/registry.h"
#include "parse/builder.h"
#include "parse/source.h"
#include "xvrml/nodes.h"

namespace xvrml {

// Returns the name that our tables have for a field or event of a node in this file.
std::string_view Builder::spelled(const NodeType& type, std::string_view name) const {
  return isX3d() && type.index >= 0 ? ownName(type.name, name) : name;
}

// Returns the word for an access in this file's standard.
std::string_view Builder::word(Access access) const {
  return isX3d() ? x3dAccessName(access) : accessName(access);
}

// Returns whether X3D gives a node of ours a field or event that we do not have.
bool Builder::lacksField(const NodeType& type, std::string_view name) const {
  return isX3d() && (type.index >= 0 || type.name == "Script") && isX3dField(type.name, name);
}

// Reports once for a file that shaders are not run.
void Builder::reportGpuProgram(const Name& name) {
  if (isFirst("shaders"))
    locator_.warn(name.at,
                  fmt::format("{} is a part of a program for graphics processors: such "
                              "programs are not run, and shapes look as their materials say",
                              describe(name)));
}

// Reports such a field or event, once for each name. Returns false for other names and in files of
// VRML97.
bool Builder::isMissingField(const NodeType& type, const Name& name) {
  if (!lacksField(type, name.text)) return false;
  if (isGpuField(name.text)) {
    reportGpuProgram(name);
    return true;
  }
  if (isFirst(fmt::format("{}.{}", type.name, name.text)))
    locator_.warn(name.at, fmt::format("field {} of {} is not supported: it is left out here and "
                                       "below",
                                       describe(name), type.name));
  return true;
}

// Reports a node type that is not known. In an X3D file each type is reported once.
void Builder::reportUnknownNode(const Name& type) {
  const nodes::AbsentNode* const absent = findAbsentNode(type.text);
  const bool ofX3d = absent && absent->origin.empty();
  if (isX3d() && ofX3d && absent->kind == "program") return reportGpuProgram(type);
  if (isX3d() && !isFirst(std::string(type.text))) return;
  if (isX3d() && absent) {
    locator_.warn(type.at, fmt::format("nodes of type {} ({}{}{}) are not supported and are left "
                                       "out here and below, with all that they hold: {}",
                                       describe(type), absent->kind, ofX3d ? "" : " of ",
                                       absent->origin, absent->loss));
    return;
  }
  locator_.error(type.at, fmt::format("{} is not a known node type{}{}", describe(type),
                                      ofX3d ? " (it is X3D's)" : "",
                                      nearest::suggestion(type.text, nodeTypes())));
}

// Notes the first place on a globe that the world names, and warns of systems that are not known.
// Nodes in prototypes get their places with the instances.
void Builder::noteGlobe(const NodeFrame& frame) {
  const Node& node = *frame.node;
  const auto* origin = nodeCast<nodes::GeoOrigin>(&node);
  const auto* location = nodeCast<nodes::GeoLocation>(&node);
  const auto* viewpoint = nodeCast<nodes::GeoViewpoint>(&node);
  const auto* grid = nodeCast<nodes::GeoElevationGrid>(&node);
  if ((!origin && !location && !viewpoint && !grid) || inTemplate()) return;
  const auto place = origin      ? placeOnGlobe(origin->geoSystem, origin->geoCoords)
                     : location  ? placeOnGlobe(location->geoSystem, location->geoCoords)
                     : viewpoint ? placeOnGlobe(viewpoint->geoSystem, viewpoint->position)
                                 : placeOnGlobe(grid->geoSystem, grid->geoGridOrigin);
  if (!place) {
    locator_.warn(frame.type.at,
                  fmt::format("{} names no place: expected the geoSystem GD, UTM with a zone such "
                              "as Z10, or GC, and coordinates within it (ISO/IEC 19775-1 25.2.3)",
                              describe(frame.type)));
  } else if (!state_.globe->place || (state_.globe->isCorner && !grid)) {
    *state_.globe = {place, origin && origin->rotateYUp, grid != nullptr};
  }
}

// Warns once for a file what of a node is not done.
void Builder::warnOfLack(const NodeType& type, const Name& at) {
  const std::string_view lack = lackOf(type);
  if (!lack.empty() && isFirst(fmt::format("{} lacks", type.name)))
    locator_.warn(at.at, fmt::format("{} is not supported wholly: {}", describe(at), lack));
}

// Warns once in a file of VRML97 that a node is X3D's.
void Builder::warnOfX3d(const NodeType& type, const Name& at) {
  if (type.standard != Standard::x3d || !isVrml97() || !isFirst(type.name)) return;
  locator_.warn(at.at, fmt::format("{} is a node of X3D: other browsers of VRML97 do not know it",
                                   describe(at)));
}

// Warns once in a file of VRML97 that a field is X3D's.
void Builder::warnOfX3d(const NodeType& type, const FieldInfo& field, const Name& at) {
  if (!field.ofX3d || !isVrml97() || !isFirst(fmt::format("{}.{}", type.name, field.name))) return;
  locator_.warn(at.at, fmt::format("{} is a field that X3D adds to {}: other browsers of VRML97 do "
                                   "not know it",
                                   describe(at), type.name));
}

void Builder::version(int major, int minor) {
  file_.head.version.major = major;
  file_.head.version.minor = minor;
  setFileVersion(locator_.file(), file_.head.version);
}

void Builder::profile(const Name& name) {
  if (reserveMemory(bytesOfName + name.text.size(), name)) file_.head.profile = name.text;
}

void Builder::component(const Name& name, int32_t level) {
  if (reserveMemory(bytesOfName + name.text.size(), name))
    file_.head.components.push_back({std::string(name.text), level});
}

void Builder::meta(const Name& keyword, std::string name, std::string content) {
  if (reserveMemory(bytesOfName + name.size() + content.size(), keyword))
    file_.head.meta.push_back({std::move(name), std::move(content)});
}

// UNIT: angles are converted where they are read. The length counts where the file is the content
// of an Inline (Loader::setContent); nothing that we have depends on mass and force.
void Builder::unit(const Name& category, const Name& name, double factor) {
  constexpr std::string_view categories[] = {"angle", "force", "length", "mass"};
  const bool known = std::find(std::begin(categories), std::end(categories), category.text) !=
                     std::end(categories);
  const auto& units = file_.head.units;
  const bool twice = std::any_of(units.begin(), units.end(), [&](const FileHead::Unit& one) {
    return one.category == category.text;
  });
  if (!(factor >= 1e-15 && factor <= 1e15)) { // a quotient of two is a float, too
    locator_.error(name.at,
                   fmt::format("one {} is {} {}s: expected a number from 1e-15 to 1e15; the unit "
                               "is left out",
                               describe(name), factor, known ? category.text : "unit"));
    return;
  }
  if (!known || twice) {
    locator_.warn(category.at,
                  fmt::format("{}: the unit is left out",
                              known ? fmt::format("there is a unit of {} already", category.text)
                                    : fmt::format("{} has no unit: expected angle, force, length "
                                                  "or mass (ISO/IEC 19775-1 4.3.6)",
                                                  describe(category))));
    return;
  }
  if (!reserveMemory(bytesOfName + category.text.size() + name.text.size(), category)) return;
  if (category.text == "angle") angle_ = factor;
  if (category.text == "length") setLengthUnit(locator_.file(), factor);
  file_.head.units.push_back({std::string(category.text), std::string(name.text), factor});
}

// Returns whether the numbers of a field are angles. A field of a prototype's interface is what it
// IS in the body.
bool Builder::isAngle(const Node& node, const FieldInfo& field) const {
  if (field.type == FieldType::SFRotation || field.type == FieldType::MFRotation) return true;
  if (field.type != FieldType::SFFloat && field.type != FieldType::MFFloat) return false;
  std::vector<std::pair<const Node*, std::string_view>> open{{&node, field.name}};
  for (size_t i = 0; i < open.size() && i < 1000; ++i) {
    const auto [one, name] = open[i];
    if (one->type().index >= 0 && isAngleField(one->type().name, name)) return true;
    if (const auto* instance = nodeCast<ProtoInstance>(one))
      for (const IsConnection& connection : instance->declaration->is)
        if (connection.interfaceName == name)
          open.emplace_back(connection.node.get(), connection.field);
  }
  return false;
}

// Converts angles in the file's unit to radians.
void Builder::convertAngles(FieldType type, void* storage) const {
  constexpr double most = std::numeric_limits<float>::max();
  const auto inRadians = [&](float angle) {
    return std::clamp(double(angle) * angle_, -most, most); // a file's NaN stays one
  };
  const auto turn = [&](float& angle) { angle = float(inRadians(angle)); };
  // 180 degrees must not become more than pi, where the range of a field ends.
  const auto convert = [&](float& angle) {
    const double exact = inRadians(angle);
    angle = float(exact);
    if (std::abs(double(angle)) > std::abs(exact)) angle = std::nextafter(angle, 0.0f);
  };
  if (type == FieldType::SFFloat) convert(*static_cast<SFFloat*>(storage));
  if (type == FieldType::SFRotation) turn(static_cast<SFRotation*>(storage)->angle);
  if (type == FieldType::MFFloat)
    for (float& one : *static_cast<MFFloat*>(storage)) convert(one);
  if (type == FieldType::MFRotation)
    for (Rotation& one : *static_cast<MFRotation*>(storage)) turn(one.angle);
}

Exchange& Builder::exchange() {
  if (!file_.exchange) file_.exchange = std::make_shared<Exchange>();
  return *file_.exchange;
}

bool Builder::isImported(std::string_view name) const {
  return !inTemplate() && imports_.contains(name);
}

// IMPORT: the name is for routes. They are connected when the Inline has its content.
void Builder::importNode(const Name& keyword, const ImportNames& names) {
  if (inTemplate()) {
    locator_.warn(keyword.at, fmt::format("IMPORT in a prototype is not supported: what refers to "
                                          "{} is left out",
                                          describe(names.local)));
    return lostName(names.local);
  }
  const NodeRef node = findName(names.inlineName);
  auto* const inlineNode = nodeCast<InlineNode>(node);
  if (node && !inlineNode)
    locator_.error(names.inlineName.at,
                   fmt::format("IMPORT takes nodes from the file of an Inline, but {} is a node of "
                               "type {}",
                               describe(names.inlineName), node->type().name));
  const bool taken =
      scope().scope->names.contains(names.local.text) || imports_.contains(names.local.text);
  if (inlineNode && taken)
    locator_.error(names.local.at, fmt::format("the name {} of an imported node is taken already "
                                               "(ISO/IEC 19775-1 4.4.6)",
                                               describe(names.local)));
  if (inlineNode && taken) return;
  if (!inlineNode ||
      !reserveMemory(bytesOfName + names.exported.text.size() + names.local.text.size(), keyword))
    return lostName(names.local);
  inlineNode->importer = (exchange(), file_.exchange);
  imports_.emplace(names.local.text, exchange().imports.size());
  exchange().imports.push_back({node, std::string(names.exported.text),
                                std::string(names.local.text), locator_.place(keyword.at)});
}

void Builder::exportNode(const Name& node, const Name& exported) {
  if (inTemplate()) {
    locator_.error(node.at, "EXPORT cannot stand in a prototype (ISO/IEC 19775-1 4.4.6)");
    return;
  }
  exports_.emplace_back(node, exported);
}

// Keeps a route with an imported end until the Inline has its content. Returns false if neither end
// is imported.
bool Builder::importedRoute(const Name& keyword, const RouteNames& names) {
  if (!isImported(names.from.text) && !isImported(names.to.text)) return false;
  const auto end = [&](const Name& name, const Name& field, bool out) {
    Exchange::End result{{}, 0, std::string(field.text)};
    if (isImported(name.text)) {
      result.import = imports_.at(name.text);
    } else if ((result.node = findName(name))) {
      const NodeType& type = result.node->type();
      const std::string_view own = spelled(type, field.text);
      const bool has = out ? type.findEventOut(own) : type.findEventIn(own);
      if (!has && !isMissingField(type, field))
        locator_.error(field.at, fmt::format("{} has no {} {}", type.name,
                                             word(out ? Access::eventOut : Access::eventIn),
                                             describe(field)));
      if (has)
        scope().placed.insert(name.text);
      else
        result.node = {};
    }
    return result;
  };
  const Exchange::End from = end(names.from, names.fromField, true);
  const Exchange::End to = end(names.to, names.toField, false);
  const bool good =
      (from.node || isImported(names.from.text)) && (to.node || isImported(names.to.text));
  if (!good || !reserveMemory(bytesOfRoute, keyword)) return true;
  exchange().routes.push_back({from, to, locator_.place(keyword.at)});
  return true;
}

} // namespace xvrml
