// xvrml_geometry.cpp: parses arbitrary bytes as the body of a world. Every geometry node in it
// becomes a mesh, which must be sound. libFuzzer calls this on one thread.
#include <cmath>
#include <string>

#include "geometry/mesh.h"
#include "xvrml/world.h"

namespace {

using namespace xvrml;

void check(const Mesh& mesh) {
  for (uint32_t index : mesh.indices)
    if (index >= mesh.points.size()) __builtin_trap();
  for (const Vec3f& p : mesh.points)
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) __builtin_trap();
  for (size_t size : {mesh.normals.size(), mesh.texCoords.size(), mesh.colors.size()})
    if (size != 0 && size != mesh.points.size()) __builtin_trap();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) try {
  LoadOptions options;
  options.limits.expandedNodes = 10'000;
  options.limits.triangles = 100'000;
  const std::string text =
      "#VRML V2.0 utf8\n" + std::string(reinterpret_cast<const char*>(data), size);
  const auto world = loadWorldFromMemory(text, "fuzz.wrl", options);
  Diagnostics diagnostics;
  for (const NodeRef& root : world->scope.roots)
    for (bool textured : {false, true})
      check(buildMesh(*root, {textured, &options.limits, &diagnostics}));
  return 0;
} catch (const xvrml::LoadError&) { return 0; }
