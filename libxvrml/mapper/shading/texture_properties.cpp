// texture_properties.cpp: TextureProperties (ISO/IEC 19775-1 18.4.9): how a picture goes on beyond
// its edges, and how it is enlarged. Part of class Textures.
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "mapper/shading/textures.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {
namespace {

// CLAMP is as CLAMP_TO_EDGE: OpenGL has dropped the mode that blends edges with the border.
RTenum wrapOf(const std::string& mode, const char* field, const Node& node, World& world) {
  if (mode == "REPEAT") return RT_REPEAT;
  if (mode == "CLAMP" || mode == "CLAMP_TO_EDGE") return RT_CLAMP_TO_EDGE;
  if (mode == "MIRRORED_REPEAT") return RT_MIRRORED_REPEAT;
  if (mode == "CLAMP_TO_BOUNDARY") return RT_CLAMP_TO_BORDER;
  world.diagnostics.warn(
      node.source, std::string("TextureProperties: ") + field + " is \"" + mode.substr(0, 40) +
                       "\", expected REPEAT, MIRRORED_REPEAT, CLAMP, CLAMP_TO_EDGE or "
                       "CLAMP_TO_BOUNDARY: REPEAT is used");
  return RT_REPEAT;
}

// Returns a part of a colour in its range. A number that is none counts as 0, the default.
float partOf(float part) { return part > 0 ? std::min(part, 1.0f) : 0.0f; }

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
  sampling.wrapR = wrapOf(p->boundaryModeR, "boundaryModeR", *p, world_);
  checkFilter(*p, world_);
  sampling.nearest = p->magnificationFilter == "NEAREST_PIXEL";
  if (sampling.bordered()) {
    const ColorRGBA& c = p->borderColor;
    sampling.border = {partOf(c.r), partOf(c.g), partOf(c.b), partOf(c.a)};
  }
  return sampling;
}

// The border is encoded as the colours of the picture are; numbers are not.
void Textures::setSampling(const Sampling& sampling, bool data) {
  rtTexParameteri(RT_TEXTURE_WRAP_S, int(sampling.wrapS));
  rtTexParameteri(RT_TEXTURE_WRAP_T, int(sampling.wrapT));
  rtTexParameteri(RT_TEXTURE_WRAP_R, int(sampling.wrapR));
  rtTexParameteri(RT_TEXTURE_MAG_FILTER, sampling.nearest ? RT_NEAREST : RT_LINEAR);
  if (!sampling.bordered()) return;
  const auto& [r, g, b, alpha] = sampling.border;
  const Color color = convert({r, g, b}, srgb_ && !data);
  const float rgba[4] = {partOf(color.r), partOf(color.g), partOf(color.b), alpha};
  rtTexParameterfv(RT_TEXTURE_BORDER_COLOR, rgba);
}

// Colours of borders are many. So a bordered picture of a file follows an event, where others are
// made anew and kept for nodes to come.
bool Textures::showBordered(ptrdiff_t nodes, RTid texture) const {
  if (!bordered_.contains(texture)) return false;
  for (const Entries* entries : {&nodes_, &faces_})
    nodes -= std::count_if(entries->begin(), entries->end(),
                           [&](const auto& entry) { return entry.second.id == texture; });
  return nodes == 0;
}

void Textures::resample(RTid texture, const Sampling& sampling) {
  if (!showBordered(1, texture)) return;
  const Files::iterator found = bordered_[texture];
  const auto [path, before, data] = found->first;
  if (files_.contains({path, sampling, data})) return;
  auto file = files_.extract(found);
  std::get<Sampling>(file.key()) = sampling;
  bordered_[texture] = files_.insert(std::move(file)).position;
  if (!sampling.bordered()) bordered_.erase(texture);
  rtBindTexture(texture);
  setSampling(sampling, data);
}

void Textures::dropUnused(RTid texture) {
  if (!showBordered(0, texture)) return;
  files_.erase(bordered_[texture]);
  bordered_.erase(texture);
  drop(texture);
}

} // namespace xvrml::mapper
