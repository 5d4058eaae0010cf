#include "libpicture/shader_text.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "nearest.h"
#include "number_text.h"
#include "xvrml/appearance.h"
#include "xvrml/mapper.h"

namespace picture {

namespace {

struct Setting {
  std::string name, value;
};

// The parsed text "Class:a=1:b=2". A colon belongs to a value unless a name and an equals sign
// follow it.
struct Written {
  std::string library, name;
  std::vector<Setting> settings;
};

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (size_t at = 0;;) {
    const size_t end = text.find(separator, at);
    parts.push_back(text.substr(at, end == text.npos ? end : end - at));
    if (end == text.npos) return parts;
    at = end + 1;
  }
}

bool startsSetting(std::string_view part) {
  size_t i = 0;
  while (i < part.size() && (std::isalnum(static_cast<unsigned char>(part[i])) || part[i] == '_'))
    ++i;
  return i > 0 && i < part.size() && part[i] == '=';
}

Written readWritten(const std::string& text) {
  Written written;
  const std::vector<std::string_view> parts = split(std::string_view(text), ':');
  const std::string_view head = parts[0];
  const size_t slash = head.find('/');
  written.library = slash == head.npos ? "" : head.substr(0, slash);
  written.name = slash == head.npos ? head : head.substr(slash + 1);
  if (written.name.empty())
    throw ShaderError(fmt::format("the name of a shader class was expected, not \"{}\"", text));
  for (size_t i = 1; i < parts.size(); ++i) {
    if (startsSetting(parts[i])) {
      const size_t equals = parts[i].find('=');
      written.settings.push_back(
          {std::string(parts[i].substr(0, equals)), std::string(parts[i].substr(equals + 1))});
    } else if (!written.settings.empty()) {
      written.settings.back().value += ":" + std::string(parts[i]);
    } else {
      throw ShaderError(fmt::format("PARAM=VALUE was expected, not \"{}\"", parts[i]));
    }
  }
  return written;
}

std::vector<float> numbers(const std::string& text) {
  std::vector<float> list;
  for (std::string_view word : split(std::string_view(text), ',')) {
    while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
    if (word.starts_with('+')) word.remove_prefix(1);
    float value = 0;
    if (!isNumber(word, value))
      throw ShaderError(
          fmt::format("numbers, separated by commas, were expected, not \"{}\"", text));
    list.push_back(value);
  }
  return list;
}

size_t countOf(RTenum type) {
  switch (type) {
  case RT_PARAM_VEC2: return 2;
  case RT_PARAM_VEC3:
  case RT_PARAM_COLOR: return 3;
  case RT_PARAM_VEC4: return 4;
  case RT_PARAM_MATRIX: return 16;
  default: return 1;
  }
}

// Converts a path to a URL relative to the current folder, which the rules for a world's own URLs
// permit. Paths of a text that is confined to a folder are relative to that folder and stay inside.
std::string fileUrl(const std::string& path, const std::string& folder) {
  namespace fs = std::filesystem;
  fs::path place = path;
  if (!folder.empty()) {
    std::error_code error;
    const fs::path inside = fs::weakly_canonical(fs::absolute(folder), error);
    place = fs::weakly_canonical(inside / path, error);
    const fs::path relative = place.lexically_relative(inside);
    if (error || fs::path(path).is_absolute() || relative.empty() || *relative.begin() == "..")
      throw ShaderError(fmt::format("a file inside {} was expected, not \"{}\"", folder, path));
  }
  std::string url;
  for (const char c : place.is_absolute() ? fs::relative(place).string() : path)
    url += c == '%' ? "%25" : std::string(1, c);
  return url;
}

int wholeNumber(const std::string& text) {
  int value = 0;
  if (!isNumber(text, value))
    throw ShaderError(fmt::format("a whole number was expected, not \"{}\"", text));
  return value;
}

std::string quoted(const std::string& text) {
  if (text.find('\'') != text.npos)
    throw ShaderError("a quotation mark is not possible in " + text);
  return "'" + text + "'";
}

// Formats a value as an option of an ORTShader node.
std::string optionOf(const RTparameterInfo& info, const std::string& value,
                     const std::string& folder) {
  switch (info.type) {
  case RT_PARAM_TEXTURE:
    return fmt::format("texture {} {}", info.name, quoted(fileUrl(value, folder)));
  case RT_PARAM_STRING:
    if (value.starts_with('@'))
      return fmt::format("file {} {}", info.name, quoted(fileUrl(value.substr(1), folder)));
    return fmt::format("string {} {}", info.name, quoted(value));
  case RT_PARAM_INT: return fmt::format("1i {} {}", info.name, wholeNumber(value));
  default: break;
  }
  std::vector<float> list = numbers(value);
  const size_t count = countOf(info.type);
  if (info.type == RT_PARAM_COLOR && list.size() == 1) list.resize(3, list[0]);
  if (info.type != RT_PARAM_FLOATS && list.size() != count)
    throw ShaderError(fmt::format("{} number{} expected, not \"{}\"", count,
                                  count == 1 ? " was" : "s were", value));
  std::string option = info.type == RT_PARAM_FLOATS ? "floats " : fmt::format("{}f ", count);
  option += info.name;
  for (const float x : list) {
    if (x < info.minimum || x > info.maximum)
      throw ShaderError(fmt::format("{} is out of range: {} to {}", x, info.minimum, info.maximum));
    option += fmt::format(" {}", x);
  }
  return option;
}

// Returns the message of the last error without the name of the C function in front.
std::string lastMessage() {
  const std::string message = (rtGetError(), rtGetErrorMessage());
  const size_t colon = message.find(": ");
  return message.starts_with("rt") && colon != message.npos ? message.substr(colon + 2) : message;
}

// A context that draws nothing.
struct Lookup {
  const RTcontext before = rtGetCurrent();
  RTcontext context;
  explicit Lookup(const std::string& shaderPath) {
    const std::string config =
        "backend=null" + (shaderPath.empty() ? "" : " shaderpath=\"" + shaderPath + "\"");
    context = rtNewContext(config.c_str());
    if (!context) {
      const std::string why = lastMessage();
      rtMakeCurrent(before);
      throw ShaderError(why);
    }
  }
  ~Lookup() {
    rtDeleteContext(context);
    rtMakeCurrent(before);
  }
  Lookup(const Lookup&) = delete;
  Lookup& operator=(const Lookup&) = delete;
};

std::vector<std::string> optionsOf(const Written& written, RTenum role,
                                   const std::string& shaderPath, const std::string& folder,
                                   bool* showsColor) {
  const Lookup lookup(shaderPath);
  const RTid shaderClass = rtNewShaderClass(
      written.name.c_str(), written.library.empty() ? nullptr : written.library.c_str());
  if (shaderClass == 0) {
    const std::string why = lastMessage();
    throw ShaderError(why + (why.ends_with('?') ? "" : ";") +
                      " vv --list-shaders lists the classes");
  }
  RTenum found = 0;
  int count = 0;
  rtGetShaderClass(shaderClass, &found, &count);
  if (found != role)
    throw ShaderError(fmt::format("{} is a shader for a {}, not for a {}", written.name,
                                  roleName(found), roleName(role)));
  std::vector<RTparameterInfo> infos(size_t(std::max(count, 0)));
  std::vector<std::string> names, options;
  for (size_t i = 0; i < infos.size(); ++i) {
    rtGetParameterInfo(shaderClass, int(i), &infos[i]);
    names.emplace_back(infos[i].name);
  }
  for (const Setting& setting : written.settings) {
    const auto at = std::find(names.begin(), names.end(), setting.name);
    if (at == names.end()) {
      const std::string near = nearest::word(setting.name, names);
      std::string all;
      for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
      throw ShaderError(fmt::format("{} has no parameter {}{}", written.name, setting.name,
                                    !near.empty() ? fmt::format("; did you mean {}?", near)
                                    : all.empty() ? ", it has none at all"
                                                  : "; it has " + all));
    }
    try {
      options.push_back(optionOf(infos[size_t(at - names.begin())], setting.value, folder));
    } catch (const ShaderError& error) { throw ShaderError(setting.name + ": " + error.what()); }
  }
  if (showsColor) *showsColor = xvrml::takesMaterialColor(written.name, written.library);
  return options;
}

} // namespace

