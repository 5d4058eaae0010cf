// mesh_file.h: what the readers of meshes share (STL, PLY, OBJ, glTF, OFF; parse/encodings.h). A
// reader turns the bytes of a file into calls of a ParseSink, as the parser of VRML97 does, so that
// names, limits and messages are those of any world. [the thread that loads]
#pragma once

#include <deque>
#include <string>
#include <string_view>

#include "base/budget.h"
#include "base/locator.h"
#include "parse/sink.h"
#include "xvrml/file_head.h"
#include "xvrml/world.h"

namespace xvrml {

// A file that is being read, and where its nodes go.
struct MeshFile {
  std::string_view bytes;
  const std::string& path; // relative URLs count from it
  Locator& locator;
  ParseSink& sink;
  const LoadOptions& options;
  BudgetPtr budget;
  std::deque<std::string>& names; // DEF names; they live as long as the sink
};

// The reason why the rest of a file cannot be read. Readers throw it.
struct MeshFault {
  const char* at; // null: the file as a whole
  std::string message;
};

// Memory that a reader needs while it reads.
class Scratch {
 public:
  explicit Scratch(const BudgetPtr& budget) : share_(budget) {}
  // Reserves bytes of the world's budget before they are allocated. Throws MeshFault if not enough
  // are left.
  void take(uint64_t bytes);

 private:
  Share share_;
};

// Counts faults of one kind, to report them once: at the first one.
class FaultCount {
 public:
  void add(const char* at) {
    if (count_++ == 0) first_ = at;
  }
  // Reports "3 MESSAGE; the first one is here". Nothing if there were none.
  void report(Locator& locator, Severity severity, std::string_view message) const;

 private:
  uint64_t count_ = 0;
  const char* first_ = nullptr;
};

// Warns if coordinates of this size, in single precision, have steps of more than 1/10000 of the
// model's size. units: "units" or "metres".
void warnIfFar(Locator& locator, double away, double size, std::string_view units);

// Gathers the points of a file, to call warnIfFar() once.
class PointRange {
 public:
  PointRange& add(const MFVec3f& points);
  void report(Locator& locator) const;

 private:
  uint64_t count_ = 0;
  Vec3f least_{}, most_{};
};

} // namespace xvrml
