// xvrml_figure.cpp: arbitrary bytes as a world of X3D, whose figures move their vertices. Places
// stay finite where they are finite at rest. libFuzzer calls this on one thread.
#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/figure.h"
#include "xvrml/deformed.h"
#include "xvrml/walk.h"

namespace {

using namespace xvrml;

template <class Vectors> bool isFinite(const Vectors& vectors) {
  return std::all_of(vectors.begin(), vectors.end(), [](const auto& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  });
}

template <class Drawn, class Rest> void checkVectors(const Drawn& drawn, const Rest& rest) {
  if (drawn.size() != rest.size()) __builtin_trap();
  if (isFinite(rest) && !isFinite(drawn)) __builtin_trap();
}

void check(const Node& node) {
  if (const auto* coord = nodeCast<nodes::Coordinate>(&node))
    checkVectors(drawnPoints(*coord), coord->point);
  if (const auto* exact = nodeCast<nodes::CoordinateDouble>(&node))
    checkVectors(drawnPoints(*exact), exact->point);
  if (const auto* normal = nodeCast<nodes::Normal>(&node))
    checkVectors(drawnNormals(*normal), normal->vector);
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
