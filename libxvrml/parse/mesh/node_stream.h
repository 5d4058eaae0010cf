// node_stream.h: writes nodes with their fields into a ParseSink. The readers of meshes use it,
// because they make whole nodes and have no text of them. Arrays are moved into the nodes. A node
// or field that the sink does not know is left out with all that it would hold, after the sink's
// message. [the thread that loads]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "parse/mesh/mesh_file.h"

namespace xvrml {

class NodeStream {
 public:
  explicit NodeStream(const MeshFile& file) : file_(file) {}

  // Opens a node; close() closes it. `type` and the names of fields must be literals. def: a name
  // from define(), or empty.
  void open(std::string_view type, std::string_view def = {});
  void close();
  // Opens a field that holds nodes.
  void openField(std::string_view field);
  void closeField();
  // Opens a field with one node, as `field Type { ... }`; closeIn() closes both.
  void openIn(std::string_view field, std::string_view type, std::string_view def = {});
  void closeIn();
  void use(std::string_view def);
  void useIn(std::string_view field, std::string_view def);
  void route(std::string_view from, std::string_view fromField, std::string_view to,
             std::string_view toField);

  // Sets a field of the open node. T must be the C++ type of the field.
  template <class T> void set(std::string_view field, T value);
  // Sets a field of one string.
  void setUrl(std::string url) { set("url", MFString{std::move(url)}); }

  // Returns a DEF name made from a name of the file: valid in every encoding, and unique here. An
  // empty name gives `otherwise`.
  std::string_view define(std::string_view name, std::string_view otherwise);
  // Returns whether there is such a node type, or a field of one.
  bool knows(std::string_view type) const { return file_.sink.typeNamed(type); }
  bool knows(std::string_view type, std::string_view field) const;

 private:
  bool skips() const { return skipped_ > 0; }

  const MeshFile& file_;
  uint64_t skipped_ = 0;    // open nodes and fields within one that is left out
  std::vector<bool> known_; // for each open node or field: the sink has it
  std::unordered_map<std::string, uint64_t> used_; // DEF names, with the last number given to each
  bool full_ = false;                              // the budget has refused an array; reported once
};

} // namespace xvrml
