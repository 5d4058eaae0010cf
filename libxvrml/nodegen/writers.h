// writers.h: the files that nodegen writes from a checked Model. Each function returns the text of
// one file. Imported components are left out.
#pragma once

#include <string>

#include "nodegen/model.h"

namespace xvrml::nodegen {

// Returns xvrml/nodes.h or <plugin>_nodes.h: one struct per node. plugin: the plug-in's name; ""
// for the library's own nodes.
std::string writeHeader(const Model& model, const std::string& plugin);
// Returns nodes_<component>.cpp: the constant tables of a component.
std::string writeTables(const Component& component, const std::string& plugin);
std::string writeList(const Model& model);      // nodes_list.cpp: builtinNodeTypes()
std::string writeReference(const Model& model); // Markdown page of all nodes
std::string writeStub(const Model& model);      // Python stub of the node classes
// Returns <plugin>_plugin.cpp: the exported constant.
std::string writePlugin(const Model& model, const std::string& plugin);
// Returns the first source file of a node's behaviour.
std::string writeSkeleton(const TypeSpec& type, const std::string& plugin);

// Names and values in C++.
std::string cppMember(const FieldSpec& field); // the field's name, followed by _ if C++ reserves it
// Returns the text between the braces of an initializer; "" for an empty value.
std::string cppInitializer(const Value& value);
std::string cppString(std::string_view text); // a string literal
std::string joinNames(const std::vector<Reference>& names);

} // namespace xvrml::nodegen
