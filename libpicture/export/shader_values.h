// shader_values.h: The values of the parameters of an ORTShader: the defaults of its class, the
// fields of the material beside it, and what the node sets. [the thread that owns the world]
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libpicture/shader_classes.h"
#include "xvrml/renderer.h"

namespace picture {

class ShaderValues {
 public:
  bool has(std::string_view name) const { return values_.contains(name); }
  float number(std::string_view name) const;
  xvrml::Color color(std::string_view name) const; // linear
  // Returns the name of the first parameter that is a colour; "" if there is none.
  std::string_view firstColor() const { return firstColor_; }
  // Returns the name of the parameter that takes the colour of a material; "" if there is none.
  std::string_view materialColor() const;
  // Returns the value that a parameter of another type has; null: the node does not set it.
  const xvrml::ShaderOption* given(std::string_view name) const;

 private:
  friend class ShaderTables;
  void set(std::string_view name, const xvrml::Color& value);
  void set(std::string_view name, float value);
  void setMaterial(const xvrml::MaterialValues& material);

  std::map<std::string, std::vector<float>, std::less<>> values_;
  std::string firstColor_;
  std::vector<xvrml::ShaderOption> options_;
};

// The classes of the installed plug-ins, which are read when the first shader asks for them.
class ShaderTables {
 public:
  explicit ShaderTables(std::string shaderPath) : shaderPath_(std::move(shaderPath)) {}
  // Returns nothing if no plug-in has the class.
  std::optional<ShaderValues> valuesOf(const xvrml::AppearanceParts& parts);

 private:
  std::string shaderPath_;
  std::optional<std::vector<ShaderClass>> classes_;
};

} // namespace picture
