// fields.h: Finds the fields and events that a client names. If a node has none of that name, or it
// cannot be used so, CommandError ("field") says what was probably meant. [any thread that owns the
// nodes]
#pragma once

#include <string>
#include <vector>

#include "xvrml/node.h"

namespace vv::json {

bool isReadable(const xvrml::FieldInfo& field);
bool isWritable(const xvrml::FieldInfo& field);
bool sends(const xvrml::FieldInfo& field);

// Returns the names of a node's fields and events that a test accepts, for messages.
std::vector<std::string> fieldNames(const xvrml::Node& node,
                                    bool (*test)(const xvrml::FieldInfo& field));
// use: completes "it cannot be". known: the names that could be.
[[noreturn]] void refuseField(const xvrml::Node& node, const std::string& name, const char* use,
                              const std::vector<std::string>& known);

const xvrml::FieldInfo& readableField(const xvrml::Node& node, const std::string& name);
const xvrml::FieldInfo& writableField(const xvrml::Node& node, const std::string& name);
// Returns a field or exposedField, by its own name.
const xvrml::FieldInfo& storedField(const xvrml::Node& node, const std::string& name);

} // namespace vv::json
