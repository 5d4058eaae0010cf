// texture_properties.cpp: TextureProperties (ISO/IEC 19775-1 18.4.9): how a picture goes on beyond
// its edges, and how it is enlarged. Part of class Textures.
#include <string>

#include "mapper/shading/textures.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {
namespace {

// CLAMP is as CLAMP_TO_EDGE, because pictures have no border of their own.
RTenum wrapOf(const std::string& mode, const char* field, const Node& node, World& world) {
  if (mode == "REPEAT") return RT_REPEAT;
  if (mode == "CLAMP" || mode == "CLAMP_TO_EDGE") return RT_CLAMP_TO_EDGE;
  const bool mirrored = mode == "MIRRORED_REPEAT", border = mode == "CLAMP_TO_BOUNDARY";
  world.diagnostics.warn(
      node.source,
      std::string("TextureProperties: ") + field + " is \"" + mode.substr(0, 40) +
          (mirrored || border ? "\", which is not supported"
                              : "\", expected REPEAT, MIRRORED_REPEAT, CLAMP, CLAMP_TO_EDGE or "
                                "CLAMP_TO_BOUNDARY") +
          (border ? ": CLAMP_TO_EDGE is used" : ": REPEAT is used"));
  return border ? RT_CLAMP_TO_EDGE : RT_REPEAT;
}

void checkFilter(const nodes::TextureProperties& p, World& world) {
  for (const char* known : {"AVG_PIXEL", "DEFAULT", "FASTEST", "NEAREST_PIXEL", "NICEST"})
    if (p.magnificationFilter == known) return;
  world.diagnostics.warn(p.source,
                         "TextureProperties: magnificationFilter is \"" +
                             p.magnificationFilter.substr(0, 40) +
                             "\", expected AVG_PIXEL, DEFAULT, FASTEST, NEAREST_PIXEL or NICEST: "
                             "DEFAULT is used");
}

} // namespace

Textures::Sampling Textures::samplingOf(bool repeatS, bool repeatT) {
  Sampling sampling;
  sampling.wrapS = repeatS ? RT_REPEAT : RT_CLAMP_TO_EDGE;
  sampling.wrapT = repeatT ? RT_REPEAT : RT_CLAMP_TO_EDGE;
  return sampling;
}

Textures::Sampling Textures::samplingOf(bool repeatS, bool repeatT,
                                        const NodeRef& properties) const {
  const auto* p = nodeCast<nodes::TextureProperties>(renderedNode(properties.get()));
  if (!p) return samplingOf(repeatS, repeatT);
  Sampling sampling;
  sampling.wrapS = wrapOf(p->boundaryModeS, "boundaryModeS", *p, world_);
  sampling.wrapT = wrapOf(p->boundaryModeT, "boundaryModeT", *p, world_);
  checkFilter(*p, world_);
  sampling.nearest = p->magnificationFilter == "NEAREST_PIXEL";
  return sampling;
}

} // namespace xvrml::mapper
