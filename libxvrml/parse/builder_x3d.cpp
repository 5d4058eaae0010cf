// builder_x3d.cpp: the statements of X3D, its spellings of names, and what it has and we lack
// (ISO/IEC 19775-1).
#include <fmt/format.h>

#include "base/x3d.h"
#include "nearest.h"
#include "parse/builder.h"
#include "parse/source.h"

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
    locator_.warn(name.at, fmt::format("{} is a part of a program for graphics processors: such "
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
  if (isX3d() && isGpuNode(type.text)) return reportGpuProgram(type);
  if (isX3d() && !isFirst(std::string(type.text))) return;
  const bool ofX3d = isX3dNode(type.text);
  if (isX3d() && ofX3d) {
    locator_.warn(type.at, fmt::format("nodes of type {} are not supported: they are left out here "
                                       "and below, with all that they hold",
                                       describe(type)));
    return;
  }
  locator_.error(type.at, fmt::format("{} is not a known node type{}{}", describe(type),
                                      ofX3d ? " (it is X3D's)" : "",
                                      nearest::suggestion(type.text, nodeTypes())));
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

void Builder::unit(const Name& category, const Name& name, double factor) {
  if (!reserveMemory(bytesOfName + category.text.size() + name.text.size(), category)) return;
  const bool matters = category.text == "length" || category.text == "angle";
  if (matters && factor != 1)
    locator_.warn(category.at,
                  fmt::format("units are not applied: numbers in {} are taken as {}",
                              describe(name), category.text == "length" ? "metres" : "radians"));
  file_.head.units.push_back({std::string(category.text), std::string(name.text), factor});
}

void Builder::importNode(const Name& keyword, const Name& local) {
  locator_.warn(keyword.at, fmt::format("IMPORT is not supported: what refers to {} is left out",
                                        describe(local)));
  lostName(local);
}

} // namespace xvrml
