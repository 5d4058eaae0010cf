// flatten.h: flattens nested instances to the one level of instances that ray kernels support. The
// user's objects nest to any depth.
//
// The object graph is cut at every dynamic instance and at every instance of a dynamic object.
// * A part is a connected piece between cuts. It lists items (objects with geometry, each with its
//   matrix in the part's frame) and sockets (the cuts where other parts begin). Part 0 is the
//   static scene.
// * A cluster is one placement of a part: one for every path of cuts from the scene down. So a part
//   with ten thousand copies is stored once.
// The matrix of a dynamic instance occurs only in its clusters: moving it changes nothing else.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace openrt {

struct Inherited {       // attributes inherited along a path of instances
  uint32_t instance = 0; // outermost instance
  uint32_t shader = 0;   // override of the outermost instance that has one
  uint32_t lightSet = 0; // index into Flattened::lightSets
  uint32_t fog = 0;      // environment shader of the innermost instance that has a fog
  uint32_t name = 0;     // name of the innermost instance that has one
  uint64_t userData = 0; // data of the innermost instance that has any
};

struct Item { // an object with geometry
  uint32_t object = 0;
  Inherited path;  // attributes inherited within the part
  Matrix4d matrix; // object to part
};

struct Socket {
  uint32_t instance = 0, part = 0;
  Inherited path; // attributes inherited within the part, including this instance
  Matrix4d above; // frame of the instance to part
};

struct ScenePart {
  uint32_t object = 0; // 0: the scene
  std::vector<Item> items;
  std::vector<Socket> sockets;
  // With paths: by item, and by socket (to the object that holds its instance), an index into
  // Flattened::paths.
  std::vector<uint32_t> itemPaths, socketPaths;
};

// The last of the static instances on the way from a part's root to an item or a socket.
struct PathStep {
  uint32_t instance = 0;
  uint32_t above = 0; // the step before, which has a smaller index; 0: the part's root
};

struct Cluster {
  uint32_t part = 0, parent = 0, socket = 0; // socket: index in the parent's part
  uint32_t firstChild = 0;                   // one child per socket of the part, contiguous
  Inherited path;
  Matrix4d world;
  bool visible = true; // visible, with all its ancestors
};

struct Flattened {
  std::vector<ScenePart> parts;
  std::vector<Cluster> clusters; // 0: the static scene; parents come before children
  std::vector<std::pair<uint32_t, uint32_t>> clustersOf; // pairs (instance, cluster), sorted
  std::vector<PathStep> paths; // [0]: the root of any part; empty if they were not asked for
  // Ids of the lights that illuminate an item; set 0 holds the unscoped lights.
  std::vector<std::vector<uint32_t>> lightSets;
  uint64_t rejected = 0;  // items with an unusable matrix within their part
  bool truncated = false; // items beyond maxPlacements were left out
  std::map<std::vector<uint32_t>, uint32_t> setNumbers; // light set to its index
  uint32_t lightSet(const std::vector<uint32_t>& ids);  // returns the index of this set of lights
  uint32_t uniteLightSets(uint32_t a, uint32_t b);      // returns the union of two sets
  // Combines two consecutive paths.
  Inherited inherit(const Inherited& outer, const Inherited& inner);
};

inline constexpr size_t maxPlacements = 4'000'000; // limit on items over all clusters
// Each cluster is an instance of the ray kernels and takes about 1 KB in all.
inline constexpr size_t maxClusters = 1'000'000;

// Returns the ids of the lights that illuminate everything: light set 0.
std::vector<uint32_t> unscopedLights(const Scene& scene);

// paths: also tells by which instances the items and sockets have come into their parts.
Flattened flatten(const Scene& scene, bool paths = false);
// Add the paths of an unchanged scene to its flattened form, and remove them.
void addPaths(const Scene& scene, Flattened& flat);
void dropPaths(Flattened& flat);

// Updates the clusters of these dynamic instances, and all below them, after changes of matrices or
// visibility. Returns the affected clusters in ascending order.
std::vector<uint32_t> updateClusters(const Scene& scene, Flattened& flat,
                                     const std::vector<uint32_t>& instances);

} // namespace openrt
