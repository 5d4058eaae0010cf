// scene_digest.h: a digest of everything that commits have put into a scene, by which kept sums of
// a frame are known to belong to it. Settings of frames are not in it. The camera is apart from the
// rest, so that a message can tell another view from another world. One thread.
#pragma once

#include <cstdint>
#include <unordered_map>

#include "scene/commit.h"

namespace openrt {

class SceneDigest {
 public:
  struct Value {
    uint64_t world = 0, view = 0;
  };
  void add(const Commit& commit);
  // Returns the digest of all commits so far: equal for equal calls in equal order.
  Value value() const;

 private:
  uint64_t world_ = 0;
  uint64_t cameraShader_ = 0;
  uint64_t camera_ = 0;                              // of the edit of the camera
  std::unordered_map<uint32_t, uint64_t> shaders_;   // parameters of shaders, by shader
  std::unordered_map<ArrayId, uint64_t> arrays_;     // contents
};

} // namespace openrt
