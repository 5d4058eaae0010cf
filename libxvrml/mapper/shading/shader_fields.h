// shader_fields.h: fields that an ORTShader node declares, as parameters of its class. [the
// mapper's thread]
#pragma once

#include <string>
#include <vector>

#include "mapper/rt.h"
#include "xvrml/appearance.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {

// Says what is wrong with a field: the field is left out (error), or an option of the same name.
struct FieldProblem {
  const FieldInfo* field;
  bool isError;
  std::string text;
};

// Appends the values of the fields that the node declares. A field takes the place of options of
// the same name. A list of URLs that is empty, and NULL, leave the parameter as it is.
void addDeclaredFields(const nodes::ORTShader& node, const ShaderClass& shaderClass,
                       std::vector<ShaderOption>& options, std::vector<FieldProblem>& problems);

} // namespace xvrml::mapper
