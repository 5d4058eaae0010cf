#include "mapper/shading/custom_shaders.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "base/regular_file.h"

namespace xvrml::mapper {
namespace {

const char* roleName(RTenum role) {
  switch (role) {
  case RT_LIGHT: return "light";
  case RT_CAMERA: return "camera";
  case RT_ENVIRONMENT: return "environment";
  default: return "surface shader";
  }
}

// Returns how messages name an option or field, and the place that they tell.
std::string wordFor(const ShaderOption& option) {
  return (option.field ? "field " : "option ") + option.name;
}
const SourcePosition& placeOf(const Node& node, const FieldInfo* field) {
  return field ? static_cast<const nodes::ORTShader&>(node).placeOf(*field) : node.source;
}

MFString urlsOf(const ShaderOption& option) {
  MFString urls{option.text};
  urls.insert(urls.end(), option.otherUrls.begin(), option.otherUrls.end());
  return urls;
}

// Reads a whole regular text file into `text`. Returns the error, or "".
std::string readText(const std::string& path, uint64_t limit, std::string& text) {
  try {
    const RegularFile file(path);
    if (file.size() > limit) return path + " is longer than " + std::to_string(limit) + " bytes";
    text.resize(size_t(file.size()));
    if (file.read(0, text.data(), text.size()) != text.size())
      return path + " became shorter while it was read";
  } catch (const std::exception& failure) { return path + ": " + failure.what(); }
  return text.find('\0') == text.npos ? "" : path + " is not a text";
}

} // namespace

bool CustomShaders::take(ShaderEntry& made, uint64_t bytes) {
  if (!quota_.take(bytes, made.node->source)) return false;
  made.bytes += bytes;
  return true;
}

// Reports each problem of a node's fields once.
void CustomShaders::say(const Node& node, const std::vector<FieldProblem>& problems) {
  const std::string& name = static_cast<const nodes::ORTShader&>(node).name;
  for (const FieldProblem& one : problems) {
    const std::string text = "ORTShader " + name + ", field " + one.field->name + ": " + one.text;
    if (!said_.emplace(&node, text).second) continue;
    const SourcePosition& place = placeOf(node, one.field);
    if (one.isError)
      world_.diagnostics.error(place, text);
    else
      world_.diagnostics.warn(place, text);
  }
}

std::vector<ShaderOption> CustomShaders::optionsOf(ShaderEntry& made,
                                                   const ShaderClass& shaderClass,
                                                   std::vector<std::string>& errors) {
  quota_.give(std::exchange(made.bytes, 0));
  const auto& node = static_cast<const nodes::ORTShader&>(*made.node);
  std::vector<ShaderOption> options = parseShaderOptions(node.options, errors);
  std::vector<FieldProblem> problems;
  addDeclaredFields(node, shaderClass, options, problems);
  say(node, problems);
  uint64_t bytes = 0;
  for (const ShaderOption& option : options)
    bytes += bytesOfOption + option.name.size() +
             copiesOfOption * (option.text.size() + option.numbers.size() * sizeof(float));
  if (!take(made, bytes)) options.clear();
  return options;
}

void CustomShaders::setOption(const ShaderOption& option, ShaderEntry& made, RTenum role) {
  const Node& node = *made.node;
  const int handle = rtParameterHandle(option.name.c_str());
  const std::vector<float>& n = option.numbers;
  switch (option.type) {
  case ShaderOption::Type::integer:
  case ShaderOption::Type::boolean: return rtParameter1i(handle, option.integer);
  case ShaderOption::Type::text: return rtParameterString(handle, option.text.c_str());
  // The picture is clamped in t: the zenith of an environment map must not blend with its nadir.
  case ShaderOption::Type::texture:
  case ShaderOption::Type::node: {
    const RTid texture = option.picture
                             ? textures_.ofNode(renderedNode(option.picture.get()))
                             : textures_.ofUrls(urlsOf(option), node, true, role != RT_ENVIRONMENT);
    return rtParameterTexture(handle,
                              texture == 0 && role == RT_ENVIRONMENT ? textures_.black() : texture);
  }
  case ShaderOption::Type::list: return rtParameterfv(handle, n.size(), n.data());
  case ShaderOption::Type::file: {
    constexpr uint64_t longest = 1 << 24; // bytes of text that a parameter may hold
    const std::string& base = node.source.file ? *node.source.file : world_.path;
    std::string text, why;
    for (const std::string& url : urlsOf(option)) {
      const ResolvedUrl resolved = resolveUrl(url, base, world_.options);
      why = resolved.error;
      if (why.empty())
        why = readText(resolved.path, std::min(longest, world_.options.limits.fileBytes), text);
      if (why.empty()) break;
    }
    made.unreadable |= !why.empty();
    if (!why.empty())
      return world_.diagnostics.error(placeOf(node, option.field),
                                      "ORTShader: " + wordFor(option) + ": " + why);
    if (take(made, copiesOfOption * text.size())) rtParameterString(handle, text.c_str());
    return;
  }
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

RTid CustomShaders::shaderFor(nodes::ORTShader& node, RTenum role, const Node* user,
                              const Preset& preset) {
  const auto [it, fresh] = entries_.try_emplace({&node, user});
  ShaderEntry& made = it->second;
  if (fresh) {
    made.node = NodeRef(&node);
    make(made, role, preset);
  } else if (made.stale || (preset && made.shader != 0)) {
    refresh(made, role, preset);
  }
  made.stale = false;
  return made.shader;
}

// Makes a shader of class node.name from the library node.file (empty: built in).
void CustomShaders::make(ShaderEntry& made, RTenum role, const Preset& preset) {
  const auto& node = static_cast<const nodes::ORTShader&>(*made.node);
  made.shader = 0;
  made.unreadable = false;
  made.name = node.name;
  made.file = node.file;
  made.options.clear();
  const ShaderClass& shaderClass = classes_.find(node.name, node.file);
  if (!report(world_.diagnostics, node.source, "ORTShader") || shaderClass.id == 0) return;
  if (shaderClass.role != role) {
    const std::string an = role == RT_ENVIRONMENT ? " is not an " : " is not a ";
    world_.diagnostics.error(node.source, "ORTShader: " + node.name + an + roleName(role));
    return;
  }
  std::vector<std::string> errors;
  const std::vector<ShaderOption> options = optionsOf(made, shaderClass, errors);
  if (reported_.insert(&node).second)
    for (const std::string& error : errors)
      world_.diagnostics.error(node.source, "ORTShader " + node.name + ": " + error);
  ShaderSetup shader(shaderClass.id);
  made.shader = shader.id();
  if (preset) preset(shader, shaderClass);
  report(world_.diagnostics, node.source, "ORTShader " + node.name);
  for (const ShaderOption& option : options) {
    made.options.push_back(option.name);
    setOption(option, made, role);
    report(world_.diagnostics, placeOf(node, option.field),
           "ORTShader " + node.name + ", " + wordFor(option));
  }
  // A light without its profile is dark. Leave it out, so that it does not complain as well.
  if (made.unreadable && role == RT_LIGHT) {
    replaced_.push_back(made.shader);
    made.shader = 0;
  }
}

// Updates the parameters if class and options are the same and all values are good; otherwise makes
// a new shader that replaces the old one. An option with a wrong value would leave the old value.
void CustomShaders::refresh(ShaderEntry& made, RTenum role, const Preset& preset) {
  const auto& node = static_cast<const nodes::ORTShader&>(*made.node);
  std::vector<std::string> errors, names;
  const std::vector<ShaderOption> options =
      optionsOf(made, classes_.find(node.name, node.file), errors);
  for (const ShaderOption& option : options) names.push_back(option.name);
  if (made.shader != 0 && made.name == node.name && made.file == node.file &&
      names == made.options && errors.empty() && change(made, options, role, preset))
    return;
  const RTid before = made.shader;
  make(made, role, preset);
  if (before != 0) replaced_.push_back(before);
}

// Sets the parameters of an existing shader. Returns false if one of them was refused; make() tells
// which.
bool CustomShaders::change(ShaderEntry& made, const std::vector<ShaderOption>& options, RTenum role,
                           const Preset& preset) {
  const auto& node = static_cast<const nodes::ORTShader&>(*made.node);
  report(world_.diagnostics, node.source, "before ORTShader " + node.name);
  made.unreadable = false;
  const ShaderClass& shaderClass = classes_.find(node.name, node.file);
  ShaderSetup shader(shaderClass.id, made.shader, sets_);
  if (preset) preset(shader, shaderClass);
  for (const ShaderOption& option : options) {
    setOption(option, made, role);
    ++sets_;
  }
  bool good = !made.unreadable;
  while (rtGetError() != RT_NO_ERROR) good = false;
  return good;
}

void CustomShaders::changed(const Node& node) {
  reported_.erase(&node);
  for (auto it = entries_.lower_bound({&node, nullptr});
       it != entries_.end() && it->first.first == &node; ++it)
    it->second.stale = true;
}

void CustomShaders::forget(const Node& user) {
  std::erase_if(entries_, [&](const auto& entry) {
    if (entry.first.second != &user) return false;
    if (entry.second.shader != 0) replaced_.push_back(entry.second.shader);
    quota_.give(entry.second.bytes);
    return true;
  });
}

void CustomShaders::sweep() {
  for (const RTid shader : replaced_) rtDeleteShader(shader);
  replaced_.clear();
}

void CustomShaders::clear() {
  sweep();
  for (const auto& [key, made] : entries_)
    if (made.shader != 0) rtDeleteShader(made.shader);
  entries_.clear();
  said_.clear();
  quota_.clear();
}

} // namespace xvrml::mapper
