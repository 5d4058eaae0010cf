// faults.h: counts what one geometry node has wrong and says it in a single warning, so that a file
// of a million bad faces gives one line a node. Made on the stack by each builder, on the caller's
// thread.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "xvrml/diagnostics.h"
#include "xvrml/node.h"

namespace xvrml {

enum class Fault : uint8_t {
  fewVertices,     // a face of fewer than 3 different vertices, a line of fewer than 2
  indexRange,      // an index without a point
  notFinite,       // NaN or infinite coordinates
  noArea,          // all vertices on one line
  tangled,         // too large, or crosses itself too often, to be tessellated
  overLimit,       // beyond limits.triangles, or what the world's budget allows
  colorMissing,    // no colour for a face or vertex: white
  normalMissing,   // no usable normal: the face's own
  texCoordMissing, // no texture coordinates: 0 0
  count
};

class Faults {
 public:
  // position: where in coordIndex (or which face) it happened; the first one is told.
  void add(Fault fault, uint64_t position) {
    auto& entry = entries_[size_t(fault)];
    if (entry.count++ == 0) entry.first = position;
  }
  void note(std::string text) { notes_.push_back(std::move(text)); }
  bool any() const;
  // Gives one warning at the node's place, none if nothing was wrong; a note if only that is
  // dropped which nobody can see. limit: what Fault::overLimit speaks of.
  void report(const Node& node, Diagnostics* diagnostics, std::string_view limit) const;

 private:
  bool invisible() const;
  struct Entry {
    uint64_t count = 0, first = 0;
  };
  std::array<Entry, size_t(Fault::count)> entries_;
  std::vector<std::string> notes_;
};

} // namespace xvrml
