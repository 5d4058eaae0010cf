// shader_parameters.h: The parameters of a shader's class, as fields that an ORTShader declares or
// could declare. [the browser's thread, while the world can be used]
#pragma once

#include <map>
#include <optional>
#include <string>

#include "edit/world_editor.h"
#include "xvrml/appearance.h"
#include "xvrml/nodes.h"

namespace vv {

// Returns the class that an ORTShader names; null: no plug-in that is installed has it. file: ""
// for any plug-in.
const picture::ShaderClass* classOf(WorldEditor& editor, const std::string& name,
                                    const std::string& file);

// Returns the field that an ORTShader declares for a parameter, with the default of the class, its
// range and what it does. Nothing for matrices.
std::optional<xvrml::FieldInfo> fieldFor(const picture::ShaderParameter& parameter);

// Returns the options of a shader that set a parameter, by its name.
std::map<std::string, xvrml::ShaderOption> optionsOf(const xvrml::nodes::ORTShader& shader);
// Returns the value that an option gives to a parameter, as one of the field for it; nothing if it
// is no number.
std::optional<xvrml::Value> valueOf(const xvrml::ShaderOption& option,
                                    const picture::ShaderParameter& parameter);

// Sets a parameter that the shader does not declare: in its options, if they set it to numbers;
// else it declares a field. Then another ORTShader takes the place of the node, which is selected
// if the node was.
void setParameter(WorldEditor& editor, const xvrml::NodeRef& shader, const std::string& name,
                  const xvrml::Value& value);

} // namespace vv