const char* roleName(RTenum role) {
  switch (role) {
  case RT_SURFACE: return "surface";
  case RT_LIGHT: return "light";
  case RT_CAMERA: return "camera";
  case RT_ENVIRONMENT: return "environment";
  default: return "transport";
  }
}

const char* parameterTypeName(RTenum type) {
  constexpr const char* names[] = {"int",   "float",  "vec2",   "vec3",   "vec4",
                                   "color", "matrix", "floats", "string", "texture"};
  return type >= RT_PARAM_INT && type <= RT_PARAM_TEXTURE ? names[type - RT_PARAM_INT] : "?";
}

xvrml::NodeRef readShader(const std::string& text, const char* option, RTenum role,
                          const std::string& shaderPath, const std::string& folder,
                          bool* showsColor) {
  try {
    const Written written = readWritten(text);
    const xvrml::NodeType& type = *xvrml::findNodeType("ORTShader");
    xvrml::NodeRef node(type.create(type));
    auto& shader = static_cast<xvrml::nodes::ORTShader&>(*node);
    shader.name = written.name;
    shader.file = written.library;
    shader.options = optionsOf(written, role, shaderPath, folder, showsColor);
    // The option, or a place in a file with a colon behind it.
    std::string where = option;
    if (where.ends_with(':')) where.pop_back();
    shader.source.file = std::make_shared<std::string>(std::move(where));
    return node;
  } catch (const ShaderError& error) {
    throw ShaderError(fmt::format("{} {}: {}", option, text, error.what()));
  }
}

std::string shaderText(const xvrml::nodes::ORTShader& shader, bool* isWhole) {
  using Type = xvrml::ShaderOption::Type;
  std::string text = shader.file.empty() ? shader.name : shader.file + "/" + shader.name;
  bool isAll = true;
  for (const xvrml::ShaderOption& option : xvrml::shaderOptions(shader)) {
    std::string value;
    if (option.type == Type::integer || option.type == Type::boolean)
      value = std::to_string(option.integer);
    else if (option.type == Type::text &&
             option.text.find_first_of(" \t\r\n,:'") == option.text.npos)
      value = option.text;
    else
      for (const float number : option.numbers)
        value += fmt::format("{}{}", value.empty() ? "" : ",", number);
    if (value.empty())
      isAll = false;
    else
      text += ":" + option.name + "=" + value;
  }
  if (isWhole) *isWhole = isAll;
  return text;
}

} // namespace picture
