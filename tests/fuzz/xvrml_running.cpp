// xvrml_running.cpp: arbitrary bytes as a world of X3D that runs for some ticks: particles, motions
// of figures, interpolators and whatever else has the time. Then every geometry, also those that
// stand for particles, becomes a mesh with places in space, which must be sound. libFuzzer calls
// this on one thread.
#include <cmath>
#include <string>

#include "geometry/mesh.h"
#include "graph/expansion.h"
#include "xvrml/browser.h"
#include "xvrml/walk.h"

namespace {

using namespace xvrml;

template <class Vectors> bool isFinite(const Vectors& vectors) {
  for (const auto& v : vectors)
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) return false;
  return true;
}

void check(const Mesh& mesh) {
  for (uint32_t index : mesh.indices)
    if (index >= mesh.points.size()) __builtin_trap();
  if (!isFinite(mesh.points) || !isFinite(mesh.normals) || !isFinite(mesh.texPlaces))
    __builtin_trap();
  for (size_t size : {mesh.normals.size(), mesh.texCoords.size(), mesh.texPlaces.size(),
                      mesh.colors.size(), mesh.alphas.size(), mesh.fogCoords.size()})
    if (size != 0 && size != mesh.points.size()) __builtin_trap();
}

// Checks the meshes of a world, and of what stands for its nodes.
void checkMeshes(World& world, const Limits& limits) {
  Diagnostics diagnostics;
  walk(rootsOf(world.scope), [&](Node& node, std::vector<Node*>& open) {
    for (const bool inSpace : {false, true}) {
      MeshOptions options{.needTexCoords = true, .limits = &limits, .diagnostics = &diagnostics};
      options.needTexPlaces = inSpace;
      check(buildMesh(node, options));
    }
    if (Node* const expansion = node.expansion() ? expansionOf(node) : nullptr)
      open.push_back(expansion);
    appendChildren(node, open);
  });
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) try {
  LoadOptions options;
  options.limits.expandedNodes = 10'000;
  options.limits.arrayElements = 10'000;
  options.limits.triangles = 100'000;
  options.limits.worldBytes = 64 << 20;
  const std::string text =
      "#X3D V4.0 utf8\nPROFILE Full\n" + std::string(reinterpret_cast<const char*>(data), size);
  BrowserOptions quiet;
  quiet.runScripts = false;
  quiet.maximumEvents = 10'000;
  Browser browser(loadWorldFromMemory(text, "fuzz.x3dv", options), quiet, 0);
  for (const double time : {0.0, 0.4, 3.0, 1e6}) {
    browser.tick(time);
    checkMeshes(browser.world(), options.limits);
  }
  return 0;
} catch (const xvrml::LoadError&) { return 0; }
