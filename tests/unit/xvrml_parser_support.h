// xvrml_parser_support.h: helpers of the parser's tests.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace parser_test {

using namespace xvrml;

inline const std::string header = "#VRML V2.0 utf8\n";

inline std::unique_ptr<World> parse(const std::string& body, const LoadOptions& options = {}) {
  return loadWorldFromMemory(header + body, "test.wrl", options);
}

inline std::string messages(const World& world) {
  std::string text;
  for (const Diagnostic& diagnostic : world.diagnostics.list()) text += diagnostic.text() + '\n';
  return text;
}

inline bool says(const World& world, const std::string& fragment) {
  return messages(world).find(fragment) != std::string::npos;
}

// A temporary folder that is removed with the object.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "xvrml-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string write(const std::string& name, const std::string& text) const {
    const auto path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }
  std::string path(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

// Returns the value of a node's field, by name.
template <class T> const T& field(const Node& node, const std::string& name) {
  const FieldInfo* info = node.type().find(name);
  EXPECT_NE(info, nullptr) << name;
  return *static_cast<const T*>(node.storage(*info));
}

} // namespace parser_test
