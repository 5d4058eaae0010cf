// faults.h: counts the errors in one geometry node and reports them in a single warning. A file
// with a million bad faces thus gives one line per node. Each builder makes one on the stack, on
// the caller's thread.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "xvrml/diagnostics.h"
#include "xvrml/node.h"

namespace xvrml {

enum class Fault : uint8_t {
  fewVertices,     // a face of fewer than 3 different vertices, or a line of fewer than 2
  indexRange,      // an index without a point
  notFinite,       // NaN or infinite coordinates
  noArea,          // all vertices are collinear
  tangled,         // crosses itself too often to be tessellated, or too large for that
  crossed,         // the only face of a list without -1, which crosses itself
  repeated,        // a face that names many of its points again, as if -1 were missing
  overLimit,       // beyond limits.triangles or the world's budget
  colorMissing,    // no colour for a face or vertex: white is used
  normalMissing,   // no usable normal: the face normal is used
  texCoordMissing, // no texture coordinates: 0 0 is used
  count
};

class Faults {
 public:
  // position: index in coordIndex, or face number. The first one is reported.
  void add(Fault fault, uint64_t position) {
    auto& entry = entries_[size_t(fault)];
    if (entry.count++ == 0) entry.first = position;
  }
  void note(std::string text) { notes_.push_back(std::move(text)); }
  bool any() const;
  // Reports one warning at the node, or a note if only invisible things were dropped. It reports
  // nothing without faults. limit: the name of the limit for Fault::overLimit.
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
