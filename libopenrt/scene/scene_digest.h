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
  // Returns the digest of what all commits so far have made. Ids and their order count.
  Value value() const;

 private:
  uint32_t cameraShader_ = 0;
  // By kind, index and id of what was edited: the digest of the last edit, or of an array.
  std::unordered_map<uint64_t, uint64_t> things_;
};

} // namespace openrt
