// shader_parameters.h: The parameters of a shader's class, as fields that an ORTShader declares or
// could declare. [the browser's thread, while the world can be used]
#pragma once

#include <optional>

#include "edit/world_editor.h"
#include "xvrml/nodes.h"

namespace vv {

// Returns the class of a shader; null: no plug-in that is installed has it.
const picture::ShaderClass* classOf(WorldEditor& editor, const xvrml::nodes::ORTShader& shader);

// Returns the field that an ORTShader declares for a parameter, with the default of the class, its
// range and what it does. Nothing for matrices.
std::optional<xvrml::FieldInfo> fieldFor(const picture::ShaderParameter& parameter);

// Returns whether the `options` of a shader set a parameter.
bool isInOptions(const xvrml::nodes::ORTShader& shader, const std::string& parameter);

// Declares a field for a parameter, with this value. Another ORTShader takes the place of the node,
// which is selected then if the node was.
void declareParameter(WorldEditor& editor, const xvrml::NodeRef& shader, const std::string& name,
                      const xvrml::Value& value);

} // namespace vv
