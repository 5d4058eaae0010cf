// xvrml_figure.cpp: arbitrary bytes as a world of X3D, whose figures move their vertices. Places
// stay finite where they are finite at rest. libFuzzer calls this on one thread.
#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "geometry/figure.h"
#include "xvrml/deformed.h"
#include "xvrml/walk.h"

namespace {

using namespace xvrml;

bool isFinite(std::span<const Vec3f> vectors) {
  return std::all_of(vectors.begin(), vectors.end(), [](const Vec3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  });
}

void check(const Node& node) {
  if (const auto* coord = nodeCast<nodes::Coordinate>(&node)) {
    const auto points = drawnPoints(*coord);
    if (points.size() != coord->point.size()) __builtin_trap();
    if (isFinite(coord->point) && !isFinite(points)) __builtin_trap();
  }
  if (const auto* normal = nodeCast<nodes::Normal>(&node)) {
    const auto vectors = drawnNormals(*normal);
    if (vectors.size() != normal->vector.size()) __builtin_trap();
    if (isFinite(normal->vector) && !isFinite(vectors)) __builtin_trap();
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) try {
  LoadOptions options;
  options.limits.expandedNodes = 10'000;
  options.limits.arrayElements = 10'000;
  const std::string text =
      "#X3D V4.0 utf8\n" + std::string(reinterpret_cast<const char*>(data), size);
  const auto world = loadWorldFromMemory(text, "fuzz.x3dv", options);
  Diagnostics diagnostics;
  walk(rootsOf(world->scope), [&](Node& node, std::vector<Node*>& open) {
    if (deforms(node.type())) deform(node, &diagnostics);
    appendChildren(node, open);
  });
  walk(rootsOf(world->scope), [&](Node& node, std::vector<Node*>& open) {
    check(node);
    appendChildren(node, open);
  });
  return 0;
} catch (const xvrml::LoadError&) { return 0; }
