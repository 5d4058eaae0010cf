// mesh_file.cpp: counts the memory and the faults of readers of meshes.
#include "parse/mesh/mesh_file.h"

#include <fmt/format.h>

namespace xvrml {

void Scratch::take(uint64_t bytes) {
  if (share_.take(bytes)) return;
  throw MeshFault{nullptr,
                  fmt::format("reading this mesh takes more memory than {}; the rest of it "
                              "is left out",
                              share_.budget()->name())};
}

void FaultCount::report(Locator& locator, Severity severity, std::string_view message) const {
  if (count_ == 0) return;
  const std::string text = fmt::format("{} {}{}", count_, message,
                                       count_ > 1 && first_ ? "; the first one is here" : "");
  severity == Severity::error ? locator.error(first_, text) : locator.warn(first_, text);
}

} // namespace xvrml
