// light_node.h: a node of the light tree, and the importance of its children for a point. [render]
#pragma once

#include <cstdint>

#include "scene/vec3.h"

namespace openrt {

// Up to eight children side by side for vector lanes, with everything precomputed that does not
// depend on the shading point.
struct LightNode {
  static constexpr uint32_t width = 8;
  // radius2: squared radius of the box's bounding sphere. reach2: squared radius of influence from
  // the centre.
  float center[3][width], radius2[width], reach2[width];
  float axis[3][width], cosine[width], sine[width], beyond[width], both[width];
  float intensity[width], irradiance[width], used[width];
  uint32_t child[width]; // index of a node, or of a light if `leaf`
  bool leaf[width];
  uint32_t parent, slot; // parent: none for the root
};

// Meaning of a receiver's normal: light counts only from the side that it points to (`only`), or
// mostly from that side (`likely`).
enum class ReceiverSide : uint8_t { only, likely };

// The point for which light is sampled.
struct LightReceiver {
  Vec3f place, normal;
  // Added to the cosine at the receiver; 2 if the side of the receiver does not matter.
  float facing;
  // cut: cosine at the receiver below which nothing arrives. least: smallest cosine that is used
  // above that.
  float cut, least;
  // side: unit normal; 0 0 0 if light counts from everywhere.
  LightReceiver(const Vec3f& from, const Vec3f& side, ReceiverSide meaning);
};

// Writes the importance of each of the eight children.
void importances(const LightNode& node, const LightReceiver& receiver, float out[LightNode::width]);

} // namespace openrt
