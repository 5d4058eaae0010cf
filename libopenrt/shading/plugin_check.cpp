// plugin_check.cpp: checks the rules of the shader ABI, with one function for each table. Called by
// the registry under its lock.
#include "shading/plugin_check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <stdexcept>
#include <utility>

namespace openrt {
namespace {

// Limit for structs with varying parameters, because every hit gets a copy of the struct.
constexpr uint32_t maxVaryingBytes = 1 << 14;
constexpr uint32_t maxClasses = 1024, maxParameters = 4096, maxParameterBytes = 1 << 20;
// A class contains at least the fields up to its parameter table. The fields behind are functions,
// which older minor versions may lack.
constexpr size_t minClassSize = offsetof(RtsClass, traits);

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw std::runtime_error("shader library " + path + ": " + why);
}

std::string version(unsigned major, unsigned minor) {
  return std::to_string(major) + "." + std::to_string(minor);
}

size_t parameterAlignment(RtsType type) {
  switch (type) {
  case RTS_FLOATS: return alignof(RtsFloats);
  case RTS_STRING: return alignof(const char*);
  default: return alignof(float);
  }
}

// Checks the header of a plug-in, which decides whether the rest may be read.
void checkHeader(const RtsPlugin* plugin, size_t symbolBytes, const std::string& path,
                 size_t minors) {
  if (symbolBytes != 0 && symbolBytes < sizeof(RtsPlugin))
    refuse(path, "its " RTS_ENTRY_NAME " has " + std::to_string(symbolBytes) +
                     " bytes; a plug-in's has at least " + std::to_string(sizeof(RtsPlugin)));
  if (plugin->magic != RTS_MAGIC) refuse(path, "not a shader plug-in (wrong magic number)");
  if (plugin->major != RTS_ABI_MAJOR || plugin->minor >= minors)
    refuse(path, "made for shader ABI " + version(plugin->major, plugin->minor) +
                     "; this library has " + version(RTS_ABI_MAJOR, unsigned(minors - 1)));
  if (plugin->size != sizeof(RtsPlugin))
    refuse(path, "claims a plug-in structure of " + std::to_string(plugin->size) + " bytes; ABI " +
                     version(plugin->major, plugin->minor) + " has " +
                     std::to_string(sizeof(RtsPlugin)));
  if (plugin->classCount == 0 || plugin->classCount > maxClasses || !plugin->classes)
    refuse(path, "claims " + std::to_string(plugin->classCount) + " shader classes");
}

void checkParameter(const RtsParam& param, uint32_t paramSize, const std::string& where) {
  if (!param.name || !*param.name) throw std::runtime_error(where + ": a parameter without a name");
  const std::string what = where + ": parameter " + param.name;
  const size_t bytes = parameterBytes(param.type);
  if (bytes == 0)
    throw std::runtime_error(what + ": unknown type " +
                             std::to_string(static_cast<unsigned>(param.type)));
  if (param.offset > paramSize || bytes > paramSize - param.offset)
    throw std::runtime_error(what + ": lies outside the parameter structure");
  if (param.offset % parameterAlignment(param.type) != 0)
    throw std::runtime_error(what + ": badly aligned");
  for (float value : param.defaultValue)
    if (!std::isfinite(value)) throw std::runtime_error(what + ": a default that is not finite");
  if (!(param.minimum <= param.maximum)) throw std::runtime_error(what + ": its range is empty");
}

void checkParameters(const RtsClass& shaderClass, const std::string& where) {
  if (shaderClass.paramSize > maxParameterBytes || shaderClass.paramCount > maxParameters ||
      (shaderClass.paramCount > 0 && !shaderClass.params))
    throw std::runtime_error(where + ": claims " + std::to_string(shaderClass.paramCount) +
                             " parameters in " + std::to_string(shaderClass.paramSize) + " bytes");
  std::set<std::string> names;
  std::vector<std::pair<size_t, size_t>> ranges;
  for (uint32_t i = 0; i < shaderClass.paramCount; i++) {
    const RtsParam& param = shaderClass.params[i];
    checkParameter(param, shaderClass.paramSize, where);
    if (!names.insert(param.name).second)
      throw std::runtime_error(where + ": two parameters called " + param.name);
    ranges.emplace_back(param.offset, param.offset + parameterBytes(param.type));
    const uint8_t frequency =
        shaderClass.frequency ? shaderClass.frequency[i] : uint8_t(RTS_PER_SHADER);
    const bool numbers = param.type >= RTS_FLOAT && param.type <= RTS_MATRIX;
    if (frequency != RTS_PER_SHADER && shaderClass.paramSize > maxVaryingBytes)
      throw std::runtime_error(where + ": parameter " + param.name +
                               ": cannot change by hit in a structure of " +
                               std::to_string(shaderClass.paramSize) + " bytes; at most " +
                               std::to_string(maxVaryingBytes));
    if (frequency > RTS_PER_VERTEX || (frequency != RTS_PER_SHADER && !numbers))
      throw std::runtime_error(where + ": parameter " + param.name +
                               ": cannot have this frequency");
  }
  std::sort(ranges.begin(), ranges.end());
  for (size_t i = 1; i < ranges.size(); i++)
    if (ranges[i].first < ranges[i - 1].second)
      throw std::runtime_error(where + ": two parameters share bytes");
}

void checkFunctions(const RtsClass& shaderClass, const std::string& where) {
  const char* missing = nullptr;
  switch (shaderClass.kind) {
  case RTS_SURFACE:
    missing = shaderClass.shade || shaderClass.surface ? nullptr : "shade or surface";
    break;
  case RTS_LIGHT: missing = shaderClass.illuminate ? nullptr : "illuminate"; break;
  case RTS_CAMERA: missing = shaderClass.generate ? nullptr : "generate"; break;
  case RTS_ENVIRONMENT: break; // both of its functions may be absent
  case RTS_TRANSPORT: missing = shaderClass.radiance ? nullptr : "radiance"; break;
  default:
    throw std::runtime_error(where + ": unknown kind " +
                             std::to_string(static_cast<unsigned>(shaderClass.kind)));
  }
  if (missing) throw std::runtime_error(where + ": lacks the function " + missing);
}

// largest: size of RtsClass in ABI 1.minor.
RtsClass checkClass(const RtsClass* theirs, unsigned minor, size_t largest,
                    const std::string& path) {
  if (!theirs) refuse(path, "an empty entry in its table of classes");
  if (theirs->size < minClassSize || theirs->size > sizeof(RtsClass))
    refuse(path, "claims a class structure of " + std::to_string(theirs->size) +
                     " bytes; this library knows " + std::to_string(minClassSize) + " to " +
                     std::to_string(sizeof(RtsClass)));
  if (theirs->size > largest)
    refuse(path, "claims a class structure of " + std::to_string(theirs->size) +
                     " bytes; that of ABI " + version(RTS_ABI_MAJOR, minor) + " has " +
                     std::to_string(largest));
  RtsClass ours{};
  // Copies whole pointers only: a partly copied function pointer would point anywhere.
  std::memcpy(&ours, theirs, theirs->size / sizeof(void*) * sizeof(void*));
  ours.size = theirs->size;
  if (!ours.name || !*ours.name) refuse(path, "a class without a name");
  const std::string where = "shader library " + path + ": class " + ours.name;
  checkParameters(ours, where);
  checkFunctions(ours, where);
  if (!ours.text) ours.text = "";
  return ours;
}

} // namespace

