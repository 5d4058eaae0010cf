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
std::string writeRenderer(const Model& model); // xvrml/node_renderer.h: a callback per node
// Returns nodes_renderer.cpp: the function that calls these callbacks.
std::string writeRendererCalls(const Model& model);
// Returns the part of <plugin>_nodes.h with a callback per node.
std::string writePluginRenderer(const Model& model, const std::string& plugin);
// Returns the function of a plug-in that calls the callback of a node.
std::string writePluginCall(const TypeSpec& type, const std::string& plugin);
// Returns the first source file of a node's behaviour.
std::string writeSkeleton(const TypeSpec& type, const std::string& plugin);

// Names and values in C++.
std::string cppMember(const FieldSpec& field); // the field's name, followed by _ if C++ reserves it
// Returns the text between the braces of an initializer; "" for an empty value.
std::string cppInitializer(const Value& value);
std::string cppString(std::string_view text); // a string literal
std::string joinNames(const std::vector<Reference>& names);
std::string cppNotice(); // the first line of each generated file

// Calls function(type) for each node that is written.
template <class Function> void eachNode(const Component& component, Function function) {
  for (const TypeSpec& type : component.types)
    if (!type.isAbstract) function(type);
}
template <class Function> void eachNode(const Model& model, Function function) {
  for (const Component& component : model.components)
    if (!component.imported) eachNode(component, function);
}

} // namespace xvrml::nodegen
