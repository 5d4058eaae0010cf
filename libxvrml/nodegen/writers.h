// writers.h: what nodegen writes from a checked Model. Each function returns the text of one file;
// imported components are left out.
#pragma once

#include <string>

#include "nodegen/model.h"

namespace xvrml::nodegen {

// plugin: the plug-in's name; empty: the library's own nodes.
std::string
writeHeader(const Model& model,
            const std::string& plugin); // xvrml/nodes.h, <plugin>_nodes.h: a struct per node
std::string writeTables(const Component& component,
                        const std::string& plugin); // nodes_<component>.cpp: its constant tables
std::string writeList(const Model& model);          // nodes_list.cpp: builtinNodeTypes()
std::string writeReference(const Model& model);     // Markdown page of all nodes
std::string writeStub(const Model& model);          // Python stub of the node classes
std::string writePlugin(const Model& model,
                        const std::string& plugin); // <plugin>_plugin.cpp: the exported constant
std::string writeSkeleton(const TypeSpec& type,
                          const std::string& plugin); // first source of a node's behaviour

// Names and values in C++.
std::string cppMember(const FieldSpec& field); // the field's name, with _ behind if C++ keeps it
std::string
cppInitializer(const Value& value); // what stands between the braces; empty for the neutral value
std::string cppString(std::string_view text); // a string literal
std::string joinNames(const std::vector<Reference>& names);

} // namespace xvrml::nodegen