size_t parameterBytes(RtsType type) {
  switch (type) {
  case RTS_INT: return sizeof(int32_t);
  case RTS_FLOAT: return sizeof(float);
  case RTS_VEC2: return 2 * sizeof(float);
  case RTS_VEC3:
  case RTS_COLOR: return 3 * sizeof(float);
  case RTS_VEC4: return 4 * sizeof(float);
  case RTS_MATRIX: return 16 * sizeof(float);
  case RTS_FLOATS: return sizeof(RtsFloats);
  case RTS_STRING: return sizeof(const char*);
  case RTS_TEXTURE: return sizeof(RtsTexture);
  case RTS_TYPE_32_BITS: break;
  }
  return 0;
}

std::vector<RtsClass> checkPlugin(const RtsPlugin* plugin, size_t symbolBytes,
                                  const std::string& path, std::span<const size_t> classBytes) {
  checkHeader(plugin, symbolBytes, path, classBytes.size());
  std::vector<RtsClass> classes;
  std::set<std::string> names;
  for (uint32_t i = 0; i < plugin->classCount; i++) {
    classes.push_back(
        checkClass(plugin->classes[i], plugin->minor, classBytes[plugin->minor], path));
    if (!names.insert(classes.back().name).second)
      refuse(path, std::string("two classes called ") + classes.back().name);
  }
  return classes;
}

} // namespace openrt
