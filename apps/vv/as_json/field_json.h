// field_json.h: Converts values of fields to and from JSON. The shapes are those of
// docs/control.md; bindings/python/convert.cpp has the same ones for Python. [any thread]
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "as_json/json_line.h"
#include "xvrml/node.h"

namespace vv::json {

// Returns the node that a JSON value names. Throws CommandError.
using FindNode = std::function<xvrml::NodeRef(const Json& name)>;
// Returns the number by which a client may name a node. Throws CommandError.
using NumberOfNode = std::function<uint64_t(const xvrml::NodeRef& node)>;

// Reads a value for a field or event. `owner` has the field. Throws CommandError ("value", or what
// findNode throws) that says where in the value something is wrong, and what was expected: a wrong
// type or count, a number outside of the field's range or of 32 bits, a node that the field does
// not accept.
xvrml::Value readValue(const Json& json, const xvrml::Node& owner, const xvrml::FieldInfo& field,
                       const FindNode& findNode);

// Appends a value as JSON. Numbers that are not finite become null. Throws what numberOf throws.
void appendValue(std::string& out, const xvrml::Value& value, const NumberOfNode& numberOf);

} // namespace vv::json
