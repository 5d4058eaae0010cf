// ray_queue.h: rays that wait for the next wave of a tile: a path may send on several. Grows with
// what is pushed; kept by the tile renderer from tile to tile. [render]
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "render/lights/emitters.h"
#include "render/surface/media.h"

namespace openrt {

// Which paths from the camera light tracing makes instead: those that are in `through` when they
// meet a lamp.
enum class Course : uint8_t {
  straight,  // nothing has bent it yet
  scattered, // first a surface that scatters; so did the last one
  through,   // the same, and since the last one that scatters mirrors or smooth boundaries alone
  mirrored // first a mirror or a smooth boundary; of a path from a lamp: what light tracing follows
};

// What a ray knows of the path it belongs to.
struct RayState {
  float throughput[3] = {1, 1, 1};
  float travelled = 0; // length of the path up to the ray's origin
  uint32_t path = 0;   // sample of the tile
  uint32_t branch =
      0; // tells the branches of one path apart for its random numbers; 0: the one from the camera
  float density =
      0; // by solid angle, with which a lobe has chosen the direction; 0: it could not be another
  Receiver from;         // whose density it is
  MediaStack media = {}; // bodies that the ray is inside of
  Course course = Course::straight;
  uint8_t scattered = 0; // a surface that scatters was on the way
  uint8_t byChance = 0;  // and mirrors or smooth boundaries alone since the last one: it meets
                         // emitters by chance (ledger.h)
  uint8_t bent = 0;      // no longer the straight line from the camera: alpha is settled
  uint8_t splits = 0;    // times the path has gone on in several directions
  uint8_t channel = 0;   // 1 + the only colour it carries (dispersion); 0: all
};

struct QueuedRay {
  float origin[3], direction[3];
  RayState state;
};

using RayQueue = std::vector<QueuedRay>;

} // namespace openrt
