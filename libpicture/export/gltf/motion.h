// motion.h: Finds what ROUTEs from TimeSensors move by interpolators, and writes it as glTF
// animations. [the thread that owns the world]
#pragma once

#include <array>
#include <set>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "libpicture/export/gltf/document.h"
#include "libpicture/export/gltf/place.h"
#include "libpicture/export/remarks.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace picture::gltf {

// A field of a Transform that glTF can animate.
enum class Path : uint8_t { translation, rotation, scale };

// A way from a TimeSensor through an interpolator to a field.
struct Motion {
  const xvrml::nodes::TimeSensor* clock = nullptr;
  const xvrml::Node* interpolator = nullptr; // moves or turns, straight or in a curve
  const xvrml::Node* target = nullptr;       // a Transform or CADPart
  Path path = Path::translation;
};

// Keys as glTF has them: times in seconds that increase, and a value for each.
struct Keys {
  std::vector<float> times;
  std::vector<std::array<float, 4>> values; // x y z, or a quaternion x y z w
  size_t width = 3;                         // numbers of a value
};
// Returns the keys of a motion, over a whole cycle: the first and the last value hold until its
// ends. Where an interpolator jumps, two keys are as near as floats can be. Turns by nearly half a
// circle or more get a key between, so that they go the same way round. Curves are sampled at 16
// places between two keys. Empty: there are none.
Keys keysOf(const Motion& motion);

class Motions {
 public:
  // Reads the ROUTEs of the world, its prototypes and Inlines. Those that glTF has nothing for are
  // counted in the remarks.
  Motions(const xvrml::World& world, Remarks& remarks);
  bool moves(const xvrml::Node& node) const { return targets_.contains(&node); }
  // Returns whether an animation stands for the node: a TimeSensor or an interpolator.
  bool uses(const xvrml::Node& node) const { return used_.contains(&node); }
  // Notes that a target has been written, once for each place in the world. offset: what the first
  // translation has beside the field.
  struct Placed {
    size_t node = 0, scaleNode = 0; // indices of nodes
    Vec offset;
  };
  void place(const xvrml::Node& target, const Placed& placed);
  // Writes an animation for each TimeSensor. Call it after the nodes.
  void write(Document& document);

 private:
  std::vector<std::pair<Motion, Keys>> motions_; // in the order of the ROUTEs
  std::unordered_set<const xvrml::Node*> targets_, used_;
  std::unordered_map<const xvrml::Node*, std::vector<Placed>> places_;
};

} // namespace picture::gltf
