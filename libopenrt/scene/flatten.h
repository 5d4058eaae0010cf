// flatten.h: from nested instances to what ray kernels know: one level of instances. The user's
// objects nest to any depth.
//
// The graph of objects is cut at every instance that is dynamic and at every instance of a dynamic
// object. What hangs together between the cuts is a part: a list of items (objects with geometry,
// each with its matrix in the part's frame) and of sockets, the cuts where other parts begin. Part
// 0 is the scene itself: everything static. A cluster is a part in a place: one for every path of
// cuts from the scene down, so that a part with ten thousand copies is listed once. The matrix of a
// dynamic instance is in its clusters alone: moving it changes nothing else.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace openrt {

struct Inherited {       // what a path of instances hands down
  uint32_t instance = 0; // outermost
  uint32_t shader = 0;   // override: the outermost one
  uint32_t lightSet = 0; // index into Flattened::lightSets
  uint32_t name = 0;     // of the innermost instance that has one
  uint64_t userData = 0; // of the innermost instance that has any
};

struct Item { // an object with geometry
  uint32_t object = 0;
  Inherited path;  // within the part
  Matrix4d matrix; // object to part
};

struct Socket {
  uint32_t instance = 0, part = 0;
  Inherited path; // within the part, this instance included
  Matrix4d above; // the frame in which the instance stands, to the part
};

struct ScenePart {
  uint32_t object = 0; // 0: the scene
  std::vector<Item> items;
  std::vector<Socket> sockets;
};

struct Cluster {
  uint32_t part = 0, parent = 0, socket = 0; // socket of the parent's part
  uint32_t firstChild = 0;                   // one for each socket of the part, in a row
  Inherited path;
  Matrix4d world;
  bool visible = true; // and everything above it
};

struct Flattened {
  std::vector<ScenePart> parts;
  std::vector<Cluster> clusters; // 0: the static scene; parents before children
  std::vector<std::pair<uint32_t, uint32_t>> clustersOf; // (instance, cluster), sorted
  std::vector<std::vector<uint32_t>>
      lightSets;          // ids of the lights that shine on an item; set 0: the unscoped ones
  uint64_t rejected = 0;  // items whose matrix within their part is not usable
  bool truncated = false; // more than maxPlacements
  std::map<std::vector<uint32_t>, uint32_t> setNumbers; // of the light sets
  uint32_t lightSet(const std::vector<uint32_t>& ids);  // its number
  uint32_t unite(uint32_t a, uint32_t b);               // the light set of both together
  Inherited inherit(const Inherited& outer,
                    const Inherited& inner); // of the two paths, one after the other
};

inline constexpr size_t maxPlacements = 4'000'000; // of items in clusters
inline constexpr size_t maxClusters =
    1'000'000; // each is an instance of the ray kernels, about 1 KB with all that belongs to it

// Ids of the lights that shine on everything: light set 0.
std::vector<uint32_t> unscopedLights(const Scene& scene);

Flattened flatten(const Scene& scene);

// Places the clusters of these dynamic instances, and all below them, anew after their matrices or
// visibility changed. Returns the clusters concerned, ascending.
std::vector<uint32_t> replace(const Scene& scene, Flattened& flat,
                              const std::vector<uint32_t>& instances);

} // namespace openrt
